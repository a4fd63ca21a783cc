//! Every number of a report, one at a time: what the tables show and the CSV holds.

mod order;
mod pairs;
mod psychometric;
mod scale;

pub(crate) use order::{of_block_order, of_order};
pub(crate) use psychometric::psychometric;
pub(crate) use scale::of_scale;

use crate::StudyReport;
use crate::display;
use crate::format::count;
use kelir_stats::clustered::{Bootstrap, Coefficient, ShareMethod};
use kelir_stats::inference::Interval;
use kelir_study::report::{ALPHA, BlockReport, LEVEL, Proportion};
use kelir_study::trials::Role;

/// Whose answers a number is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sample {
    /// Those who pass the study's rules of screening.
    Screened,
    /// Everybody, where somebody is left out.
    Everybody,
}

/// One number.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Whose answers it is of.
    pub sample: Sample,
    /// Block's id; empty for what is of the whole study.
    pub block: String,
    /// What was done.
    pub analysis: &'static str,
    /// What it is, with its unit.
    pub statistic: String,
    /// The number; `None` where only a p is given.
    pub value: Option<f64>,
    /// Its interval; an infinite end is beyond everything that could be shown.
    pub interval: Option<Interval>,
    /// The p-value that belongs to it.
    pub p: Option<f64>,
    /// The smallest p that so many resamples or simulations can give; `None` for a p that is computed.
    pub p_smallest: Option<f64>,
    /// How many participants or choices it rests on; the note says of what when it is not participants.
    pub n: Option<u64>,
    /// What a reader should know.
    pub note: String,
    /// Decimals that mean something.
    pub decimals: usize,
}

/// Every number of the report.
pub fn numbers(report: &StudyReport) -> Vec<Number> {
    let mut all = Vec::new();
    let people = &report.participants;
    for (statistic, value) in [
        ("sessions begun (participants)", people.started),
        ("in progress (participants)", people.in_progress),
        ("completed (participants)", people.completed),
        ("excluded by the study's rules (participants)", report.excluded.len() as u64),
        ("judged (participants)", report.standing.judged),
        ("of persons who had taken part before (sessions)", report.standing.repeated.len() as u64),
        ("trial runs (sessions)", report.standing.pilots),
        ("simulated (sessions)", report.standing.simulated),
        ("completed more than once (places)", report.standing.balance.doubled_places),
        ("target not first in half of the answers (items)", report.standing.balance.uneven.len() as u64),
    ] {
        all.push(Rows::of(Sample::Screened, "", "participants").whole(statistic, value));
    }
    if let Some(primary) = &report.report.primary {
        let row = Rows::of(Sample::Screened, "", "primary endpoint");
        let row = row.whole(
            format!("{}, {} (participants)", primary.of, primary.named.test.in_words()),
            primary.participants,
        );
        let row = Number { p: primary.p, ..row }.resolved_to(primary.p_smallest);
        all.push(row.noted("named in the study file; p uncorrected"));
    }
    let samples = [
        (Sample::Screened, Some(&report.report.blocks), report.report.scale.as_ref()),
        (Sample::Everybody, report.blocks_with_excluded.as_ref(), report.scale_with_excluded.as_ref()),
    ];
    for (sample, blocks, scale) in samples {
        for block in blocks.into_iter().flatten() {
            all.extend(of_block(sample, block));
            all.extend(block.psychometric.iter().flat_map(|p| psychometric(sample, &block.summary.id, p)));
        }
        all.extend(scale.into_iter().flat_map(|scale| of_scale(sample, scale)));
    }
    if let Some(consistency) = &report.report.consistency {
        let rows = Rows::of(Sample::Screened, "", "consistency");
        let triads = &consistency.triads;
        all.push(Number {
            n: Some(triads.triads),
            ..rows.whole("circular triads (of all triads)", triads.circular)
        });
        if let Some(zeta) = triads.consistence {
            all.push(rows.number("mean coefficient of consistence (0 to 1)", zeta, 3));
        }
        let odd = consistency.odd.len() as u64;
        all.push(Number {
            n: Some(consistency.observers),
            ..rows.whole("observers far from the others' scale (participants)", odd)
        });
    }
    if let Some(order) = &report.report.order {
        all.extend(of_order(order));
        all.extend(order.blocks.iter().flat_map(of_block_order));
    }
    for stimulus in &report.stimuli {
        let rows = Rows::of(Sample::Screened, "", "stimulus error");
        let at = match report.design.sizes() {
            [_] => String::new(),
            _ => format!(" at {}", display::size(stimulus.size)),
        };
        let of = format!("of {}, {}{at} (share of full scale)", stimulus.item, stimulus.condition);
        if let Some(error) = stimulus.error() {
            let what = if error.own { "own standard error" } else { "RMSE in penumbra" };
            all.push(rows.number(format!("{what} {of}"), error.rms, 6));
            all.extend(
                error.floor.map(|floor| rows.number(format!("the reference's noise in that {of}"), floor, 6)),
            );
        }
    }
    all
}

