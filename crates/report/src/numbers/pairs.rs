//! Numbers of pairs beside each other.

use super::{Number, Rows};
use kelir_stats::inference::Interval;
use kelir_study::report::{LEVEL, PairsReport};

/// Whether pairs differ, and the model of participants and pairs.
pub(super) fn of(rows: Rows<'_>, pairs: &PairsReport) -> Vec<Number> {
    let mut all = Vec::new();
    if let Some(test) = &pairs.test {
        let ways = if test.exact { "all ways" } else { "random ways" };
        let note = format!(
            "small p: pairs differ; {ways} to deal participants' choices; n: participants whose choices differ"
        );
        let row = rows.number(format!("Cochran's Q (df = {})", test.df), test.q, 3).with_p(test.p);
        all.push(row.resolved_to(test.p_smallest).of_n(test.participants, &note));
    }
    if let Some(model) = &pairs.model {
        let interval = Interval { low: model.low, high: model.high, level: LEVEL };
        let row = rows.number("share over participants and pairs, mixed logit (proportion)", model.share, 3);
        let note = format!(
            "of participants and pairs as these are drawn from; t with {} degrees of freedom; n: choices",
            model.df
        );
        all.push(row.within(interval).of_n(model.choices, &note));
        all.push(rows.coefficient("log odds, participants and pairs random (logit)", &model.log_odds));
        all.push(rows.number("SD of participants' log odds, beside pairs (logit)", model.participant_sd, 3));
        all.push(
            Number { n: Some(model.pairs), ..rows.number("SD of pairs' log odds (logit)", model.pair_sd, 3) }
                .noted("n: pairs"),
        );
    }
    all
}
