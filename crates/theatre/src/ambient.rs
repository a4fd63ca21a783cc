//! The paper's ambient light: a shadow pales with its puppet's distance from the screen.
//!
//! L = L_lit · V̄ + (1 − V̄) · min(D / k_d, 1) · s · L_lit, per channel, where L_lit is the radiance without puppets, V̄ the
//! emitters' visibility weighted by E⁰, and D the planes' distances weighted by each plane's own 1 − V̄ᵢ. All techniques
//! share it and differ in V̄ alone.

/// The share (1 − V̄) · min(D / k_d, 1) · s of L_lit that is added to the lamp's own light, for one channel.
///
/// `lamp` is V̄ in [0, 1]; `distance_m` is D; `k_d_m` > 0; `s` in [0, 1].
#[inline]
pub(crate) fn share(lamp: f64, distance_m: f64, k_d_m: f64, s: f64) -> f64 {
    (1.0 - lamp) * (distance_m / k_d_m).min(1.0) * s
}

/// D: the mean of the planes' distances from the screen, each weighted by its 1 − V̄ᵢ; 0 where no plane shades at all.
///
/// `planes` yields (distance in metres, V̄ᵢ). One plane's D is its distance, whatever its visibility.
#[inline]
pub(crate) fn distance_m(planes: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut sum, mut weight, mut only, mut n) = (0.0, 0.0, 0.0, 0);
    for (distance, visibility) in planes {
        sum += distance * (1.0 - visibility);
        weight += 1.0 - visibility;
        only = distance;
        n += 1;
    }
    match n {
        1 => only,
        _ if weight > 0.0 => sum / weight,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_and_dark_pales_fully_near_or_lit_not_at_all() {
        assert_eq!(share(0.0, 2.0, 1.0, 0.3), 0.3);
        assert_eq!(share(0.0, 0.5, 1.0, 0.3), 0.15);
        assert_eq!(share(1.0, 0.5, 1.0, 0.3), 0.0);
        assert_eq!(share(0.0, 0.0, 1.0, 0.3), 0.0);
    }

    #[test]
    fn distance_is_weighted_by_shade() {
        assert_eq!(distance_m([(0.2, 0.0), (0.6, 1.0)]), 0.2);
        assert_eq!(distance_m([(0.2, 0.5), (0.6, 0.5)]), 0.4);
        assert_eq!(distance_m([(0.2, 1.0), (0.6, 1.0)]), 0.0);
        assert_eq!(distance_m([(0.2, 1.0)]), 0.2);
        assert_eq!(distance_m([]), 0.0);
    }
}
