//! [`distance`]: how far a point is from the surface of a part of the body. For notes on positions that are probably not meant; no motion
//! depends on it.

use super::schema::{PartInput, PartShape};
use super::unit_quaternion::unit_quaternion;
use crate::math::vector::{dcm_from_quaternion, difference, norm, transposed_product};

/// Distance of `point` (from p in F_s, m) from the outer surface of `part`, m, negative inside; `None` of a point mass. Of a hollow cylinder
/// the inside is what its outer surface encloses.
pub fn distance(part: &PartInput, point: [f64; 3]) -> Option<f64> {
    let c = dcm_from_quaternion(unit_quaternion(part.attitude));
    let [x, y, z] = transposed_product(c, difference(point, part.position_m));
    // by how much the point is beyond each pair of faces, and the shell
    let beyond = match part.shape {
        PartShape::Box => {
            let [a, b, c] = part.size_m?.map(|side| 0.5 * side);
            [x.abs() - a, y.abs() - b, z.abs() - c]
        }
        PartShape::HollowCylinder => cylinder(part.outer_radius_m?, part.length_m?, [x, y, z]),
        PartShape::SolidCylinder => cylinder(part.radius_m?, part.length_m?, [x, y, z]),
        PartShape::Sphere => return Some(norm([x, y, z]) - part.radius_m?),
        PartShape::PointMass => return None,
    };
    let nearest = beyond.into_iter().fold(f64::NEG_INFINITY, f64::max);
    Some(if nearest > 0.0 { norm(beyond.map(|length| length.max(0.0))) } else { nearest })
}

fn cylinder(radius: f64, length: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [libm::hypot(x, y) - radius, z.abs() - 0.5 * length, f64::NEG_INFINITY]
}

/// The radius of the largest sphere within the outer surface of `part`, m; `None` of a point mass.
pub fn inner_radius(part: &PartInput) -> Option<f64> {
    let centre = distance(part, part.position_m)?;
    Some(-centre)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Law: distances from faces, edges, corners and shells, outside and inside, of parts that are moved and turned.
    #[test]
    fn distances_are_those_of_the_surface() {
        // a quarter turn about s3: the side of 2 m is along s2
        let attitude = [0.5f64.sqrt(), 0.0, 0.0, 0.5f64.sqrt()];
        let moved = PartInput { position_m: [1.0, 0.0, 0.0], attitude, ..PartInput::DEFAULT };
        let cuboid = PartInput { shape: PartShape::Box, size_m: Some([2.0, 4.0, 6.0]), ..moved };
        let can = PartInput { shape: PartShape::SolidCylinder, radius_m: Some(1.0), length_m: Some(2.0), ..moved };
        let drum = PartInput { shape: PartShape::HollowCylinder, outer_radius_m: Some(1.0), ..can };
        let ball = PartInput { shape: PartShape::Sphere, ..can };
        for (part, point, expected) in [
            (&cuboid, [1.0, 0.0, 0.0], -1.0),
            (&cuboid, [6.0, 0.0, 0.0], 3.0),
            (&cuboid, [1.0, 3.0, 0.0], 2.0),
            (&cuboid, [6.0, 5.0, 0.0], 5.0),
            (&cuboid, [2.5, 0.0, 0.0], -0.5),
            (&can, [1.0, 0.0, 5.0], 4.0),
            (&can, [1.0, 4.0, 5.0], 5.0),
            (&drum, [1.0, 0.75, 0.0], -0.25),
            (&ball, [1.0, 3.0, 4.0], 4.0),
            (&ball, [1.5, 0.0, 0.0], -0.5),
        ] {
            let found = distance(part, point).expect("a shape");
            // roundings of sums of size six; measured: 8.9e-16
            assert!((found - expected).abs() < 4e-15, "{point:?}: {found}, not {expected}");
        }
        assert_eq!(distance(&PartInput { shape: PartShape::PointMass, ..moved }, [0.0; 3]), None);
        assert_eq!([&cuboid, &can, &drum, &ball].map(inner_radius), [Some(1.0); 4]);
    }
}
