//! Mass, centre and inertia of homogeneous solids in closed form: Berdoz, *Final Report - ADR Spacecraft*, (60)-(67).
//!
//! Formulas are sums of positive parts (never a large solid minus a small one), good to a few units in the last place:
//! after thousands of radians an error of J is amplified in the attitude.

use crate::math::Real;

/// Mass properties of a rigid body in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<R = f64> {
    /// Mass, kg.
    pub mass: R,
    /// Centre of mass from the frame's origin, m (for the body from p in F_s; zero for the debris).
    pub center: [R; 3],
    /// Inertia tensor about the centre of mass, in the body's frame, kg m^2, by rows.
    pub inertia: [[R; 3]; 3],
}

/// pi - fl(pi), for types wider than `f64`.
const PI_LOW: f64 = 1.224_646_799_147_353_2e-16;

#[inline(always)]
fn pi<R: Real>(one: R) -> R {
    one.splat(core::f64::consts::PI) + one.splat(PI_LOW)
}

#[inline(always)]
fn diagonal<R: Real>(diagonal: [R; 3]) -> [[R; 3]; 3] {
    let zero = diagonal[0].zero();
    [[diagonal[0], zero, zero], [zero, diagonal[1], zero], [zero, zero, diagonal[2]]]
}

/// A hollow cylinder with closed ends, axis s3, base centre at the origin (60)-(67): `wall` t_s of shell and end
/// plates, outer `radius` rho_o, outer `length` l_s in m, `density` in kg/m^3. rho_o^2 - rho_i^2 = t (2 rho_o - t).
/// About ten roundings, none amplified.
pub fn hollow_cylinder<R: Real>(wall: R, radius: R, length: R, density: R) -> Body<R> {
    let k = |value: f64| wall.splat(value);
    let (bore, height) = (radius - wall, length - k(2.0) * wall);
    let shell = density * pi(wall) * (wall * (radius + bore)) * height;
    let plates = k(2.0) * (density * pi(wall) * (radius * radius) * wall);
    let mass = shell + plates;

    let (outer2, inner2) = (radius * radius, bore * bore);
    let axial = k(0.5) * (shell * (outer2 + inner2) + plates * outer2);
    let arm = k(0.5) * (length - wall);
    let transverse = shell * (k(0.25) * (outer2 + inner2) + height * height / k(12.0))
        + plates * (k(0.25) * outer2 + wall * wall / k(12.0) + arm * arm);

    let zero = wall.zero();
    Body { mass, center: [zero, zero, k(0.5) * length], inertia: diagonal([transverse, transverse, axial]) }
}

/// Mass and moments of inertia of a cylinder about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<R = f64> {
    pub mass: R,
    /// Moment about the cylinder's axis, kg m^2.
    pub axial: R,
    /// Moment about a transverse axis, kg m^2.
    pub transverse: R,
}

/// A solid cylinder (60)-(67). Sizes in m, density in kg/m^3; half a dozen roundings, none amplified.
pub fn solid_cylinder<R: Real>(radius: R, length: R, density: R) -> Cylinder<R> {
    let k = |value: f64| radius.splat(value);
    let radius2 = radius * radius;
    let mass = density * pi(radius) * radius2 * length;
    Cylinder {
        mass,
        axial: k(0.5) * mass * radius2,
        transverse: mass * (k(0.25) * radius2 + length * length / k(12.0)),
    }
}

impl<R: Real> Cylinder<R> {
    /// As a body with its centre at the origin and its axis along the third axis.
    pub fn body(self) -> Body<R> {
        let inertia = diagonal([self.transverse, self.transverse, self.axial]);
        Body { mass: self.mass, center: [self.mass.zero(); 3], inertia }
    }
}

/// A solid sphere, centre at the origin. Radius in m, density in kg/m^3.
pub fn sphere<R: Real>(radius: R, density: R) -> Body<R> {
    let k = |value: f64| radius.splat(value);
    let mass = k(4.0) / k(3.0) * (density * pi(radius) * (radius * radius * radius));
    let moment = k(2.0) / k(5.0) * (mass * (radius * radius));
    Body { mass, center: [k(0.0); 3], inertia: diagonal([moment; 3]) }
}

