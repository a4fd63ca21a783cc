/** How one trial is taken, whatever its kind: the first answer that counts, and all that is said of how it came about. */
import type { Schemas } from "../../api.ts";
import { rounded } from "../../clock.ts";
import type { Rules } from "../../inputs/guard.ts";
import { offer, offered } from "../../inputs/offered.ts";
import { type Given, inputs } from "../../inputs/watch.ts";
import type { Pixels } from "../../layout.ts";
import { frameAt } from "../../steady.ts";
import { eventLog } from "./events.ts";
import { hiddenTime } from "./hidden.ts";

export type Geometry = Schemas["Geometry"];
/** What can be chosen: the role of a stimulus. */
type Chosen = Schemas["Role"];

export interface Choice<Role extends Chosen> {
  role: Role;
  input: Given["input"];
  /** `performance.now()` of the hand's own movement, ms. */
  at: number;
}

export interface Options<Role extends Chosen> {
  root: HTMLElement;
  buttons: Record<Role, HTMLButtonElement>;
  /** `KeyboardEvent.key` → answer, as it is now. */
  keys(): Record<string, Role>;
  /** How the stimuli stand now. */
  geometry(): Geometry;
  /** The size at which they are shown, in their own pixels. */
  pixels: Pixels;
  rules: Rules;
  /** jsPsych's simulation presses buttons by script, which nobody else may. */
  simulated: boolean;
}

export class Taking<Role extends Chosen> {
  readonly #options: Options<Role>;
  readonly #log = eventLog();
  readonly #listening = new AbortController();
  /** Until there is a choice. */
  readonly #offering = new AbortController();
  readonly #buttons: readonly HTMLButtonElement[];
  #onset = Number.POSITIVE_INFINITY;
  #hiddenMs = () => 0;
  #atOnset: Geometry | null = null;
  /** As far as the log knows. */
  #last = "";
  #choice: Choice<Role> | null = null;
  #chosen: (choice: Choice<Role>) => void = () => {};

  constructor(options: Options<Role>) {
    this.#options = options;
    this.#buttons = Object.values(options.buttons);
    const { signal } = this.#listening;
    offer(this.#buttons, false);
    for (const [role, button] of Object.entries<HTMLButtonElement>(options.buttons) as Array<[Role, HTMLButtonElement]>) {
      button.addEventListener("click", (event) => this.#attempt(role, inputs.click(event)), { signal });
    }
    document.addEventListener("keydown", (event) => this.#key(event), { signal });
    // A pinch changes what is seen without moving anything.
    globalThis.visualViewport?.addEventListener("resize", () => this.resized(), { signal });
  }

  /** From `onset` on, a frame's time, the stimuli can be answered. */
  open(onset: number): void {
    this.#onset = onset;
    frameAt(onset);
    this.#hiddenMs = hiddenTime(this.#listening.signal);
    this.#atOnset = this.#options.geometry();
    this.#last = JSON.stringify(this.#atOnset);
    offered(this.#buttons, (button) => this.#wait(button), this.#offering.signal);
  }

  /** The stimuli may stand otherwise than before. */
  resized(): void {
    const geometry = this.#options.geometry();
    const now = JSON.stringify(geometry);
    if (now !== this.#last) this.#log.add({ event: "resize", ...geometry });
    this.#last = now;
  }

  /** The first answer that counts. */
  choice(): Promise<Choice<Role>> {
    return new Promise((resolve) => {
      this.#chosen = resolve;
      if (this.#choice !== null) resolve(this.#choice);
    });
  }

  /** What is stored of how the answer came about, but for what its kind says itself. */
  told({ input, at }: Choice<Role>, periodMs: number | null) {
    const now = this.#options.geometry();
    const changed = this.#atOnset !== null && JSON.stringify(now) !== JSON.stringify(this.#atOnset);
    return {
      rt: rounded(at - this.#onset),
      onset: rounded(this.#onset),
      input,
      stimulus_size: [...this.#options.pixels],
      ...now,
      refresh_hz: periodMs === null ? null : rounded(1000 / periodMs),
      hidden_ms: rounded(this.#hiddenMs()),
      geometry_changed: changed ? 1 : 0,
      ...(changed && { at_onset: this.#atOnset as Geometry }),
      ...this.#log.carry(this.#onset),
    };
  }

  /** Listens no more. What is pressed until then is logged for the next answer. */
  close(): void {
    this.#listening.abort();
    this.#offering.abort();
  }

  #key(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey || event.shiftKey || !this.#options.root.isConnected) return;
    const keys = this.#options.keys();
    const role = Object.hasOwn(keys, event.key) ? keys[event.key] : undefined;
    if (role === undefined) return;
    event.preventDefault();
    this.#attempt(role, inputs.key(event));
  }

  #attempt(role: Role, given: Given): void {
    const { rules, simulated } = this.#options;
    const visibleMs = given.press.at - this.#onset - this.#hiddenMs();
    const reason = this.#choice === null ? inputs.judge(given, rules, visibleMs, simulated) : "answered";
    if (reason !== null) {
      this.#log.add({ event: "ignored", reason, input: given.input, choice: role }, given.at);
      return;
    }
    this.#choice = { role, input: given.input, at: given.at };
    this.#offering.abort();
    offer(this.#buttons, false);
    this.#chosen(this.#choice);
  }

  /** How long a press of a button that began now would not count yet, ms. */
  #wait(button: HTMLButtonElement): number {
    const { rules } = this.#options;
    const visibleMs = performance.now() - this.#onset - this.#hiddenMs();
    return Math.max(rules.min_visible_ms - visibleMs, inputs.wait(rules, button));
  }
}
