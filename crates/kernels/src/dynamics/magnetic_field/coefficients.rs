//! Coefficients of IGRF-14, the International Geomagnetic Reference Field (International Association of Geomagnetism
//! and Aeronomy, 2024, doi:10.5281/zenodo.14012302), and the weights of the harmonics in the field.
//!
//! The field is minus the gradient of a sum of solid harmonics V_nm, W_nm (L. Cunningham, 1970, Celestial Mechanics 2,
//! 207; O. Montenbruck & E. Gill, *Satellite Orbits*, 2000, eqs. 3.27 to 3.33), whose derivatives are harmonics of the
//! next degree.

use crate::scene::FieldModel;
use std::sync::LazyLock;

/// Reference radius of the coefficients, m.
pub const RADIUS: f64 = 6_371_200.0;

pub const DEGREE: usize = 13;

/// Year from which the secular variation applies; earlier fields are interpolated from 2020.
pub const MIDDLE: f64 = 2025.0;

/// Number of harmonics of the degrees 2 to 14.
pub const HARMONICS: usize = (DEGREE + 2) * (DEGREE + 3) / 2 - 3;

/// The index of the harmonics of degree `k` > 1 and order `j`.
#[inline(always)]
pub const fn index(k: usize, j: usize) -> usize {
    k * (k + 1) / 2 + j - 3
}

/// Weights of V and W in the Earth-fixed x, y and z of the field, T or T/year.
pub type Weights = [[f64; 6]; HARMONICS];

/// Weights of the field and their changes.
#[derive(Debug)]
pub struct Tables {
    /// In 2025, T.
    pub middle: Weights,
    /// Change per year after 2025, T.
    pub after: Weights,
    /// Mean change per year from 2020 to 2025, T.
    pub before: Weights,
}

pub static TABLES: LazyLock<Tables> = LazyLock::new(|| Tables {
    middle: weights(|[_, middle, _]| middle),
    after: weights(|[_, _, change]| change),
    before: weights(|[first, middle, _]| (middle - first) / (MIDDLE - FieldModel::YEARS[0])),
});

fn weights(of: impl Fn([f64; 3]) -> f64) -> Weights {
    const NANO: f64 = 1e-9;
    let row = |index: usize| match index.checked_sub(COEFFICIENTS.len()) {
        Some(higher) => [HIGHER[higher][0], HIGHER[higher][1], 0.0],
        None => COEFFICIENTS[index],
    };
    let gauss = |n: usize, m: usize| -> [f64; 2] {
        if m > n {
            return [0.0; 2];
        }
        // g of order 0, then g and h of each order
        let first = n * n - 1;
        let unit = NANO * schmidt(n, m);
        let g = of(row(if m == 0 { first } else { first + 2 * m - 1 }));
        let h = if m == 0 { 0.0 } else { of(row(first + 2 * m)) };
        [unit * g, unit * h]
    };
    let mut table = [[0.0; 6]; HARMONICS];
    for k in 2..=DEGREE + 1 {
        let n = k - 1;
        for j in 0..=k {
            let [mut lower, mut higher] = [[0.0; 2]; 2];
            if j == 1 {
                lower = [gauss(n, 0)[0], 0.0];
            } else if j > 1 {
                lower = gauss(n, j - 1).map(|value| 0.5 * value);
            }
            if j < n {
                let factor = 0.5 * ((n - j + 1) * (n - j)) as f64;
                higher = gauss(n, j + 1).map(|value| factor * value);
            }
            let factor = (k - j) as f64;
            let [along_v, along_w] = if j <= n { gauss(n, j).map(|value| factor * value) } else { [0.0; 2] };
            table[index(k, j)] = [
                lower[0] - higher[0],
                lower[1] - higher[1],
                -lower[1] - higher[1],
                lower[0] + higher[0],
                along_v,
                along_w,
            ];
        }
    }
    table
}

/// Schmidt's factor of degree `n` and order `m`: sqrt((2 - delta_0m) (n - m)!/(n + m)!).
fn schmidt(n: usize, m: usize) -> f64 {
    let ratio = (n - m + 1..=n + m).fold(1.0, |ratio, factor| ratio / factor as f64);
    (if m == 0 { ratio } else { 2.0 * ratio }).sqrt()
}

