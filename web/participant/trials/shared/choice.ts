/** The first answer, by mouse, touch, pen or key, with the time of the hand's own movement. */
import type { Answer } from "../../api.ts";

type Input = NonNullable<Answer["input"]>;

export interface Choice<Role extends string> {
  role: Role;
  input: Input;
  /** `performance.now()` of the press, ms. */
  at: number;
}

/** Takes the first press of a button or a key from now on; nothing that came before counts. It listens until `signal` aborts. */
export function firstChoice<Role extends string>(options: {
  root: HTMLElement;
  buttons: Record<Role, HTMLButtonElement>;
  /** `KeyboardEvent.key` → answer. */
  keys: Record<string, Role>;
  signal: AbortSignal;
}): Promise<Choice<Role>> {
  const { root, buttons, keys, signal } = options;
  const since = performance.now();
  // An event's own time is when the hand moved; our turn may come later. Nonsense from synthetic events is not trusted.
  const when = (event: Event) => (event.timeStamp >= since && event.timeStamp <= performance.now() ? event.timeStamp : performance.now());
  return new Promise((resolve) => {
    for (const [role, button] of Object.entries<HTMLButtonElement>(buttons) as Array<[Role, HTMLButtonElement]>) {
      let pointer: string | null = null;
      button.addEventListener("pointerdown", (event) => (pointer = event.pointerType), { signal });
      button.addEventListener("click", (event) => resolve({ role, input: inputOf(event, pointer), at: when(event) }), { signal });
    }
    document.addEventListener(
      "keydown",
      (event) => {
        if (event.repeat || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey || !root.isConnected) return;
        const role = Object.hasOwn(keys, event.key) ? keys[event.key] : undefined;
        if (role === undefined) return;
        event.preventDefault();
        resolve({ role, input: "keyboard", at: when(event) });
      },
      { signal },
    );
  });
}

/** What a click was made with; a click without a pointer is a key's on a focused button. */
function inputOf(click: MouseEvent, pointer: string | null): Input {
  if (click.detail === 0 && pointer === null) return "keyboard";
  const type = (click as PointerEvent).pointerType || pointer || "mouse";
  return type === "mouse" || type === "pen" ? type : "touch";
}