/// What numbers of one analysis have in common.
#[derive(Clone, Copy)]
struct Rows<'a> {
    sample: Sample,
    block: &'a str,
    analysis: &'static str,
}

impl<'a> Rows<'a> {
    fn of(sample: Sample, block: &'a str, analysis: &'static str) -> Rows<'a> {
        Rows { sample, block, analysis }
    }

    fn named(self, analysis: &'static str) -> Rows<'a> {
        Rows { analysis, ..self }
    }

    fn number(self, statistic: impl Into<String>, value: f64, decimals: usize) -> Number {
        Number {
            sample: self.sample,
            block: self.block.to_owned(),
            analysis: self.analysis,
            statistic: statistic.into(),
            value: Some(value),
            interval: None,
            p: None,
            p_smallest: None,
            n: None,
            note: String::new(),
            decimals,
        }
    }

    fn whole(self, statistic: impl Into<String>, value: u64) -> Number {
        self.number(statistic, value as f64, 0)
    }

    /// A share with its interval over participants.
    fn share(self, statistic: impl Into<String>, share: &Proportion) -> Number {
        let row = self.number(statistic, share.proportion, 3).of_n(share.trials, &interval_of(share));
        Number { interval: share.interval(), ..row }
    }

    fn coefficient(self, statistic: &str, c: &Coefficient) -> Number {
        let interval = Interval { low: c.low, high: c.high, level: LEVEL };
        self.number(statistic, c.estimate, 3).within(interval).with_p(c.p)
    }
}

impl Number {
    fn within(self, interval: Interval) -> Number {
        Number { interval: Some(interval), ..self }
    }

    fn with_p(self, p: f64) -> Number {
        Number { p: Some(p), ..self }
    }

    /// A p that comes from resamples, of which the smallest possible is `smallest`.
    fn resolved_to(self, smallest: Option<f64>) -> Number {
        Number { p_smallest: smallest, ..self }
    }

    fn of_n(self, n: u64, note: &str) -> Number {
        Number { n: Some(n), note: note.to_owned(), ..self }
    }

    fn noted(self, note: impl Into<String>) -> Number {
        Number { note: note.into(), ..self }
    }
}

/// What a share's interval is, and what its n counts.
fn interval_of(share: &Proportion) -> String {
    let people = count(share.participants, "participant");
    let Some(found) = share.by_participant else {
        return share.note.as_ref().map_or("n: choices".to_owned(), |why| format!("{why} n: choices"));
    };
    match found.method {
        ShareMethod::Wilson => "Wilson's interval; n: choices, one a participant".to_owned(),
        ShareMethod::ClusteredWilson => {
            format!(
                "Wilson's interval of {:.0} independent choices, the worth of those of {people}; n: choices",
                found.effective_trials
            )
        }
        ShareMethod::ClopperPearson => {
            format!("all alike: Clopper and Pearson's interval over {people}; n: choices")
        }
    }
}

fn resampled(found: &Bootstrap) -> Interval {
    Interval { low: found.low, high: found.high, level: found.level }
}

