//! How the numbers were got: a methods section of what was computed for this study, and nothing else.

mod design;

use super::{
    ALPHA, ChoiceAnalysis, DETECTION_POWER, FENCES, LEVEL, POWER_EFFECTS, REPLICATES, Report, scaling,
};
use crate::definition::{GUESS, StudyDefinition};
use kelir_stats::clustered::ShareMethod;
use kelir_stats::pairwise::Estimator;

const HEDGES: &str = "Hedges, L. V. (1981). Distribution theory for Glass's estimator of effect size and related estimators. Journal of \
     Educational Statistics, 6(2), 107–128.";
const STEIGER: &str = "Steiger, J. H., & Fouladi, R. T. (1997). Noncentrality interval estimation and the evaluation of statistical models. \
     In L. L. Harlow, S. A. Mulaik, & J. H. Steiger (Eds.), What if there were no significance tests? (pp. 221–257). Erlbaum.";
const HOLM: &str = "Holm, S. (1979). A simple sequentially rejective multiple test procedure. Scandinavian Journal of Statistics, 6(2), 65–70.";
const SCHUIRMANN: &str = "Schuirmann, D. J. (1987). A comparison of the two one-sided tests procedure and the power approach for assessing the \
     equivalence of average bioavailability. Journal of Pharmacokinetics and Biopharmaceutics, 15(6), 657–680.";
const ROUDER: &str = "Rouder, J. N., Speckman, P. L., Sun, D., Morey, R. D., & Iverson, G. (2009). Bayesian t tests for accepting and \
     rejecting the null hypothesis. Psychonomic Bulletin & Review, 16(2), 225–237.";
const WILCOXON: &str =
    "Wilcoxon, F. (1945). Individual comparisons by ranking methods. Biometrics Bulletin, 1(6), 80–83.";
const WILSON: &str = "Wilson, E. B. (1927). Probable inference, the law of succession, and statistical inference. Journal of the American \
     Statistical Association, 22(158), 209–212.";
const HALL: &str = "Hall, P. (1988). On symmetric bootstrap confidence intervals. Journal of the Royal Statistical Society: Series B, 50(1), 35–45.";
const HESTERBERG: &str = "Hesterberg, T. C. (2015). What teachers should know about the bootstrap: resampling in the undergraduate statistics curriculum. \
     The American Statistician, 69(4), 371–386.";
const FLEISS: &str = "Fleiss, J. L., & Cuzick, J. (1979). The reliability of dichotomous judgments: unequal numbers of judges per subject. \
     Applied Psychological Measurement, 3(4), 537–542.";
const LIANG: &str = "Liang, K.-Y., & Zeger, S. L. (1986). Longitudinal data analysis using generalized linear models. Biometrika, 73(1), 13–22.";
const THURSTONE: &str =
    "Thurstone, L. L. (1927). A law of comparative judgment. Psychological Review, 34(4), 273–286.";
const PEREZ: &str = "Perez-Ortiz, M., & Mantiuk, R. K. (2017). A practical guide and software for analysing pairwise comparison experiments. \
     arXiv:1712.03686.";
const KENDALL: &str = "Kendall, M. G., & Babington Smith, B. (1940). On the method of paired comparisons. Biometrika, 31(3/4), 324–345.";
const SCHUETT: &str = "Schütt, H. H., Harmeling, S., Macke, J. H., & Wichmann, F. A. (2016). Painfree and accurate Bayesian estimation of psychometric \
     functions for (potentially) overdispersed data. Vision Research, 122, 105–123.";
const WICHMANN: &str = "Wichmann, F. A., & Hill, N. J. (2001). The psychometric function: I. Fitting, sampling, and goodness of fit. Perception & \
     Psychophysics, 63(8), 1293–1313.";
const FIRTH: &str =
    "Firth, D. (1993). Bias reduction of maximum likelihood estimates. Biometrika, 80(1), 27–38.";

const KOSMIDIS: &str = "Kosmidis, I., & Firth, D. (2021). Jeffreys-prior penalty, finiteness and shrinkage in binomial-response generalized linear models. \
     Biometrika, 108(1), 71–82.";
