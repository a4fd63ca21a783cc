// The researcher's routes of the mock server: the source paper's counts, and a study that nobody has taken yet.
const block = (id, title, kind, conditions, counts, test) => ({
  ...{ id, title, kind, conditions, target: "pa", pairs: counts.length - 1 },
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

export function results(path, sessions, stuff) {
  const studies = [
    { id: "shadow-puppets", title: "Shadows on a screen", status: "ready", detail: null, participants: { started: 36, in_progress: 2, completed: 32 } },
    { id: "empty", title: "A study that nobody has taken", status: "preparing", detail: { done: 3, total: 10, stimulus: "still-arjuna (mc)" }, participants: { started: 0, in_progress: 0, completed: 0 } },
  ];
  if (path === "/api/v1/admin/studies") return [200, { studies }];
  const [, id, rest] = path.match(/^\/api\/v1\/admin\/studies\/([^/]+)\/(.+)$/) ?? [];
  const study = studies.find((s) => s.id === id);
  if (study === undefined) return null;
  const errors = (rmse) => ({ count: 197136, bias: rmse / 40, rmse, p999: 5 * rmse, max: 9 * rmse });
  const provenance = (condition) => ({
    scene_sha256: "6a1f0c".padEnd(64, "3"),
    ...(condition === "pa" ? { technique: "pa", table: "u32" } : { technique: "mc", spp: 1024, seed: 7 }),
    ...{ version: "0.1.0", backend: "cpu", adapter: "2 threads", white: 812.25, size: [592, 333], pixel: "area", output: "still", camera: null },
    error: { reference: { technique: "mc", spp: 65536, seed: 1 }, frames: [0], all: errors(condition === "pa" ? 2.4e-4 : 1.9e-4), penumbra: errors(condition === "pa" ? 8.217e-4 : 6.3e-4), floor: 7.9e-5 },
    counts: { pixels: 197136, pixels_penumbra: 30512 },
  });
  const stimuli = stuff.trials.flatMap((t) => [
    { pair: `${t.block_id}-${t.pair_index + 1}`, condition: "pa", sha256: t.left.sha256, provenance: provenance("pa") },
    { pair: `${t.block_id}-${t.pair_index + 1}`, condition: t.block_id === "photographs" ? "simulated-photo" : "mc", sha256: t.right.sha256, provenance: provenance("mc") },
  ]);
  if (rest === "results") {
    return [200, { study: id, title: study.title, config_hash: "c0ffee".padEnd(64, "9"), participants: study.participants, blocks: id === "empty" ? empty : paper, stimuli: id === "empty" ? [] : stimuli }];
  }
  return null;
}