/// Every number of one block but its psychometric function's.
pub(crate) fn of_block(sample: Sample, block: &BlockReport) -> Vec<Number> {
    let (summary, analysis) = (&block.summary, &block.analysis);
    let target = &summary.target;
    let rows = |name| Rows::of(sample, &summary.id, name);
    let mut all = Vec::new();

    let counted = rows("counts");
    all.push(counted.whole("answered every pair (participants)", summary.n));
    all.push(counted.whole("left out: answered some pairs only (participants)", summary.incomplete));
    for (choices, people) in &summary.counts {
        all.push(
            counted.whole(
                format!("chose {target} {choices} of {} times (participants)", summary.items),
                *people,
            ),
        );
    }

    let t = rows("t-test");
    let mean = summary.mean.map(|x| {
        t.number(format!("mean choices of {target} (of {})", count(summary.items as u64, "pair")), x, 4)
    });
    all.extend(mean.map(|row| Number { n: Some(summary.n), ..row }));
    all.extend(summary.sd.map(|x| t.number("standard deviation (choices)", x, 4)));
    all.push(t.number("expected of who cannot tell (choices)", summary.mu, 1));
    if let (Some(value), Some(df), Some(p)) = (summary.t, summary.df, summary.p) {
        all.push(Number { n: Some(summary.n), ..t.number(format!("t (df = {df})"), value, 4).with_p(p) });
        if let Some(p_holm) = block.p_holm.filter(|_| !block.primary) {
            all.push(t.number("t, p corrected by Holm for all planned tests", value, 4).with_p(p_holm));
        }
    }

    let effects = rows("effect size");
    if let Some(effect) = &analysis.effect {
        all.push(effects.number("Cohen's d (SD)", effect.d, 3).within(effect.d_interval));
        all.push(effects.number("Hedges' g (SD)", effect.g, 3).within(effect.g_interval));
    }
    if let (Some(found), Some(mean)) = (&analysis.equivalence, summary.mean) {
        let items = summary.items as f64;
        let name = format!("share − ½, equivalent within ±{}? (proportion)", found.within);
        let Interval { low, high, level } = found.tests.interval_90;
        let row =
            rows("equivalence (TOST)").number(name, (mean - summary.mu) / items, 4).with_p(found.tests.p);
        let row = row.within(Interval { low: low / items, high: high / items, level });
        all.push(row.noted("p below 0.05 shows equivalence; 90% interval"));
    }
    if let Some(bayes) = &analysis.bayes {
        let row = rows("Bayes factor").number("BF₀₁, for no effect against one (ratio)", bayes.bf01, 2);
        all.push(
            row.noted("above 3 some, above 10 strong evidence for no effect; below 1/3 and 1/10 against it"),
        );
    }

    let ranks = rows("without normality");
    if let Some(sign) = &analysis.sign {
        let row = ranks.whole("sign test: above chance (participants)", sign.successes).with_p(sign.p);
        all.push(row.of_n(sign.n, "n: participants not at chance"));
    }
    if let Some(wilcoxon) = &analysis.wilcoxon {
        let row = ranks.number("Wilcoxon's V (sum of ranks)", wilcoxon.v, 1).with_p(wilcoxon.p);
        all.push(row.of_n(wilcoxon.n, "n: participants not at chance"));
    }

    let choices = rows("all choices");
    if let Some(share) = &analysis.proportion {
        all.push(choices.share(format!("share of {target} (proportion)"), share));
        if share.participants < share.trials {
            let row = choices
                .number("the same, Wilson's interval (proportion)", share.proportion, 3)
                .within(share.wilson);
            all.push(row.of_n(share.trials, "n: choices, wrongly taken as independent"));
        }
    }
    if let Some(binomial) = &analysis.binomial {
        let note = if summary.items > 1 { "n: choices, wrongly taken as independent" } else { "n: choices" };
        let row = choices.whole(format!("exact binomial test: chose {target} (choices)"), binomial.successes);
        all.push(row.with_p(binomial.p).of_n(binomial.n, note));
    }

    let clustered = rows("clustered choices");
    if let Some(found) = &analysis.intraclass {
        all.push(Number {
            n: Some(found.participants),
            ..clustered.number("intraclass correlation (−1 to 1)", found.icc, 3)
        });
        all.push(clustered.number("design effect (variance ratio)", found.design_effect, 3));
    }
    if let Some(c) = analysis.robust_logit.as_ref().and_then(|l| l.coefficients.first()) {
        all.push(clustered.coefficient("log odds, cluster-robust (logit)", c));
    }
    if let Some(found) = &analysis.mixed_logit {
        all.extend(
            found
                .coefficients
                .first()
                .map(|c| clustered.coefficient("log odds, random intercept (logit)", c)),
        );
        let row =
            clustered.number("SD of participants' log odds (logit)", found.sigma, 3).with_p(found.sigma_p);
        all.push(row);
    }

    if let Some(pairs) = &block.pairs {
        all.extend(pairs::of(rows("pairs beside each other"), pairs));
    }

    let power = rows("power");
    for plan in &analysis.power {
        let row = power.number(format!("power for d = {} (probability)", plan.d), plan.power, 3);
        all.push(row.of_n(plan.n, &format!("two-tailed, α = {ALPHA}")));
    }
    all.extend(analysis.detectable.map(|plan| power.number("effect found with 80% power (SD)", plan.d, 3)));

    for pair in &block.by_item {
        all.extend(
            pair.target.as_ref().map(|share| {
                rows("pairs").share(format!("{}: share of {target} (proportion)", pair.id), share)
            }),
        );
    }
    let (what, bias) = match block.first_role {
        Role::Left | Role::Right => ("share of the left picture (proportion)", "a bias of side"),
        Role::First | Role::Second => ("share of the first interval (proportion)", "a bias of order"),
    };
    all.extend(block.first.as_ref().map(|first| {
        let row = rows("sides").share(what, first);
        let note = format!("{}; far from 0.5: {bias}", row.note);
        row.noted(note)
    }));
    if let Some(found) = &block.first_intraclass {
        let row = rows("sides").number("intraclass correlation of sides (−1 to 1)", found.icc, 3);
        all.push(row.of_n(
            found.participants,
            "above 0, some participants lean one way and some the other, which cancels in the share",
        ));
    }
    if let Some(times) = &block.rt_ms {
        let row = rows("response time");
        for (name, ms) in [
            ("first quartile (ms)", times.q1),
            ("median (ms)", times.median),
            ("third quartile (ms)", times.q3),
        ] {
            all.push(row.number(name, ms, 0).of_n(times.n, "n: answers"));
        }
    }
    all
}