const EFRON: &str = "Efron, B., & Stein, C. (1981). The jackknife estimate of variance. The Annals of Statistics, 9(3), 586–596.";
const HEMERIK: &str = "Hemerik, J., Goeman, J. J., & Finos, L. (2020). Robust testing in generalized linear models by sign flipping score contributions. \
     Journal of the Royal Statistical Society: Series B, 82(3), 841–864.";
const CLOPPER: &str = "Clopper, C. J., & Pearson, E. S. (1934). The use of confidence or fiducial limits illustrated in the case of the binomial. \
     Biometrika, 26(4), 404–413.";
const DEAN: &str = "Dean, N., & Pagano, M. (2015). Evaluating confidence interval methods for binomial proportions in clustered surveys. Journal of \
     Survey Statistics and Methodology, 3(4), 484–503.";
const STUDENT: &str = "Student (1908). The probable error of a mean. Biometrika, 6(1), 1–25.";
const DIXON: &str = "Dixon, W. J., & Mood, A. M. (1946). The statistical sign test. Journal of the American Statistical Association, 41(236), 557–566.";
const PINHEIRO: &str = "Pinheiro, J. C., & Bates, D. M. (1995). Approximations to the log-likelihood function in the nonlinear mixed-effects model. \
     Journal of Computational and Graphical Statistics, 4(1), 12–35.";
const SELF: &str = "Self, S. G., & Liang, K.-Y. (1987). Asymptotic properties of maximum likelihood estimators and likelihood ratio tests under nonstandard \
     conditions. Journal of the American Statistical Association, 82(398), 605–610.";
const TUKEY: &str = "Tukey, J. W. (1977). Exploratory data analysis. Addison-Wesley.";
const COCHRAN: &str =
    "Cochran, W. G. (1950). The comparison of percentages in matched samples. Biometrika, 37(3/4), 256–266.";
const LANDIS: &str = "Landis, J. R., Heyman, E. R., & Koch, G. G. (1978). Average partial association in three-way contingency tables: a review and discussion \
     of alternative tests. International Statistical Review, 46(3), 237–254.";
const BATES: &str = "Bates, D., Mächler, M., Bolker, B., & Walker, S. (2015). Fitting linear mixed-effects models using lme4. Journal of Statistical \
     Software, 67(1), 1–48.";
const JEFFREYS: &str = "Jeffreys, H. (1961). Theory of probability (3rd ed.). Oxford University Press.";

/// Paragraphs of methods, and references, for what `report` holds.
pub(super) fn of(study: &StudyDefinition, report: &Report) -> (Vec<String>, Vec<String>) {
    let mut text = Text::default();
    design::say(&mut text, study);
    text.say(screening(study), &[]);
    text.say(endpoint(study), &[]);
    if any(report, |a| a.t_test.t.is_some()) {
        tests(&mut text, study, report);
    }
    if any(report, |a| a.proportion.is_some()) {
        proportions(&mut text, report);
    }
    pairs(&mut text, report);
    psychometric(&mut text, report);
    scale(&mut text, study, report);
    order(&mut text, report);
    (text.paragraphs, text.references)
}

/// What was looked at besides.
fn order(text: &mut Text, report: &Report) {
    let Some(found) = &report.order else { return };
    let mut said = vec![format!(
        "Not planned, and to look at: each participant's choices of what stood first were compared with a half by the exact binomial test, corrected by \
         Holm's method for the {} tested, and over all participants by flipping the signs of their differences from a half.",
        found.tested
    )];
    let mut references = vec![HOLM, HEMERIK];
    let slopes = found.blocks.iter().flat_map(|block| [&block.place, &block.speed]).flatten();
    if slopes.chain(&found.agreement).next().is_some() {
        said.push(
            "Changes over a block's trials, of choices of the target and of agreement with most others in the same pair, and of choices with the time they took \
             are least-squares slopes within participants; intervals are robust to any dependence within participants, and p is by dealing choices out anew \
             within each participant and block."
                .to_owned(),
        );
        references.push(LIANG);
    }
    if found.blocks.iter().any(|block| block.outliers.is_some()) {
        said.push(format!(
            "Outliers among a block's response times lie more than {FENCES} interquartile ranges of their logarithm below the first or above the third quartile \
             (Tukey's fences); they were counted, not left out."
        ));
        references.push(TUKEY);
    }
    text.say(said.join(" "), &references);
}

