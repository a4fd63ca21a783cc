//! How far one image is from another, in linear units.

/// What can be wrong with a comparison.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ErrorsError {
    /// Images of different sizes.
    #[error("{got} values compared with {reference}: the images must be of one size")]
    Sizes {
        /// Values of the image.
        got: usize,
        /// Values of the reference.
        reference: usize,
    },
    /// The unit is no positive number.
    #[error("full scale = {0}: a finite number above 0")]
    Scale(f64),
    /// A value that is not finite.
    #[error("value {index}: {got} compared with {reference}; both must be finite")]
    NotFinite {
        /// Where.
        index: usize,
        /// Value of the image.
        got: f64,
        /// Value of the reference.
        reference: f64,
    },
}

/// Differences `image − reference` in units of full scale.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Values compared; when 0, the others are 0.
    pub count: usize,
    /// Signed mean.
    pub bias: f64,
    /// Root of the mean square.
    pub rmse: f64,
    /// 99.9th percentile of the absolute differences: the smallest that at least 99.9 % do not exceed.
    pub p999: f64,
    /// Largest absolute difference.
    pub max: f64,
}

/// Compares `image` with `reference`, value by value, in units of `full_scale` (the brightest unshadowed point). With `mask`
/// only where it is true; it may cover one channel of several, which then follow each other plane by plane.
pub fn errors(
    image: &[f64],
    reference: &[f64],
    mask: Option<&[bool]>,
    full_scale: f64,
) -> Result<Errors, ErrorsError> {
    let sizes = ErrorsError::Sizes { got: image.len(), reference: reference.len() };
    if image.len() != reference.len() {
        return Err(sizes);
    }
    if !(full_scale.is_finite() && full_scale > 0.0) {
        return Err(ErrorsError::Scale(full_scale));
    }
    if let Some(mask) = mask
        && (mask.is_empty() || !image.len().is_multiple_of(mask.len()))
        && !image.is_empty()
    {
        return Err(ErrorsError::Sizes { got: image.len(), reference: mask.len() });
    }
    let mut differences = Vec::with_capacity(image.len());
    for (index, (got, reference)) in image.iter().zip(reference).enumerate() {
        if mask.is_some_and(|m| !m[index % m.len()]) {
            continue;
        }
        if !(got.is_finite() && reference.is_finite()) {
            return Err(ErrorsError::NotFinite { index, got: *got, reference: *reference });
        }
        differences.push((got - reference) / full_scale);
    }
    let count = differences.len();
    if count == 0 {
        return Ok(Errors::default());
    }
    let n = count as f64;
    let bias = differences.iter().sum::<f64>() / n;
    let rmse = (differences.iter().map(|d| d * d).sum::<f64>() / n).sqrt();
    differences.iter_mut().for_each(|d| *d = d.abs());
    let max = differences.iter().copied().fold(0.0, f64::max);
    let rank = ((0.999 * n).ceil() as usize).clamp(1, count) - 1;
    let (_, p999, _) = differences.select_nth_unstable_by(rank, f64::total_cmp);
    Ok(Errors { count, bias, rmse, p999: *p999, max })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    #[test]
    fn by_hand() {
        let e = errors(&[1.0, 2.0, 3.0, 4.0], &[1.0, 1.0, 5.0, 4.0], None, 2.0).unwrap();
        assert_eq!(e, Errors { count: 4, bias: -0.125, rmse: (1.25f64 / 4.0).sqrt(), p999: 1.0, max: 1.0 });
        let masked = errors(&[1.0, 2.0, 3.0, 4.0], &[1.0, 1.0, 5.0, 4.0], Some(&[false, true]), 2.0).unwrap();
        assert_eq!(
            masked,
            Errors { count: 2, bias: 0.25, rmse: (0.25f64 / 2.0).sqrt(), p999: 0.5, max: 0.5 }
        );
    }

    #[test]
    fn the_percentile_leaves_one_in_a_thousand() {
        let reference = vec![0.0; 4000];
        let mut image: Vec<f64> = (0..4000).map(|k| if k % 2 == 0 { 0.25 } else { -0.25 }).collect();
        image[7] = 1.0;
        image[8] = -2.0;
        image[9] = 3.0;
        image[10] = 4.0;
        let e = errors(&image, &reference, None, 1.0).unwrap();
        assert_eq!((e.p999, e.max), (0.25, 4.0));
        image[11] = 5.0;
        assert_eq!(errors(&image, &reference, None, 1.0).unwrap().p999, 1.0);
    }

    #[test]
    fn nothing_compared_is_zero_and_bad_input_is_named() {
        assert_eq!(errors(&[], &[], None, 1.0).unwrap(), Errors::default());
        assert_eq!(errors(&[1.0], &[2.0], Some(&[false]), 1.0).unwrap(), Errors::default());
        assert!(matches!(errors(&[1.0], &[], None, 1.0), Err(ErrorsError::Sizes { got: 1, reference: 0 })));
        assert!(matches!(errors(&[], &[], None, f64::NAN), Err(ErrorsError::Scale(_))));
        assert!(
            errors(&[1.0, f64::NAN], &[1.0, 1.0], None, 1.0).unwrap_err().to_string().contains("value 1")
        );
        assert!(errors(&[1.0; 3], &[1.0; 3], Some(&[true, true]), 1.0).is_err());
    }
}
