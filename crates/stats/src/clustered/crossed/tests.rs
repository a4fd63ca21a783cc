#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
//! Oracle: R 4.2.2, lme4 1.1-31, `glmer(y ~ 1 + (1|p) + (1|j), binomial, nAGQ = 1)` with bobyqa to rhoend = 1e-9 and tolPwrss = 1e-13; standard errors
//! by `vcov`, from finite differences.

use super::*;
use crate::clustered::tests::rows;
use crate::random::Random;

const K1: &str = "000101 100101 011101 110101 011110 000100 001100 110100 110101 111100 111101 010100 111111 001100 010101 111101 011111 010101";
const K2: &str = "101001 001111 001000 011001 001011 101101 111011 001000 101001 001110 111111 111111 001000 111111 011101 101101 001100 101110";
const K5: &str = "010111 011010 101110 101110 110000 001000 011110 001100 111110 111110 000111 111111 110010 010111 110111 111000 011101 110111";
/// Pairs that do not differ, and a participant with one answer.
const C: &str = "10001 01000 101-- 10101 11110 11101 -0000 00000 11111 11111 10111 1---- 01110 10111";
/// Participants who do not differ.
const B: &str = "00000101 00010000 00010001 00000101 00000110 00100100 00000101 00000000 00010000 10010001 00110110 00000100 00010101 00010100 00011101";

#[test]
fn fits_are_those_of_lme4() {
    for (text, [beta, error, participant_sd, pair_sd, log_likelihood]) in [
        (K1, [0.5470194808, 0.74938647, 0.84731331, 1.6125693, -64.0382812784]),
        (K2, [0.6604597918, 0.75487761, 1.3383423, 1.4954355, -65.0791180763]),
        (K5, [0.5043815437, 0.22864008, 0.26955979, 0.19397141, -71.6344077265]),
        (C, [0.5695225795, 0.49930869, 1.3930064, 0.0, -39.0799406612]),
        (B, [-1.462067494, 0.57609779, 0.0, 1.3749081, -59.6510664314]),
    ] {
        let found = crossed_logit(&rows(text)).unwrap();
        let close = |ours: f64, theirs: f64, tolerance: f64| (ours - theirs).abs() <= tolerance;
        assert!(close(found.log_odds.estimate, beta, 2e-6), "{found:?}");
        assert!(close(found.participant_sd, participant_sd, 2e-5), "{found:?}");
        assert!(close(found.pair_sd, pair_sd, 2e-5), "{found:?}");
        assert!(close(found.log_likelihood, log_likelihood, 1e-7), "{found:?}");
        assert!(close(found.log_odds.standard_error, error, 5e-3 * error), "{found:?}");
    }
}

#[test]
fn the_gradient_is_the_likelihoods() {
    let data = Data::new(&rows(C)).unwrap();
    for at in [[0.3, 0.8, 0.6], [-1.0, 0.2, 2.0], [0.5, 1e-3, 0.0]] {
        let (_, gradient) = data.laplace(&at);
        for (k, slope) in gradient.iter().enumerate() {
            let beside = |by: f64| {
                let mut there = at;
                there[k] += by;
                data.laplace(&there).0
            };
            let numeric = (beside(1e-4) - beside(-1e-4)) / 2e-4;
            assert!((slope - numeric).abs() < 1e-6, "{at:?} {k}: {slope} {numeric}");
        }
    }
}

#[test]
fn a_share_is_over_participants_and_pairs() {
    let found = crossed_logit(&rows(K2)).unwrap();
    // A plain sum over z, as finely as it takes.
    let spread = found.participant_sd.hypot(found.pair_sd);
    let share: f64 = (-90_000..=90_000)
        .map(|i| {
            let z = f64::from(i) * 1e-4;
            (-0.5 * z * z).exp() * 1e-4
                / std::f64::consts::TAU.sqrt()
                / (1.0 + (-(found.log_odds.estimate + spread * z)).exp())
        })
        .sum();
    assert!((found.share - share).abs() < 1e-12, "{} {share}", found.share);
    assert!(found.low < found.share && found.share < found.high);
    assert_eq!((found.df, found.participants, found.pairs, found.choices), (5.0, 18, 6, 108));
}

#[test]
fn intervals_of_the_log_odds_hold_the_truth() {
    let (mut held, mut plain, runs) = (0, 0, 200);
    for run in 0..runs {
        let mut random = Random::stream(5, run);
        let pairs: Vec<f64> = (0..8).map(|_| random.normal()).collect();
        let choices: Vec<Vec<Option<bool>>> = (0..20)
            .map(|_| {
                let own = 0.7 * random.normal();
                pairs.iter().map(|pair| Some(random.bernoulli(logistic(0.5 + own + pair)))).collect()
            })
            .collect();
        let c = crossed_logit(&choices).unwrap().log_odds;
        held += u32::from(c.low <= 0.5 && 0.5 <= c.high);
        // Control: without the pairs' own variance.
        let hits = choices.iter().flatten().filter(|y| **y == Some(true)).count() as f64;
        let (p, error) = (hits / 160.0, (hits / 160.0 * (1.0 - hits / 160.0) / 160.0).sqrt());
        plain += u32::from((p - mean_logistic(0.5, 0.7f64.hypot(1.0))).abs() <= 1.96 * error);
    }
    assert!(held >= 180, "{held} of {runs}");
    assert!(plain < 150, "taken as independent: {plain} of {runs}");
}

#[test]
fn what_cannot_be_fitted_is_said() {
    assert!(matches!(crossed_logit(&rows("11 11 11")), Err(StatsError::Separated { .. })));
    for consistent in ["11 00 11 00", "10 10 10 10"] {
        let error = crossed_logit(&rows(consistent)).unwrap_err();
        assert!(error.to_string().contains("without end"), "{error}");
    }
    assert!(matches!(crossed_logit(&rows("1- 0- 1-")), Err(StatsError::TooFew { name: "pairs", .. })));
    assert!(matches!(crossed_logit(&rows("10")), Err(StatsError::TooFew { name: "participants", .. })));
    assert!(matches!(crossed_logit(&rows("10 1")), Err(StatsError::LengthMismatch { .. })));
}
