//! Directions in F_s and their alignment errors.

use crate::math::prelude::*;

/// The unit vector along `direction` (of any length), turned by the alignment error `tilt` (rad), in the type of `one`.
///
/// `tilt` are components along [`across`] of the rotation vector theta from the nominal direction a_0 to the true one:
/// a = cos|theta| a_0 + sin|theta|/|theta| theta x a_0 (O. Rodrigues, 1840). The angle is good to `f64`, the length to
/// all digits; without a tilt an axis of F_s is exact.
pub fn aligned<R: Real>(direction: [f64; 3], tilt: [f64; 2], one: R) -> [R; 3] {
    if tilt == [0.0; 2] {
        let written = constant(one, direction);
        return match along_axis(direction) {
            Some((axis, sign)) => constant(one, unit(axis, sign)),
            None => scaled(one / norm(written), written),
        };
    }
    let [first, second] = across(direction);
    let theta = sum(scaled(tilt[0], first), scaled(tilt[1], second));
    turned(nominal(direction), theta, one)
}

/// Two unit vectors of F_s for an alignment error of `direction`: for an axis of F_s the others, in order; else the
/// axis of F_s farthest from `direction`, orthogonalised, and the product of both.
pub fn across(direction: [f64; 3]) -> [[f64; 3]; 2] {
    if let Some((axis, _)) = along_axis(direction) {
        let others = [[1, 2], [0, 2], [0, 1]][axis];
        return others.map(|other| unit(other, 1.0));
    }
    let a = nominal(direction);
    let farthest = (1..3).fold(0, |found, i| if a[i].abs() < a[found].abs() { i } else { found });
    let e = unit(farthest, 1.0);
    let first = sum(e, scaled(-dot(e, a), a));
    let first = scaled(1.0 / norm(first), first);
    [first, cross(a, first)]
}

/// The unit vector `axis` turned by the rotation vector `theta`, normal to it, rad.
fn turned<R: Real>(axis: [f64; 3], theta: [f64; 3], one: R) -> [R; 3] {
    let angle = dot(theta, theta).sqrt();
    let (sine, cosine) = libm::sincos(angle);
    let turned = constant(one, sum(scaled(cosine, axis), scaled(sine / angle, cross(theta, axis))));
    scaled(one / norm(turned), turned)
}

/// Index and sign of the axis of F_s along `direction`; `None` for an oblique one.
fn along_axis(direction: [f64; 3]) -> Option<(usize, f64)> {
    let mut along = (0..3).filter(|i| direction[*i] != 0.0);
    match (along.next(), along.next()) {
        (Some(axis), None) => Some((axis, direction[axis].signum())),
        _ => None,
    }
}

fn unit(axis: usize, sign: f64) -> [f64; 3] {
    let mut unit = [0.0; 3];
    unit[axis] = sign;
    unit
}

fn nominal(direction: [f64; 3]) -> [f64; 3] {
    match along_axis(direction) {
        Some((axis, sign)) => unit(axis, sign),
        None => scaled(1.0 / norm(direction), direction),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilt_turns_the_axis_by_its_angle_about_its_vector() {
        assert_eq!(aligned([0.0, 5.0, 0.0], [0.0; 2], 1.0), [0.0, 1.0, 0.0]);
        let (s2, s3) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        for (axis, tilt, expected) in [
            // about s1: s2 towards s3, s3 towards -s2; about s3: s2 towards -s1; about s2: s3 towards s1
            (s2, [0.3, 0.0], [0.0, 0.3f64.cos(), 0.3f64.sin()]),
            (s2, [0.0, 0.3], [-0.3f64.sin(), 0.3f64.cos(), 0.0]),
            (s3, [0.3, 0.0], [0.0, -0.3f64.sin(), 0.3f64.cos()]),
            (s3, [0.0, 0.3], [0.3f64.sin(), 0.0, 0.3f64.cos()]),
        ] {
            let axis = aligned(axis, tilt, 1.0);
            // an ulp of each entry, with rounded expectations; measured: 2.3e-16
            assert!(norm(difference(axis, expected)) < 4e-16, "{axis:?} {expected:?}");
        }
        let axis = aligned(s3, [0.3, -0.4], 1.0);
        assert!((axis[2] - 0.5f64.cos()).abs() < 4e-16, "the angle is the length of the vector");
        assert!((axis[1] / axis[0] - 0.75).abs() < 4e-16, "{axis:?}");
    }
}