/// g_10, g_11, h_11, g_20, g_21, h_21, ...: in 2020 and 2025, nT, and secular variation from 2025 to 2030, nT/year.
#[rustfmt::skip]
const COEFFICIENTS: [[f64; 3]; 80] = [
    [-29403.41, -29350.0, 12.6], [-1451.37, -1410.3, 10.0], [4653.35, 4545.5, -21.5], [-2499.78, -2556.2, -11.2],
    [2981.96, 2950.9, -5.3], [-2991.72, -3133.6, -27.3], [1676.85, 1648.7, -8.3], [-734.62, -814.2, -11.1],
    [1363.0, 1360.9, -1.5], [-2380.8, -2404.2, -4.4], [-81.96, -56.9, 3.8], [1236.06, 1243.8, 0.4],
    [241.8, 237.6, -0.2], [525.6, 453.4, -15.6], [-542.52, -549.6, -3.9], [902.82, 894.7, -1.7], [809.47, 799.6, -2.3],
    [282.1, 278.6, -1.3], [86.18, 55.8, -5.8], [-158.5, -134.0, 4.1], [-309.47, -281.1, 5.4], [199.75, 212.0, 1.6],
    [47.44, 12.0, -6.8], [-350.3, -375.4, -4.1], [-234.42, -232.9, 0.6], [363.26, 369.0, 1.3], [47.52, 45.3, -0.5],
    [187.86, 187.2, 0.0], [208.36, 220.0, 2.1], [-140.73, -138.7, 0.7], [-121.43, -122.9, 0.5], [-151.16, -141.9, 2.3],
    [32.09, 42.9, 1.7], [13.98, 20.9, 1.0], [99.14, 106.2, 1.9], [65.97, 64.3, -0.2], [65.56, 63.8, -0.3],
    [-19.22, -18.4, 0.3], [72.96, 76.7, 0.8], [25.02, 16.8, -1.6], [-121.57, -115.7, 1.2], [52.76, 48.9, -0.4],
    [-36.06, -40.9, -0.8], [-64.4, -59.8, 0.8], [13.6, 14.9, 0.4], [8.96, 10.9, 0.7], [-64.8, -60.8, 0.9],
    [68.04, 72.8, 0.9], [80.54, 79.6, -0.1], [-76.63, -76.9, -0.1], [-51.5, -48.9, 0.6], [-8.23, -8.8, -0.1],
    [-16.85, -14.4, 0.5], [56.45, 59.3, 0.5], [2.36, -1.0, -0.7], [15.8, 15.8, -0.1], [23.56, 23.5, 0.0],
    [6.3, 2.5, -0.8], [-2.19, -7.4, -0.9], [-7.21, -11.2, -0.8], [-27.19, -25.1, 0.5], [9.77, 14.3, 0.9],
    [-1.9, -2.2, -0.3], [23.66, 23.1, -0.1], [9.74, 10.9, 0.2], [8.43, 7.2, -0.3], [-17.49, -17.5, 0.0],
    [-15.23, -12.6, 0.4], [-0.49, 2.0, 0.4], [12.83, 11.5, -0.3], [-21.07, -21.8, -0.1], [-11.76, -9.7, 0.4],
    [15.28, 16.9, 0.3], [14.94, 12.7, -0.5], [13.65, 14.9, 0.1], [3.62, 0.7, -0.6], [-16.59, -16.8, 0.0],
    [-6.9, -5.2, 0.3], [-0.34, 1.0, 0.3], [2.9, 3.9, 0.2],
];

#[rustfmt::skip]
const HIGHER: [[f64; 2]; DEGREE * (DEGREE + 2) - 80] = [
    [5.03, 4.7], [8.36, 8.0], [-23.44, -24.8], [2.84, 3.0], [11.04, 12.1], [-1.48, -0.2], [9.86, 8.3], [-1.14, -2.5],
    [-5.13, -3.4], [-13.22, -13.1], [-6.2, -5.3], [1.08, 2.4], [7.79, 7.2], [8.82, 8.6], [0.4, -0.6], [-9.23, -8.7],
    [-1.44, 0.8], [-11.86, -12.8], [9.6, 9.8], [-1.84, -1.3], [-6.25, -6.4], [3.38, 3.3], [-0.11, 0.2], [-0.18, 0.1],
    [1.66, 2.0], [3.5, 2.5], [-0.86, -1.0], [4.86, 5.4], [0.65, -0.5], [-8.62, -9.0], [-0.88, -0.9], [-0.11, 0.4],
    [1.88, 1.5], [-4.26, -4.2], [1.44, 0.9], [-3.43, -3.8], [-2.38, -2.6], [-0.1, 0.9], [-3.84, -3.9], [-8.84, -9.0],
    [2.96, 3.0], [-1.36, -1.4], [-0.02, 0.0], [-2.51, -2.5], [2.5, 2.8], [2.31, 2.4], [-0.55, -0.6], [-0.85, -0.6],
    [-0.39, 0.1], [0.28, 0.0], [0.62, 0.5], [-0.66, -0.6], [-0.21, -0.3], [-0.07, -0.1], [-1.66, -1.2], [1.44, 1.1],
    [-1.6, -1.7], [-0.59, -1.0], [-2.98, -2.9], [0.18, -0.1], [-1.97, -1.8], [3.09, 2.6], [-2.51, -2.3], [-2.0, -2.0],
    [-0.13, -0.1], [-1.15, -1.2], [0.43, 0.4], [0.52, 0.6], [1.28, 1.2], [1.37, 1.0], [-1.14, -1.2], [-1.81, -1.5],
    [0.71, 0.6], [0.08, 0.0], [0.31, 0.5], [0.71, 0.6], [0.49, 0.5], [-0.15, -0.2], [-0.26, -0.1], [0.55, 0.8],
    [-0.47, -0.5], [0.16, 0.1], [0.09, -0.2], [-0.93, -0.9], [-1.13, -1.2], [-0.04, 0.1], [-0.33, -0.7], [0.52, 0.2],
    [0.08, 0.2], [-0.93, -0.9], [-0.88, -0.9], [0.53, 0.6], [0.64, 0.7], [0.72, 0.7], [1.4, 1.2], [-0.3, -0.2],
    [-0.38, -0.3], [0.75, 0.5], [-1.31, -1.3], [-0.01, 0.1], [-0.09, -0.1], [0.76, 0.7], [0.29, 0.2], [-0.05, 0.0],
    [-0.11, -0.2], [0.37, 0.3], [0.47, 0.5], [0.13, 0.2], [0.54, 0.6], [0.45, 0.4], [-0.41, -0.6], [-0.46, -0.5],
    [-0.36, -0.3], [-0.4, -0.4], [-0.6, -0.5],
];
