// The researcher's routes of the mock server: the source paper's counts, and a study that nobody has taken yet.
const block = (id, title, kind, conditions, counts, test) => ({
  ...{ id, title, kind, conditions, target: "pa", items: counts.length - 1 },
  n: counts.reduce((a, b) => a + b, 0),
  incomplete: 0,
  counts: Object.fromEntries(counts.map((n, k) => [k, n])),
  mu: (counts.length - 1) / 2,
  ...test,
});

const paper = [
  block("stills", "Stills", "still", ["pa", "mc"], [12, 14, 6], { mean: 0.8125, sd: 0.7378042607879107, t: -1.4375905768565218, df: 31, p: 0.16056941534857747 }),
  block("photographs", "Photographs", "still", ["pa", "simulated-photo"], [3, 10, 19], { mean: 1.5, sd: 0.6720215050860562, t: 4.208834246356, df: 31, p: 0.000203782 }),
  block("animation", "Animation", "animation", ["pa", "mc"], [26, 7], { mean: 0.21212121212121213, sd: 0.41514875026728, t: -3.98348229826, df: 32, p: 0.000366864 }),
];
const none = { mean: null, sd: null, t: null, df: null, p: null, note: "No participant has answered every pair yet." };
const empty = [block("stills", "Stills", "still", ["pa", "mc"], [0, 0, 0], none), block("animation", "Animation", "animation", ["pa", "mc"], [0, 0], none)];

const around = (x, half) => ({ low: x - half, high: x + half, level: 0.95 });
const share = (chosen, trials, half, by_participant = null) => ({ chosen, trials, proportion: chosen / trials, wilson: around(chosen / trials, half), by_participant });
const logit = (estimate, se, p) => ({ coefficients: [{ estimate, standard_error: se, statistic: estimate / se, p, ...around(estimate, 1.96 * se) }] });
const analysis = (g, points, sd, bf01, proportion, icc, odds, notes) => ({
  effect: { d: g * 1.025, d_interval: around(g * 1.025, 0.35), g, g_interval: around(g, 0.344) },
  equivalence: [
    { bounds: { points: 0.5 }, p: points, interval_90: around(0, 0.2) },
    { bounds: { sd: 0.5 }, p: sd, interval_90: around(0, 0.2) },
  ],
  bayes: { bf01, bf10: 1 / bf01 },
  power: [0.2, 0.5, 0.8].map((d, i) => ({ n: 32, d, alpha: 0.05, power: [0.195, 0.785, 0.993][i] })),
  proportion,
  intraclass: icc === null ? null : { icc, design_effect: 1 + icc },
  robust_logit: logit(odds, 0.26, 0.16),
  mixed_logit: icc === null ? null : { ...logit(odds * 1.1, 0.29, 0.17), sigma: 0.6 },
  notes,
});
const unlike = "64 choices of 32 participants are not independent trials: intraclass correlation 0.093, worth about 58.6 independent ones.";

/** The paper's blocks judged in full, as the server's report has them. */
const judged = [
  {
    ...paper[0],
    p_holm: 0.16056941534857747,
    analysis: analysis(-0.248, 0.0114, 0.087, 2.1, share(26, 64, 0.118, around(0.406, 0.125)), 0.093, -0.379, ["A difference that is not significant is not shown to be absent: see the tests of equivalence and the Bayes factor.", unlike]),
    by_item: [{ id: "stills-1", target: share(12, 32, 0.16) }, { id: "stills-2", target: share(14, 32, 0.165) }],
    left: share(33, 64, 0.12),
    rt_ms: { n: 64, q1: 2310, median: 3420.5, q3: 5204 },
  },
  {
    ...paper[1],
    p_holm: 0.000611346,
    analysis: analysis(0.726, 0.5, 0.89, 0.0071, share(48, 64, 0.105, around(0.75, 0.117)), 0.167, 1.0986, [unlike]),
    by_item: [{ id: "photographs-1", target: share(23, 32, 0.15) }, { id: "photographs-2", target: share(25, 32, 0.14) }],
    left: share(30, 64, 0.12),
    rt_ms: { n: 64, q1: 1900, median: 2754, q3: 4410 },
  },
  {
    ...paper[2],
    p_holm: 0.000733728,
    analysis: analysis(-0.677, 0.001, 0.84, 0.0126, share(7, 33, 0.14), null, -1.312, []),
    by_item: [{ id: "animation-1", target: share(7, 33, 0.14) }],
    left: share(17, 33, 0.165),
    rt_ms: { n: 33, q1: 4100, median: 5980, q3: 8800 },
  },
];
const scale = {
  level: 0.95,
  replicates: 2000,
  observers: 33,
  conditions: [
    { condition: "simulated-photo", jod: -0.62, low: -0.98, high: -0.31 },
    { condition: "pa", jod: 0.18, low: 0.02, high: 0.36 },
    { condition: "mc", jod: 0.44, low: 0.2, high: 0.71 },
  ],
};