/// Whether something of a block's analysis is there.
fn any(report: &Report, is: impl Fn(&ChoiceAnalysis) -> bool) -> bool {
    report.blocks.iter().any(|block| is(&block.analysis))
}

/// What was said, with what it rests on.
#[derive(Default)]
struct Text {
    paragraphs: Vec<String>,
    references: Vec<String>,
}

impl Text {
    fn say(&mut self, paragraph: String, references: &[&str]) {
        self.paragraphs.push(paragraph);
        for reference in references {
            if !self.references.iter().any(|known| known == reference) {
                self.references.push((*reference).to_owned());
            }
        }
    }
}

fn screening(study: &StudyDefinition) -> String {
    let rules = &study.screening;
    let mut excluded = Vec::new();
    if let Some(least) = rules.min_rt_ms {
        excluded.push(format!("with more than {} answers faster than {least} ms", rules.max_fast_trials));
    }
    if let Some(most) = rules.max_failed_catch_trials {
        excluded.push(format!("with more than {most} wrong answers in catch trials"));
    }
    if rules.straight_lining {
        excluded.push("who chose the same side in every trial".to_owned());
    }
    excluded.extend(
        rules.flags.iter().map(|flag| format!("of whose session it was noticed that {}", flag.meaning())),
    );
    if rules.incomplete {
        excluded.push("who did not finish".to_owned());
    }
    let counted = "Of each person one session was analysed, the first complete one (where none was complete, the first with answers); trial runs \
         and simulations were not. Tests and the share of all choices of a block count the participants who answered all its items; the shares of single \
         items and of sides, response times, psychometric functions and the scale take the answers of everybody.";
    if excluded.is_empty() {
        format!("The study file states no rules of exclusion, and nobody was excluded. {counted}")
    } else {
        let who = excluded.join("; ");
        format!(
            "By rules in the study file, which are part of the version that participants answered, participants were excluded {who}. {counted}"
        )
    }
}

/// Which result was singled out beforehand.
fn endpoint(study: &StudyDefinition) -> String {
    let Some(named) = &study.primary else {
        return "The study file names no primary endpoint: no result was singled out beforehand, and none is reported as if it had been.".to_owned();
    };
    let planned = match named.participants {
        Some(n) => format!(", to be looked at when {n} participants are judged"),
        None => "; the file does not say after how many participants it is to be looked at".to_owned(),
    };
    format!(
        "The primary endpoint named in the study file is the {} of {} at a level of {ALPHA}, uncorrected{planned}. Everything else is secondary, or exploratory where \
         no test was planned.",
        named.test.in_words(),
        named.subject()
    )
}

fn tests(text: &mut Text, study: &StudyDefinition, report: &Report) {
    let tested = report.blocks.iter().filter(|b| b.planned && !b.primary).count();
    let other = if report.blocks.iter().any(|b| b.primary) { "other planned" } else { "planned" };
    let holm = if tested > 1 {
        format!(
            " P-values are also given corrected by Holm's method for the {tested} {other} tests, whether or not each is defined: the k-th smallest is \
             multiplied by {tested} + 1 − k, and is never below the one before nor above 1."
        )
    } else {
        String::new()
    };
    let unplanned: Vec<String> = report
        .blocks
        .iter()
        .filter(|b| !b.planned && b.summary.p.is_some())
        .map(|b| b.summary.title.clone())
        .collect();
    let holm = if unplanned.is_empty() {
        holm
    } else {
        format!(
            "{holm} The study file plans no such test of {}; it is given uncorrected, and nothing is concluded from it.",
            unplanned.join(", ")
        )
    };
    text.say(
        format!(
            "Per block, the number of choices of the target condition by each participant was compared with half the number of items, \
             μ₀, by a two-tailed one-sample t-test: t = (M − μ₀) / (SD / √n) with n − 1 degrees of freedom, where M is the mean over the n \
             participants and SD their standard deviation with n − 1 in the denominator.{holm}"
        ),
        if tested > 1 { &[STUDENT, HOLM] } else { &[STUDENT] },
    );
    text.say(
        format!(
            "Effect sizes are Cohen's d = (M − μ₀) / SD and Hedges' g = J d with J = Γ(ν/2) / (√(ν/2) Γ((ν − 1)/2)) and ν = n − 1, with {:.0}% \
             intervals from the noncentral t distribution. The Bayes factor is that of Jeffreys, Zellner and Siow for a standardised effect with a Cauchy \
             prior of scale √2/2 against no effect. Without the assumption of normality the same numbers were compared with μ₀ by an exact \
             sign test and by Wilcoxon's signed-rank test with the exact distribution of tied ranks (above 500 values, its normal approximation); both leave out participants at μ₀.",
            100.0 * LEVEL
        ),
        &[HEDGES, STEIGER, ROUDER, JEFFREYS, DIXON, WILCOXON],
    );
    if let Some(bound) = &study.equivalence {
        text.say(
            format!(
                "Equivalence of the share of target choices to one half was tested by two one-sided t-tests with bounds of ±{} on the share; the larger of \
                 the two p-values is given. The study file's reason for the bound: {}",
                bound.within, bound.reason
            ),
            &[SCHUIRMANN],
        );
    }
    let effects = POWER_EFFECTS.map(|d| d.to_string()).join(", ");
    text.say(
        format!(
            "Power is that of the two-tailed t-test at α = 0.05 with the participants there are, for true effects of d = {effects}, and the \
             detectable effect is the one that it finds with a probability of {:.0}%. Neither is computed from the effect observed.",
            100.0 * DETECTION_POWER
        ),
        &[],
    );
}

