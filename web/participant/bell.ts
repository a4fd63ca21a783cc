/** Wakes those who wait for something to change. */
export class Bell {
  #waiting: Array<() => void> = [];

  ring(): void {
    for (const wake of this.#waiting.splice(0)) wake();
  }

  /** What `look` gives, once it is not null; it looks now and whenever the bell rings, and rejects with what it throws. */
  async found<T>(look: () => T | null): Promise<T> {
    for (;;) {
      const seen = look();
      if (seen !== null) return seen;
      await new Promise<void>((wake) => this.#waiting.push(wake));
    }
  }
}
