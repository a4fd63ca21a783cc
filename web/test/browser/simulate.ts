/** Runs jsPsych's simulation of two trials of a kind; bundled into a page by the test. */
import { initJsPsych } from "jspsych";
import type { Study, Trial } from "../../participant/api.ts";
import { measureRefresh } from "../../participant/display.ts";
import type { Pictures } from "../../participant/stimuli.ts";
import { loadKind } from "../../participant/trials/kinds.ts";

export async function simulate(name: string, mode: "data-only" | "visual"): Promise<{ data: unknown[]; told: unknown[] }> {
  const jsPsych = initJsPsych({ display_element: document.querySelector("main") as HTMLElement });
  const kind = await loadKind(name);
  const told: unknown[] = [];
  const picture = async () => {
    const canvas = Object.assign(document.createElement("canvas"), { width: 64, height: 36 });
    canvas.getContext("2d")?.fillRect(8, 8, 20, 20);
    const image = Object.assign(new Image(), { src: canvas.toDataURL() });
    await image.decode();
    return { kind: "still" as const, sha256: "00", pixels: [64, 36] as const, image };
  };
  const load = async (): Promise<Pictures> => Object.fromEntries(await Promise.all(kind.roles.map(async (role) => [role, await picture()] as const)));
  const shown = Object.fromEntries(kind.roles.map((role) => [role, { sha256: "00", url: "" }]));
  const settings = { fixation_ms: 50, first_ms: 50, mask_ms: 50, second_ms: 50 };
  const trial = { trial_index: 0, width: 64, height: 36, shown, settings } as unknown as Trial;
  const parameters = kind.parameters({
    ...{
      study: { question: "Which?", surround: 0.2, display: { sizes: [[64, 36]], fit: "native" } } as unknown as Study,
      trial,
      position: "1 of 2",
      load,
      sound: async () => true,
      refreshPeriod: measureRefresh,
    },
    onOnset: () => {},
    onChoice: (data) => told.push(data.choice),
  });
  const node = { ...parameters, type: kind.plugin };
  await jsPsych.simulate([node, node], mode);
  return { data: jsPsych.data.get().values(), told };
}