fn proportions(text: &mut Text, report: &Report) {
    let shares = || {
        let all = report.blocks.iter().flat_map(|block| {
            let levels = block.psychometric.iter().flat_map(|p| &p.points).map(|point| &point.target);
            let items = block.by_item.iter().map(|item| &item.target);
            [&block.analysis.proportion, &block.first].into_iter().chain(items).chain(levels)
        });
        all.flatten().filter_map(|share| share.by_participant.map(|found| found.method))
    };
    let mut said =
        "Intervals of shares are over participants, because choices of one participant are not independent."
            .to_owned();
    let mut references = Vec::new();
    if shares().any(|method| method == ShareMethod::Wilson) {
        said.push_str(" Where each made one choice they are Wilson's.");
        references.push(WILSON);
    }
    if shares().any(|method| method == ShareMethod::ClusteredWilson) {
        said.push_str(
            " Where some made several they are Wilson's with the number of choices divided by their design effect, estimated from how participants \
             spread (half of one who always and half of one who never chose the target added to them) and never below 1.",
        );
        references.extend([WILSON, DEAN]);
    }
    if shares().any(|method| method == ShareMethod::ClopperPearson) {
        said.push_str(" Where all of several choices each were one, every participant counts once, in Clopper and Pearson's interval.");
        references.push(CLOPPER);
    }
    said.push_str(
        " The binomial test is the exact two-sided one (the sum of the probabilities of all outcomes no likelier than the one seen).",
    );
    if any(report, |a| a.intraclass.is_some()) {
        said.push_str(
            " The intraclass correlation is 1 − Σ yᵢ(nᵢ − yᵢ)/nᵢ / ((N − m) p(1 − p)) for m participants with yᵢ target choices of nᵢ, N in \
             all and p the pooled share.",
        );
        references.push(FLEISS);
    }
    if any(report, |a| a.robust_logit.is_some()) {
        said.push_str(
            " The log odds of a target choice were estimated by logistic regression with standard errors that are robust to any \
             dependence within participants (factor m/(m − 1), t with m − 1 degrees of freedom).",
        );
        references.push(LIANG);
    }
    if any(report, |a| a.mixed_logit.is_some()) {
        said.push_str(
            " A logistic regression with a normal random intercept per participant was fitted by maximum likelihood, each participant's integral by \
             adaptive quadrature; its standard deviation was tested by the likelihood ratio, half χ² of 0 and half of 1 degree of freedom.",
        );
        references.extend([PINHEIRO, SELF]);
    }
    text.say(said, &references);
}