export function results(path, sessions, stuff) {
  const studies = [
    { id: "shadow-puppets", title: "Shadows on a screen", status: "ready", detail: null, participants: { started: 36, in_progress: 2, completed: 32 } },
    { id: "empty", title: "A study that nobody has taken", status: "preparing", detail: { done: 3, total: 10, stimulus: "still-arjuna (mc)" }, participants: { started: 0, in_progress: 0, completed: 0 } },
  ];
  if (path === "/api/v1/admin/studies") return [200, { studies }];
  if (path === "/api/v1/admin/papers/taylor-cameron") {
    const titles = ["PA against MC, two pairs of still images", "PA against photographs, two pairs of still images", "PA against MC, one pair of animations"];
    const comparisons = judged.map((b, i) => ({
      ...{ id: ["still-mc", "still-photo", "animation-mc"][i], title: titles[i], printed: { mean: b.mean, sd: b.sd, t: [-1.438, 4.209, -3.293][i] } },
      ...{ counts: Object.entries(b.counts).map(([k, n]) => [Number(k), n]), test: b, t_as_printed: i < 2, p_holm: b.p_holm, effect: b.analysis.effect },
      ...{ equivalence_points: b.analysis.equivalence[0], equivalence_sd: b.analysis.equivalence[1], bayes: b.analysis.bayes },
    }));
    return [200, { comparisons, printed_t: { printed: -3.293, participants: [25, 40], splits_with_this_t: [] } }];
  }
  const [, id, rest] = path.match(/^\/api\/v1\/admin\/studies\/([^/]+)\/(.+)$/) ?? [];
  const study = studies.find((s) => s.id === id);
  if (study === undefined) return null;
  const errors = (rmse) => ({ count: 197136, bias: rmse / 40, rmse, p999: 5 * rmse, max: 9 * rmse });
  const provenance = (condition, i) => ({
    scene_sha256: "6a1f0c".padEnd(64, "3"),
    ...(condition === "pa" ? { technique: "pa", table: "u32" } : { technique: "mc", spp: 1024, seed: 7 }),
    ...{ version: "0.1.0", backend: "cpu", adapter: "2 threads", white: 812.25, size: [592, 333], pixel: "area", output: "still", camera: null },
    error: { reference: { technique: "mc", spp: 65536, seed: 1 }, frames: [0], all: errors(2e-4 * (1 + i)), penumbra: errors(condition === "pa" ? 9.2e-5 * (1 + 0.4 * i) : 1.3e-3 * (1 + 0.3 * i)), floor: 7.9e-5 },
    counts: { pixels: 197136, pixels_penumbra: 30512 },
  });
  const stimuli = stuff.trials.flatMap((t, i) => [
    { pair: `${t.block_id}-${t.pair_index + 1}`, condition: "pa", sha256: t.left.sha256, provenance: provenance("pa", i) },
    { pair: `${t.block_id}-${t.pair_index + 1}`, condition: t.block_id === "photographs" ? "simulated-photo" : "mc", sha256: t.right.sha256, provenance: provenance("mc", i) },
  ]);
  if (rest === "results") {
    return [200, { study: id, title: study.title, config_hash: "c0ffee".padEnd(64, "9"), participants: study.participants, blocks: id === "empty" ? empty : paper, stimuli: id === "empty" ? [] : stimuli }];
  }
  if (rest === "report") {
    const about = { kelir_version: "0.1.0", methods: ["Participants saw 5 pairs of stimuli in 3 blocks and had to choose one of each pair.", "Effect sizes are Cohen's d and Hedges' g with 95% intervals from the noncentral t distribution."], chain: { rows: 161, head: "ab12".padEnd(64, "7"), broken: null } };
    const answers = id === "empty" ? { blocks: empty.map((b) => ({ ...b, p_holm: null, analysis: { ...analysis(0, 1, 1, 1, null, null, 0, ["No answers."]), effect: null, bayes: null }, by_item: [], left: null, rt_ms: null })), scale: null, scale_note: "No scale: no choices." } : { blocks: judged, scale, scale_note: null };
    const excluded = id === "empty" ? [] : [{ session_id: "01936d2e-5b1a-7c3e-9a53-0d4b1f2a6c11", reasons: [{ reason: "too_fast", trials: 4, allowed: 1 }, { reason: "straight_lining", trials: 5 }] }];
    return [200, { study: id, title: study.title, ...about, ...answers, excluded, blocks_with_excluded: id === "empty" ? null : judged, stimuli: id === "empty" ? [] : stimuli }];
  }
  return null;
}
