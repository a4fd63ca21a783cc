// The source paper's counts with every number that a report has of them, as the server's types want them. Numbers that no test reads are made up.
import type { components } from "../api/schema.ts";

type Schemas = components["schemas"];
type Test = Pick<Schemas["BlockSummary"], "mean" | "sd" | "t" | "df" | "p" | "note">;

const block = (id: string, title: string, kind: Schemas["Kind"], other: string, counts: number[], test: Test): Schemas["BlockSummary"] => ({
  ...{ id, title, kind, trial: "two-alternative", layout: "side by side", conditions: ["pa", other], target: "pa", items: counts.length - 1 },
  n: counts.reduce((a, b) => a + b, 0),
  incomplete: 0,
  counts: Object.fromEntries(counts.map((n, k) => [k, n])),
  mu: (counts.length - 1) / 2,
  ...test,
});

const stills = { mean: 0.8125, sd: 0.7378042607879107, t: -1.4375905768565218, df: 31, p: 0.16056941534857747 };
const photographs = { mean: 1.5, sd: 0.6720215050860562, t: 4.208834246356, df: 31, p: 0.000203782 };
const animation = { mean: 0.21212121212121213, sd: 0.41514875026728, t: -3.98348229826, df: 32, p: 0.000366864 };
const summaries = [
  block("stills", "Stills", "still", "mc", [12, 14, 6], stills),
  block("photographs", "Photographs", "still", "simulated-photo", [3, 10, 19], photographs),
  block("animation", "Animation", "animation", "mc", [26, 7], animation),
] as const;

const none: Test = { mean: null, sd: null, t: null, df: null, p: null, note: "of the participants who are judged, none answered all pairs" };
const unanswered = [block("stills", "Stills", "still", "mc", [0, 0, 0], none), block("animation", "Animation", "animation", "mc", [0, 0], none)];

const around = (x: number, half: number): Schemas["Interval"] => ({ low: x - half, high: x + half, level: 0.95 });
const resampled = (x: number, half: number): Schemas["Bootstrap"] => ({
  ...around(x, half),
  estimate: x,
  standard_error: half / 1.96,
  replicates: 2000,
  undefined: 0,
  seed: 1,
  method: "bias-corrected",
});
const share = (chosen: number, trials: number, half: number, by_participant: Schemas["Bootstrap"] | null = null): Schemas["Proportion"] => ({
  ...{ chosen, trials, proportion: chosen / trials, wilson: around(chosen / trials, half), by_participant },
});
const odds = (estimate: number, se: number, p: number): Schemas["Coefficient"] => ({
  estimate,
  standard_error: se,
  statistic: estimate / se,
  p,
  low: estimate - 1.96 * se,
  high: estimate + 1.96 * se,
});
const size = (g: number): Schemas["EffectSize"] => ({ d: g * 1.025, d_interval: around(g * 1.025, 0.35), g, g_interval: around(g, 0.344) });
const equivalent = (bounds: Schemas["Bounds"], p: number): Schemas["Equivalence"] => ({ bounds, p, p_lower: p / 2, p_upper: p, t_lower: 2, t_upper: -2, half_width: 0.5, interval_90: around(0, 0.2) });
const bayes = (bf01: number): Schemas["JzsBayesFactor"] => ({ bf01, bf10: 1 / bf01, ln_bf10: -Math.log(bf01), prior_scale: Math.SQRT1_2 });
const plan = (d: number, power: number): Schemas["TPlan"] => ({ n: 32, d, alpha: 0.05, power });
const sample = ({ n, mean, sd, mu, t, df, p }: Schemas["BlockSummary"]): Schemas["OneSampleTTest"] => ({ n, mu, mean: mean ?? 0, sd: sd ?? 0, t: t ?? 0, df: df ?? 0, p: p ?? 1 });

interface Judged {
  g: number;
  points: number;
  sd: number;
  bf01: number;
  proportion: Schemas["Proportion"];
  icc: number | null;
  odds: number;
  notes: string[];
}

function analysis(summary: Schemas["BlockSummary"], judged: Judged | null): Schemas["ChoiceAnalysis"] {
  const t_test = sample(summary);
  if (judged === null) return { t_test, effect: null, equivalence: [], bayes: null, power: [], proportion: null, intraclass: null, robust_logit: null, mixed_logit: null, notes: ["No answers."] };
  const { g, icc, proportion } = judged;
  const who = { participants: summary.n, trials: proportion.trials };
  return {
    t_test,
    effect: size(g),
    equivalence: [equivalent({ points: 0.5 }, judged.points), equivalent({ sd: 0.5 }, judged.sd)],
    bayes: bayes(judged.bf01),
    power: [plan(0.2, 0.195), plan(0.5, 0.785), plan(0.8, 0.993)],
    detectable: plan(0.51, 0.8),
    proportion,
    intraclass: icc === null ? null : { ...who, icc, design_effect: 1 + icc, proportion: proportion.proportion, estimator: "fleiss-cuzick" },
    robust_logit: { ...who, coefficients: [odds(judged.odds, 0.26, 0.16)], correction: "CR1", df: summary.n - 1, log_likelihood: -40, naive_standard_errors: [0.25] },
    mixed_logit:
      icc === null
        ? null
        : {
            ...who,
            coefficients: [odds(judged.odds * 1.1, 0.29, 0.17)],
            sigma: 0.6,
            sigma_p: 0.2,
            latent_icc: 0.1,
            boundary: false,
            saturated: false,
            log_likelihood: -40,
            log_likelihood_independent: -41,
          },
    notes: judged.notes,
  };
}