fn pairs(text: &mut Text, report: &Report) {
    let found = || report.blocks.iter().filter_map(|block| block.pairs.as_ref());
    let mut said = Vec::new();
    let mut references = Vec::new();
    let tests = || found().filter_map(|pairs| pairs.test.as_ref());
    if tests().next().is_some() {
        let random = tests().find_map(|test| test.p_smallest).map_or(String::new(), |smallest| {
            format!(", or {:.0} random ones where there are too many", 1.0 / smallest - 1.0)
        });
        said.push(format!(
            "Whether a block's pairs differ in their share of target choices was tested by Cochran's Q (where participants left pairs out, by the generalised \
             Mantel–Haenszel statistic) against all ways to deal each participant's choices over the pairs they answered{random}, which holds whatever the choices of \
             one participant have in common."
        ));
        references.extend([COCHRAN, LANDIS]);
    }
    if found().any(|pairs| pairs.model.is_some()) {
        said.push(
            "For participants and pairs other than these, the log odds of a target choice were estimated with crossed normal random intercepts of both, \
             by maximum likelihood with Laplace's approximation; the interval uses t with one degree of freedom less than there are pairs (or participants, \
             where these are fewer)."
                .to_owned(),
        );
        references.push(BATES);
    }
    if !said.is_empty() {
        text.say(said.join(" "), &references);
    }
}

fn psychometric(text: &mut Text, report: &Report) {
    if !report.blocks.iter().any(|b| b.psychometric.as_ref().is_some_and(|p| p.fit.is_some())) {
        return;
    }
    text.say(
        format!(
            "Psychometric functions ψ(x) = γ + (1 − γ − λ) F(x) have a guess rate γ of {GUESS} (two alternatives) and a lapse rate λ with the \
             prior Beta(1, 10) where the study file does not fix it; threshold (halfway between guessing and lapsing) and width (from F = 5% to 95%) are \
             given where the posterior under psignifit 4's priors is highest, with {:.0}% posterior intervals and beta-binomial overdispersion; the \
             threshold also by maximum likelihood with an interval from {REPLICATES} resamples of participants: the estimate ± the distance from it \
             within which as many resamples lie as a normal deviate lies within t × √(n/(n − 1)), t with n − 1 degrees of freedom for n participants. \
             Goodness of fit is the deviance against that of simulated observers, each fitted anew.",
            100.0 * LEVEL
        ),
        &[SCHUETT, WICHMANN, HALL, HESTERBERG],
    );
}

fn scale(text: &mut Text, study: &StudyDefinition, report: &Report) {
    let Some(found) = &report.scale else { return };
    let mut references = vec![THURSTONE, PEREZ, EFRON, FIRTH, KOSMIDIS, HEMERIK];
    let separated = if found.scale.estimator == Estimator::Jeffreys {
        " Choices were separated, so that no finite maximum exists; the likelihood was multiplied by Jeffreys' prior."
    } else {
        ""
    };
    let patterns = match (found.differences.iter().all(|d| d.p_exact), found.flips) {
        (true, _) => "over all patterns of signs".to_owned(),
        (false, flips) => format!("over {flips} random patterns of signs, seed {}", found.seed),
    };
    let mut said = format!(
        "All conditions were placed on one axis by maximum likelihood of Thurstone's Case V: P(a chosen over b) = Φ((q(a) − q(b)) / 1.4826), so that a \
         difference of 1 just-objectionable difference (JOD) is a choice by 75%; positions are relative to their mean.{separated} {} Intervals are \
         the position or difference ± t × its standard error, with {} degrees of freedom, the standard error from leaving out each of the {} \
         participants in turn (jackknife, the scale fitted with Jeffreys' prior). Each difference was tested against none by flipping the signs of \
         participants' effective scores, {patterns}; Holm's method corrects for the {} differences.",
        scaling::pooled(study),
        found.observers - 1,
        found.observers,
        found.differences.len()
    );
    references.push(HOLM);
    if let Some(consistency) = &report.consistency {
        if consistency.triads.triads > 0 {
            said.push_str(" Circular triads were counted per participant.");
            references.push(KENDALL);
        }
        if consistency.observers > 0 {
            said.push_str(
                " Each participant's choices were predicted from the scale of all the others; whoever lies more than 1.5 interquartile ranges below \
                 the first quartile of the mean log likelihoods (where that range is 0, more than 3 standard deviations below expectation) is listed, \
                 not excluded.",
            );
        }
    }
    text.say(said, &references);
}
