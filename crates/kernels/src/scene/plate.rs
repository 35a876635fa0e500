//! [`Plate`]: plates of a spacecraft's surface, as written or from the parts of its body.
//!
//! A box has its six sides; a cylinder its two ends and a prism of [`PRISM_SIDES`] plates of equal area, with the
//! cylinder's projection within 2.3% at any angle and exactly on average. Parts neither shade nor hide each other.

use super::alignment::aligned;
use super::input::SceneInput;
use super::schema::{MAX_PLATES, PartInput, PartShape, PlateInput};
use super::unit_quaternion::unit_quaternion;
use crate::math::prelude::*;

/// Plates around a cylinder.
pub const PRISM_SIDES: usize = 12;

/// One side of a flat plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Area, m^2.
    pub area: f64,
    /// Outward unit normal, F_s.
    pub normal: [f64; 3],
    /// Centre from p, F_s, m.
    pub center: [f64; 3],
    /// Drag coefficient.
    pub drag_coefficient: f64,
    /// Share of specular reflection.
    pub specular: f64,
    /// Share of diffuse reflection.
    pub diffuse: f64,
    /// Area of the solar cells times their efficiency, m^2.
    pub cells: f64,
}

pub(super) fn of_parts(input: &SceneInput) -> usize {
    input.parts.iter().map(|part| count(part.shape)).sum()
}

fn count(shape: PartShape) -> usize {
    match shape {
        PartShape::Box => 6,
        PartShape::HollowCylinder | PartShape::SolidCylinder => PRISM_SIDES + 2,
        PartShape::Sphere | PartShape::PointMass => 0,
    }
}

/// Replaces `plates` with those of a checked `input`; none if nothing acts on them.
pub(super) fn resolve_into(input: &SceneInput, plates: &mut Vec<Plate>) {
    plates.clear();
    let environment = &input.environment;
    if !environment.acts_on_plates() {
        return;
    }
    plates.reserve_exact(MAX_PLATES);
    plates.extend(input.plates.iter().map(written));
    if plates.is_empty() {
        input.parts.iter().for_each(|part| push_part(part, plates));
    }
    plates.iter_mut().for_each(|plate| plate.area *= environment.area_scale);
}

fn written(plate: &PlateInput) -> Plate {
    Plate {
        area: plate.area_m2,
        normal: aligned(plate.normal, plate.tilt_rad, 1.0),
        center: plate.center_m,
        drag_coefficient: plate.drag_coefficient,
        specular: plate.specular,
        diffuse: plate.diffuse,
        cells: plate.area_m2 * plate.cell_efficiency,
    }
}

fn push_part(part: &PartInput, plates: &mut Vec<Plate>) {
    let c = dcm_from_quaternion(constant_quaternion(1.0, unit_quaternion(part.attitude)));
    let mut push = |area: f64, normal: [f64; 3], center: [f64; 3]| {
        let plate = PlateInput { area_m2: area, normal: product(c, normal), ..PlateInput::DEFAULT };
        plates.push(Plate { center: sum(part.position_m, product(c, center)), ..written(&plate) });
    };
    if part.shape == PartShape::Box {
        let size = part.size_m.unwrap_or_default();
        for axis in 0..3 {
            let area = size[(axis + 1) % 3] * size[(axis + 2) % 3];
            for sign in [1.0, -1.0] {
                let mut normal = [0.0; 3];
                normal[axis] = sign;
                push(area, normal, normal.map(|x| 0.5 * x * size[axis]));
            }
        }
    } else if count(part.shape) > 0 {
        let radius = part.outer_radius_m.or(part.radius_m).unwrap_or_default();
        let length = part.length_m.unwrap_or_default();
        for sign in [1.0, -1.0] {
            push(core::f64::consts::PI * radius * radius, [0.0, 0.0, sign], [0.0, 0.0, 0.5 * sign * length]);
        }
        let turn = core::f64::consts::TAU / PRISM_SIDES as f64;
        for side in 0..PRISM_SIDES {
            let (sine, cosine) = libm::sincos(turn * side as f64);
            push(radius * turn * length, [cosine, sine, 0.0], [radius * cosine, radius * sine, 0.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{EnvironmentInput, Name, OrbitInput, Scene};
    use crate::testing::near;

    fn plates(part: PartInput) -> Vec<Plate> {
        let environment = EnvironmentInput { drag: true, area_scale: 2.0, ..EnvironmentInput::DEFAULT };
        let part = PartInput { name: Name::of("part"), mass_kg: Some(50.0), ..part };
        let orbit = Some(OrbitInput { semi_major_axis_m: Some(7e6), ..OrbitInput::DEFAULT });
        let input = SceneInput { parts: vec![part], orbit, environment, ..SceneInput::blank() };
        Scene::resolve(&input).expect("a legal scene").plates
    }

    /// Law: the plates close a surface: areas times normals sum to zero, areas times normals . centres to three volumes
    /// (Gauss).
    #[test]
    fn the_plates_of_a_part_close() {
        let attitude = [0.5, 0.5, -0.5, 0.5];
        let size_m = Some([1.0, 2.0, 3.0]);
        let of_box =
            PartInput { shape: PartShape::Box, size_m, attitude, position_m: [0.3, -4.0, 1.0], ..PartInput::DEFAULT };
        let cylinder = PartInput {
            shape: PartShape::SolidCylinder,
            radius_m: Some(0.5),
            length_m: Some(3.0),
            attitude,
            ..PartInput::DEFAULT
        };
        let volume = core::f64::consts::PI * 0.25 * 3.0;
        for (part, count, volume, area) in [(of_box, 6, 6.0, 22.0), (cylinder, 14, volume, 3.5 * core::f64::consts::PI)]
        {
            let plates = plates(part);
            assert_eq!(plates.len(), count);
            let all = plates.iter().map(|plate| scaled(plate.area, plate.normal)).fold([0.0; 3], sum);
            assert!(norm(all) < 1e-14, "{all:?}");
            let flux: f64 = plates.iter().map(|plate| plate.area * dot(plate.normal, plate.center)).sum();
            near(flux, 2.0 * 3.0 * volume, 1e-14);
            let found: f64 = plates.iter().map(|plate| plate.area).sum();
            near(found, 2.0 * area, 1e-14);
        }
    }

    /// Law: the prism projects the area of the cylinder, 2 r l, within 2.3% across the axis, exactly on average.
    #[test]
    fn the_prism_is_as_wide_as_the_cylinder() {
        let plates = plates(PartInput {
            shape: PartShape::SolidCylinder,
            radius_m: Some(0.5),
            length_m: Some(3.0),
            ..PartInput::DEFAULT
        });
        let mut sum = 0.0;
        for k in 0..360 {
            let (s, c) = libm::sincos(f64::from(k).to_radians());
            let width: f64 = plates.iter().map(|plate| plate.area * dot(plate.normal, [c, s, 0.0]).max(0.0)).sum();
            near(width, 6.0, 0.0235);
            sum += width;
        }
        near(sum / 360.0, 6.0, 1e-4);
    }
}
