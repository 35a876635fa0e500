//! Fixed-size matrices by rows, for filters and allocation: products, Cholesky factors, inverses.

pub fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let minor = |i: usize, j: usize| {
        let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| minor(j, i) / determinant))
}

pub fn multiplied<const N: usize, const K: usize, const M: usize>(
    a: &[[f64; K]; N],
    b: &[[f64; M]; K],
) -> [[f64; M]; N] {
    // row loops vectorise; closures of from_fn become calls
    let mut product = [[0.0; M]; N];
    for (row, of_a) in product.iter_mut().zip(a) {
        for (factor, of_b) in of_a.iter().zip(b) {
            for (entry, b) in row.iter_mut().zip(of_b) {
                *entry += factor * b;
            }
        }
    }
    product
}

pub fn transposed<const N: usize, const M: usize>(a: &[[f64; M]; N]) -> [[f64; N]; M] {
    let mut turned = [[0.0; N]; M];
    for (j, row) in a.iter().enumerate() {
        for (turned, entry) in turned.iter_mut().zip(row) {
            turned[j] = *entry;
        }
    }
    turned
}

pub fn added<const N: usize, const M: usize>(a: &[[f64; M]; N], b: &[[f64; M]; N]) -> [[f64; M]; N] {
    let mut sum = *a;
    for (row, of_b) in sum.iter_mut().zip(b) {
        row.iter_mut().zip(of_b).for_each(|(entry, b)| *entry += b);
    }
    sum
}

pub fn diagonal<const N: usize>(entries: [f64; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { entries[i] } else { 0.0 }))
}

/// The lower factor L of a = L L^T; `None` unless `a` is positive definite.
pub fn cholesky<const N: usize>(a: &[[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut l = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                if rest.is_nan() || rest <= 0.0 {
                    return None;
                }
                l[i][i] = rest.sqrt();
            } else {
                l[i][j] = rest / l[j][j];
            }
        }
    }
    Some(l)
}

/// Solves a x = b by the Cholesky factor `l` of `a`.
pub fn solved<const N: usize>(l: &[[f64; N]; N], b: [f64; N]) -> [f64; N] {
    let mut y = b;
    for i in 0..N {
        y[i] = (y[i] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
    }
    for i in (0..N).rev() {
        y[i] = (y[i] - (i + 1..N).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
    }
    y
}