const times = (n: number, q1: number, median: number, q3: number) => ({ rt_ms: { n, q1, median, q3 }, rt_percentiles_ms: [] });
const unlike = "64 choices of 32 participants are not independent trials: intraclass correlation 0.093, worth about 58.6 independent ones.";
const absent = "A difference that is not significant is not shown to be absent: see the tests of equivalence and the Bayes factor.";
const first = (share: Schemas["Proportion"] | null) => ({ first: share, first_role: "left" as const });

/** The paper's blocks, judged in full. */
export const judged: Schemas["BlockReport"][] = [
  {
    ...summaries[0],
    p_holm: 0.16056941534857747,
    analysis: analysis(summaries[0], { g: -0.248, points: 0.0114, sd: 0.087, bf01: 2.1, proportion: share(26, 64, 0.118, resampled(0.406, 0.125)), icc: 0.093, odds: -0.379, notes: [absent, unlike] }),
    by_item: [
      { id: "stills-1", target: share(12, 32, 0.16) },
      { id: "stills-2", target: share(14, 32, 0.165) },
    ],
    ...first(share(33, 64, 0.12)),
    ...times(64, 2310, 3420.5, 5204),
  },
  {
    ...summaries[1],
    p_holm: 0.000611346,
    analysis: analysis(summaries[1], { g: 0.726, points: 0.5, sd: 0.89, bf01: 0.0071, proportion: share(48, 64, 0.105, resampled(0.75, 0.117)), icc: 0.167, odds: 1.0986, notes: [unlike] }),
    by_item: [
      { id: "photographs-1", target: share(23, 32, 0.15) },
      { id: "photographs-2", target: share(25, 32, 0.14) },
    ],
    ...first(share(30, 64, 0.12)),
    ...times(64, 1900, 2754, 4410),
  },
  {
    ...summaries[2],
    p_holm: 0.000733728,
    analysis: analysis(summaries[2], { g: -0.677, points: 0.001, sd: 0.84, bf01: 0.0126, proportion: share(7, 33, 0.14), icc: null, odds: -1.312, notes: [] }),
    by_item: [{ id: "animation-1", target: share(7, 33, 0.14) }],
    ...first(share(17, 33, 0.165)),
    ...times(33, 4100, 5980, 8800),
  },
];

/** The same two blocks before anybody came. */
export const unjudged: Schemas["BlockReport"][] = unanswered.map((summary) => ({
  ...summary,
  p_holm: null,
  analysis: analysis(summary, null),
  by_item: [],
  ...first(null),
  rt_ms: null,
  rt_percentiles_ms: [],
}));

const jod = [-0.62, 0.18, 0.44];
const named = ["simulated-photo", "pa", "mc"];
export const scale: Schemas["ScaleIntervals"] = {
  scale: {
    ...{ conditions: named, jod, standard_errors: [0.17, 0.09, 0.13], covariance: [], model: "thurstone", estimator: "maximum-likelihood", origin: "mean" },
    ...{ log_likelihood: -100, deviance: 1, deviance_df: 1, deviance_p: 0.3, choices: 161 },
  },
  conditions: [
    { condition: "simulated-photo", jod: -0.62, standard_error: 0.17, low: -0.98, high: -0.31 },
    { condition: "pa", jod: 0.18, standard_error: 0.09, low: 0.02, high: 0.36 },
    { condition: "mc", jod: 0.44, standard_error: 0.13, low: 0.2, high: 0.71 },
  ],
  ...{ differences: [], level: 0.95, replicates: 2000, undefined: 0, penalised: 0, observers: 33, seed: 1 },
};

/** The paper's own comparisons, computed again. */
export function paper(): Schemas["Replication"] {
  const titles = ["PA against MC, two pairs of still images", "PA against photographs, two pairs of still images", "PA against MC, one pair of animations"];
  const comparisons = judged.map((b, i): Schemas["Comparison"] => ({
    ...{ id: ["still-mc", "still-photo", "animation-mc"][i] ?? "", title: titles[i] ?? "", printed: { mean: b.mean ?? 0, sd: b.sd ?? 0, t: [-1.438, 4.209, -3.293][i] ?? 0 } },
    ...{
      counts: Object.entries(b.counts).map(([k, n]): [number, number] => [Number(k), n]),
      reconstructions: 1,
      test: sample(b),
      t_as_printed: i < 2,
      p_holm: b.p_holm ?? 1,
      effect: size(b.analysis.effect?.g ?? 0),
    },
    equivalence_points: equivalent({ points: 0.5 }, b.analysis.equivalence[0]?.p ?? 1),
    equivalence_sd: equivalent({ sd: 0.5 }, b.analysis.equivalence[1]?.p ?? 1),
    bayes: bayes(b.analysis.bayes?.bf01 ?? 1),
    sign: { n: 18, successes: 6, proportion: 1 / 3, p: 0.24, p_less: 0.12, p_greater: 0.95, p0: 0.5 },
    wilcoxon: { n: 18, v: 57, p: 0.24, method: "exact" },
    ...{ power: b.analysis.power, detectable: plan(0.51, 0.8) },
  }));
  const closest = { n: 33, chosen: 8, t: -3.3 };
  return { comparisons, printed_t: { printed: -3.293, participants: [25, 40], splits_with_this_t: [], participants_with_this_t: [], splits_with_this_summary: [], closest } };
}