/// A solid box with sides along the axes, centre at the origin (60)-(67). Sizes in m, density in kg/m^3.
pub fn solid_box<R: Real>(size: [R; 3], density: R) -> Body<R> {
    let [a, b, c] = size;
    let mass = density * a * b * c;
    let twelfth = mass / a.splat(12.0);
    let moment = |x: R, y: R| twelfth * (x * x + y * y);
    Body { mass, center: [a.zero(); 3], inertia: diagonal([moment(b, c), moment(a, c), moment(a, b)]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{close, near};

    const QUADRATURE_TOLERANCE: f64 = 2e-13;

    /// Simpson's rule on [-1, 1], exact for the cubic integrands.
    const SIMPSON: [(f64, f64); 3] = [(-1.0, 1.0 / 3.0), (0.0, 4.0 / 3.0), (1.0, 1.0 / 3.0)];

    /// Berdoz's integrals over a piece: mass, first moment and -integral of r^x r^x, about the origin.
    #[derive(Default)]
    struct Moments {
        mass: f64,
        first: [f64; 3],
        second: [[f64; 3]; 3],
    }

    impl Moments {
        fn add(&mut self, r: [f64; 3], dm: f64) {
            let r2 = r.iter().map(|x| x * x).sum::<f64>();
            self.mass += dm;
            for i in 0..3 {
                self.first[i] += r[i] * dm;
                for j in 0..3 {
                    self.second[i][j] += (f64::from(i == j) * r2 - r[i] * r[j]) * dm;
                }
            }
        }

        /// Adds a ring r0..r1, z0..z1 by quadrature in cylindrical coordinates.
        fn add_ring(&mut self, [r0, r1]: [f64; 2], [z0, z1]: [f64; 2], density: f64) {
            const AROUND: usize = 16; // equal angles integrate the second harmonic exactly
            for (x, wx) in SIMPSON {
                for (y, wy) in SIMPSON {
                    let (r, z) = ((r0 + r1 + x * (r1 - r0)) / 2.0, (z0 + z1 + y * (z1 - z0)) / 2.0);
                    let area = wx * wy * (r1 - r0) * (z1 - z0) / 4.0;
                    for k in 0..AROUND {
                        let angle = std::f64::consts::TAU * k as f64 / AROUND as f64;
                        let volume = area * r * std::f64::consts::TAU / AROUND as f64;
                        self.add([r * angle.cos(), r * angle.sin(), z], density * volume);
                    }
                }
            }
        }

        fn assert_equals(&self, body: &Body) {
            let scale = self.second[0][0].abs() + self.second[2][2].abs();
            near(self.mass, body.mass, QUADRATURE_TOLERANCE);
            for i in 0..3 {
                let first = body.first_moment()[i];
                close(self.first[i], first, QUADRATURE_TOLERANCE * (self.mass + scale));
                for j in 0..3 {
                    let (here, there) = (self.second[i][j], body.inertia_about_origin()[i][j]);
                    close(here, there, QUADRATURE_TOLERANCE * scale);
                }
            }
        }
    }

    #[test]
    fn closed_forms_equal_the_integrals() {
        for (t, rho, l, sigma) in [(0.03, 1.0, 3.0, 2700.0), (0.2, 0.5, 0.9, 1.5), (1e-3, 2.0, 0.4, 8000.0)] {
            let mut moments = Moments::default();
            moments.add_ring([rho - t, rho], [t, l - t], sigma);
            moments.add_ring([0.0, rho], [0.0, t], sigma);
            moments.add_ring([0.0, rho], [l - t, l], sigma);
            moments.assert_equals(&hollow_cylinder(t, rho, l, sigma));
        }
        for (rho, l, sigma) in [(0.25, 0.1, 2700.0), (0.1, 2.0, 1.0)] {
            let mut moments = Moments::default();
            moments.add_ring([0.0, rho], [-l / 2.0, l / 2.0], sigma);
            let Cylinder { mass, axial, transverse } = solid_cylinder(rho, l, sigma);
            moments.assert_equals(&Body { mass, center: [0.0; 3], inertia: diagonal([transverse, transverse, axial]) });
        }
        for size in [[0.2, 0.2, 0.2], [0.1, 0.5, 2.0]] {
            let mut moments = Moments::default();
            for (x, wx) in SIMPSON {
                for (y, wy) in SIMPSON {
                    for (z, wz) in SIMPSON {
                        let r = [x * size[0] / 2.0, y * size[1] / 2.0, z * size[2] / 2.0];
                        moments.add(r, 2700.0 * wx * wy * wz * size[0] * size[1] * size[2] / 8.0);
                    }
                }
            }
            moments.assert_equals(&solid_box(size, 2700.0));
        }
    }

    #[test]
    fn a_thin_wall_keeps_its_digits() {
        // as t -> 0 the shell's mass over t tends to density 2 pi rho (l + rho); big-minus-small would lose all digits
        let t = 1e-12;
        let body = hollow_cylinder(t, 1.0, 3.0, 2700.0);
        let expected = 2700.0 * std::f64::consts::TAU * 4.0 * t;
        // off by some t itself, 1e-12; measured: 8.8e-13
        near(body.mass, expected, 4e-12);
        let naive = 2700.0 * std::f64::consts::PI * (3.0 - (1.0 - t) * (1.0 - t) * (3.0 - 2.0 * t));
        assert!((naive / expected - 1.0).abs() > 4e-12, "the rejected formula would pass this test");
    }
}
