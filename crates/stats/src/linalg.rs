//! Small dense symmetric systems, row-major: as much linear algebra as the fits need.

/// The Cholesky factor L (lower, row-major p × p) of a symmetric positive definite matrix; `None` if it isn't.
pub(crate) fn cholesky(a: &[f64], p: usize) -> Option<Vec<f64>> {
    let mut l = vec![0.0; p * p];
    for i in 0..p {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * p + k] * l[j * p + k]).sum();
            let rest = a[i * p + j] - dot;
            if i == j {
                // A pivot lost to cancellation means a singular matrix.
                if !(rest > 1e-14 * a[i * p + i].abs() && rest.is_finite()) {
                    return None;
                }
                l[i * p + i] = rest.sqrt();
            } else {
                l[i * p + j] = rest / l[j * p + j];
            }
        }
    }
    Some(l)
}

/// Solves L Lᵀ x = b in place.
pub(crate) fn solve(l: &[f64], p: usize, b: &mut [f64]) {
    for i in 0..p {
        let dot: f64 = (0..i).map(|k| l[i * p + k] * b[k]).sum();
        b[i] = (b[i] - dot) / l[i * p + i];
    }
    for i in (0..p).rev() {
        let dot: f64 = (i + 1..p).map(|k| l[k * p + i] * b[k]).sum();
        b[i] = (b[i] - dot) / l[i * p + i];
    }
}

/// The inverse of L Lᵀ, row-major p × p.
pub(crate) fn inverse(l: &[f64], p: usize) -> Vec<f64> {
    let mut out = vec![0.0; p * p];
    let mut column = vec![0.0; p];
    for j in 0..p {
        column.fill(0.0);
        column[j] = 1.0;
        solve(l, p, &mut column);
        for i in 0..p {
            out[i * p + j] = column[i];
        }
    }
    out
}

/// ln det of L Lᵀ.
pub(crate) fn log_det(l: &[f64], p: usize) -> f64 {
    (0..p).map(|i| 2.0 * l[i * p + i].ln()).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    #[test]
    fn solves_and_inverts() {
        let a = [4.0, 2.0, 1.0, 2.0, 5.0, 3.0, 1.0, 3.0, 6.0];
        let l = cholesky(&a, 3).unwrap();
        let inv = inverse(&l, 3);
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| a[i * 3 + k] * inv[k * 3 + j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
        assert!((log_det(&l, 3) - 67f64.ln()).abs() < 1e-14);
        assert!(cholesky(&[1.0, 1.0, 1.0, 1.0], 2).is_none());
        assert!(cholesky(&[f64::NAN], 1).is_none());
    }
}
