/** The page's inputs, from its first moment on: one guard for its texts and all kinds of trials. */
import type { Answer } from "../api.ts";
import { InputGuard, type Press, QuickPresses, type Reason, type Rules } from "./guard.ts";

export type Input = NonNullable<Answer["input"]>;

/** A click or a key's press with where it came from. */
export interface Given {
  press: Press;
  input: Input;
  /** When the hand moved, by `performance.now()`, ms. */
  at: number;
  trusted: boolean;
  detail: number;
}

/** A click that a key makes comes at once with its going down (Enter) or up (space); later ones are a screen reader's, ms. */
const AT_ONCE_MS = 50;

const KEPT = "kelir:counted";

/** An event's own time is when the hand moved; our turn may come later. Nonsense is not trusted. */
function when({ timeStamp }: Event): number {
  const now = performance.now();
  return timeStamp > now - 10_000 && timeStamp <= now ? timeStamp : now;
}

export class Inputs {
  readonly #guard = new InputGuard();
  readonly #keys = new WeakMap<Event, Press>();
  readonly #quick = new QuickPresses();
  /** The last press of a pointer; `count` is what its click's `detail` should be. */
  #pointer: { press: Press; input: Input; count: number } | null = null;
  /** The last press of a key that presses a focused button, and until when a click may be its. */
  #pressing: { press: Press; until: number } | null = null;

  /** Follows all inputs of a window. */
  follow(view: Window): void {
    const on = <K extends keyof WindowEventMap>(type: K, hear: (event: WindowEventMap[K]) => void) => view.addEventListener(type, (event) => event.isTrusted && hear(event), { capture: true });
    on("keydown", (event) => this.#keyDown(event));
    on("keyup", (event) => {
      const at = when(event);
      this.#guard.up(keyOf(event), at);
      if (this.#pressing?.press.id === keyOf(event)) this.#pressing.until = at + AT_ONCE_MS;
      // While ⌘ is held macOS tells of no other key's release.
      if (event.key === "Meta") this.#guard.letGo();
    });
    on("pointerdown", (event) => this.#pointerDown(event));
    on("pointerup", (event) => this.#guard.up(pointerOf(event), when(event)));
    on("pointercancel", (event) => this.#guard.up(pointerOf(event), when(event)));
    on("pointermove", (event) => event.buttons === 0 && this.#guard.up(pointerOf(event), when(event)));
    on("blur", () => this.#guard.letGo());
    this.#restore();
  }

  /** What is known of a key's press. */
  key(event: KeyboardEvent): Given {
    const at = when(event);
    const press = this.#keys.get(event) ?? new InputGuard().down(keyOf(event), at, event.repeat);
    return { press, input: "keyboard", at, trusted: event.isTrusted, detail: 0 };
  }

  /** What is known of a click: which press it ends, and what that was made with. */
  click(event: MouseEvent): Given {
    const at = when(event);
    const given = { at, trusted: event.isTrusted, detail: event.detail };
    const pointer = this.#pointer;
    this.#pointer = null;
    if (event.detail > 0 || pointer !== null) {
      const input = pointer?.input ?? inputOf((event as PointerEvent).pointerType ?? "mouse");
      return { ...given, input, detail: Math.max(event.detail, pointer?.count ?? 0), press: pointer?.press ?? fresh("pointer:unknown", at) };
    }
    // Without a pointer it is a key's on a focused button, or an aid's, which presses nothing.
    const pressing = this.#pressing !== null && at <= this.#pressing.until ? this.#pressing.press : fresh("key:none", at);
    return { ...given, input: "keyboard", press: pressing };
  }

  /** Why what was given does not count; null where it does, and then it is the last that counted. */
  judge(given: Given, rules: Rules, visibleMs: number, simulated = false): Reason | null {
    const reason = this.#guard.verdict({ ...given, trusted: given.trusted || simulated, visibleMs }, rules);
    if (reason === null) {
      this.#guard.count(given.press.id, given.at);
      this.#keep(given.at);
    }
    return reason;
  }

  /** How long from now on a press of this button does not count because of the input before, ms. */
  wait(rules: Rules, button: HTMLElement): number {
    const now = performance.now();
    return Math.max(this.#guard.gapLeft(now, rules), this.#quick.left(now, button.getBoundingClientRect()));
  }

  #pointerDown(event: PointerEvent): void {
    const [at, input] = [when(event), inputOf(event.pointerType)];
    const count = input === "mouse" ? 0 : this.#quick.count(at, event.clientX, event.clientY);
    this.#pointer = { press: this.#guard.down(pointerOf(event), at), input, count };
  }

  #keyDown(event: KeyboardEvent): void {
    if (event.metaKey || MODIFIERS.has(event.key)) return;
    const press = this.#guard.down(keyOf(event), when(event), event.repeat);
    this.#keys.set(event, press);
    if (event.key !== "Enter" && event.key !== " ") return;
    this.#pointer = null;
    // The space bar presses when it is let go: its click is the first press's, not its repeats'.
    const space = event.key === " ";
    if (space && press.repeat && this.#pressing?.press.id === press.id) return;
    this.#pressing = { press, until: space ? Number.POSITIVE_INFINITY : press.at + AT_ONCE_MS };
  }

  /** A reload is no new hand. */
  #keep(at: number): void {
    try {
      sessionStorage.setItem(KEPT, String(Date.now() - (performance.now() - at)));
    } catch {
      // Where nothing can be kept, a reload takes far longer than the gap anyway.
    }
  }

  #restore(): void {
    try {
      const ago = Date.now() - Number(sessionStorage.getItem(KEPT) ?? Number.NaN);
      if (ago >= 0 && ago < 60_000) this.#guard.count("before", performance.now() - ago);
    } catch {
      // as above
    }
  }
}

const MODIFIERS = new Set(["Shift", "Control", "Alt", "AltGraph", "Meta", "CapsLock", "NumLock", "ScrollLock", "Fn"]);

const keyOf = ({ code, key }: KeyboardEvent) => `key:${code || key}`;
const pointerOf = ({ pointerType, pointerId }: PointerEvent) => `${pointerType || "mouse"}:${pointerId}`;
const fresh = (id: string, at: number): Press => ({ id, at, repeat: false, quietMs: Number.POSITIVE_INFINITY, held: false });

/** A pen is a pen; what no browser has a word for is taken as a mouse. */
const inputOf = (type: string): Input => (type === "touch" || type === "pen" ? type : "mouse");

/** The page's own. */
export const inputs = new Inputs();
if (typeof window !== "undefined") inputs.follow(window);
