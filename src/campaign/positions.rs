//! Positions that look like a mistake: wheels and thrusters away from the body, thrusters and debris within it.
//!
//! Parts of the body tell where the body is, unless some are points. A body by mass and inertia has a radius of gyration, which tells how far
//! its mass is from its centre: r^2 = tr J/(2 m), the mean square of the distance.

use super::digits::digits;
use crate::math::vector::{dcm_from_quaternion, difference, norm, transposed_product};
use crate::scene::outline::{distance, inner_radius};
use crate::scene::solids::Body;
use crate::scene::unit_quaternion::unit_quaternion;
use crate::scene::{DebrisInput, PartInput, PartShape, SceneInput, WheelInput};

/// The distance from the centre of mass, in radii of gyration, beyond which nothing is mounted: the surface of a sphere is at 1.3, the end of
/// a rod at 1.7; a body with a heavy centre and light panels has some 3.
const FAR: f64 = 5.0;
/// The distance of a thruster from the nearest part, in radii of gyration of the body, beyond which no boom is supposed.
const BOOM: f64 = 2.0;
/// The depth of a thruster within a part, in radii of the largest sphere in that part, below which it is at the surface.
const RECESS: f64 = 0.1;

/// A note for each position that looks like a mistake, in a scene that is physical.
pub(super) fn implausible(scene: &SceneInput) -> Vec<String> {
    let body = Whereabouts::of(scene);
    let wheels = scene.wheels.iter().filter_map(|wheel| body.of_wheel(wheel));
    let thrusters = scene.thrusters.iter().filter_map(|thruster| {
        let key = format!("thrusters.{}.position_m = {:?}", thruster.name, thruster.position_m);
        body.of_thruster(thruster.position_m).map(|why| format!("{key}: {why}"))
    });
    let debris = scene.debris.as_ref().and_then(|debris| body.of_debris(scene, debris));
    wheels.chain(thrusters).chain(debris).collect()
}

/// Where the body is, as far as that is known.
struct Whereabouts<'a> {
    /// The parts, where they all have a shape.
    parts: &'a [PartInput],
    center: [f64; 3],
    /// Radius of gyration, m.
    radius: f64,
}

impl<'a> Whereabouts<'a> {
    fn of(scene: &'a SceneInput) -> Self {
        let Body { mass, center, inertia } = Body::of_input(scene, 1.0);
        let radius = (0.5 * (inertia[0][0] + inertia[1][1] + inertia[2][2]) / mass).sqrt();
        let have_shapes = scene.parts.iter().all(|part| part.shape != PartShape::PointMass);
        Whereabouts { parts: if have_shapes { &scene.parts } else { &[] }, center, radius }
    }

    /// The nearest part, and the distance from its surface, m, negative inside.
    fn nearest(&self, point: [f64; 3]) -> Option<(&PartInput, f64)> {
        let distances = self.parts.iter().filter_map(|part| Some((part, distance(part, point)?)));
        distances.min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// Why a point is away from a body without parts.
    fn is_far(&self, point: [f64; 3]) -> Option<String> {
        let away = norm(difference(point, self.center));
        let is_far = self.parts.is_empty() && away > FAR * self.radius;
        is_far.then(|| {
            let (away, radius) = (digits(away), digits(self.radius));
            format!("it is {away} m from the body's centre of mass, whose radius of gyration is {radius} m")
        })
    }

    fn of_wheel(&self, wheel: &WheelInput) -> Option<String> {
        let reach = match (wheel.radius_m, wheel.length_m) {
            (Some(radius), Some(length)) => libm::hypot(radius, 0.5 * length),
            // of a disc with this mass and inertia
            _ => (2.0 * wheel.axial_inertia_kg_m2? / wheel.mass_kg?).sqrt(),
        };
        let outside = self.nearest(wheel.position_m).filter(|(_, away)| *away > reach).map(|(part, away)| {
            let (away, reach) = (digits(away), digits(reach));
            format!("its centre is {away} m outside of body.parts.{}, the nearest part, which a wheel of {reach} m does not reach", part.name)
        });
        let why = outside.or_else(|| self.is_far(wheel.position_m))?;
        let key = format!("wheels.{}.position_m = {:?}", wheel.name, wheel.position_m);
        Some(format!(
            "{key}: {why}; usual are wheels within the body; millimetres are written with their unit, \"200 mm\""
        ))
    }

    fn of_thruster(&self, position: [f64; 3]) -> Option<String> {
        let usual = "usual are thrusters at the surface of the body";
        let found = match self.nearest(position) {
            Some((part, away)) if away > BOOM * self.radius => {
                format!("it is {} m outside of body.parts.{}, the nearest part", digits(away), part.name)
            }
            Some((part, away)) if -away > RECESS * inner_radius(part)? => {
                format!("it is {} m within body.parts.{}, which its jet would hit", digits(-away), part.name)
            }
            _ => self.is_far(position)?,
        };
        Some(format!("{found}; {usual}; millimetres are written with their unit, \"200 mm\""))
    }

    fn of_debris(&self, scene: &SceneInput, debris: &DebrisInput) -> Option<String> {
        let initial = &scene.initial;
        let from_p = difference(initial.debris_position_m, initial.position_m);
        let point = transposed_product(dcm_from_quaternion(unit_quaternion(initial.attitude)), from_p);
        // the largest sphere that is surely within the debris
        let inner = match debris {
            DebrisInput::Cube { side_m, .. } => 0.5 * side_m,
            DebrisInput::Box { size_m, .. } => 0.5 * size_m.iter().copied().fold(f64::INFINITY, f64::min),
            DebrisInput::Tensor { .. } | DebrisInput::Principal { .. } => 0.0,
        };
        let away = norm(difference(point, self.center));
        let why = match self.nearest(point) {
            Some((part, distance)) if distance < inner => {
                format!("at the start the debris is, in whole or in part, within body.parts.{}", part.name)
            }
            None if away < self.radius => format!(
                "at the start its centre is {} m from the body's centre of mass, whose radius of gyration is {} m",
                digits(away),
                digits(self.radius),
            ),
            _ => return None,
        };
        let value = initial.debris_position_m;
        Some(format!(
            "initial.debris_position_m = {value:?}: {why}, and nothing in the model keeps them apart; usual are some metres and more from initial.position_m"
        ))
    }
}
