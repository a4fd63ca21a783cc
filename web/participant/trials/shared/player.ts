/** Plays an animation's frames on a canvas, and logs how. */
import { AnimationClock, type FrameLog } from "../../clock.ts";
import type { Film } from "../../packed.ts";
import type { Picture } from "../../stimuli.ts";

/** Refresh assumed where it could not be measured, ms. */
export const FALLBACK_PERIOD_MS = 1000 / 60;

export class Player {
  readonly #film: Film;
  readonly #clock: AnimationClock;
  readonly #context: CanvasRenderingContext2D;
  #drawn = -1;

  constructor({ head: { fps, loop, frames }, film }: Extract<Picture, { kind: "animation" }>, context: CanvasRenderingContext2D, periodMs: number) {
    this.#film = film;
    this.#context = context;
    this.#clock = new AnimationClock({ fps, loop, frames: frames.length, periodMs });
  }

  /** Draws the frame of the moment `now`, if it is here and isn't on the screen already; the first call draws frame 0. */
  draw(now: number): void {
    const frame = this.#clock.tick(now, (frame) => this.#film.frame(frame) !== undefined);
    const bitmap = this.#film.frame(frame);
    if (frame === this.#drawn || bitmap === undefined) return;
    const { width, height } = this.#context.canvas;
    this.#context.drawImage(bitmap, 0, 0, width, height);
    this.#drawn = frame;
  }

  log(): FrameLog {
    return this.#clock.log();
  }
}

/** What is stored of the animations that were played, by role: how, and whether the trial missed frames; nothing where there were none. */
export function played<Role extends string>(players: ReadonlyArray<readonly [Role, Player]>): { missed_frames?: number; frames?: Partial<Record<Role, FrameLog>> } {
  if (players.length === 0) return {};
  const logs = players.map(([role, player]) => [role, player.log()] as const);
  return { missed_frames: logs.reduce((sum, [, log]) => sum + log.missed_frames, 0), frames: Object.fromEntries(logs) as Partial<Record<Role, FrameLog>> };
}
