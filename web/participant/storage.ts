/** Small things that must survive a reload, in localStorage where the browser lets us, else in memory. */

export interface Store {
  /** Whether what is written outlives the page. */
  readonly durable: boolean;
  read<T>(key: string): T | null;
  write(key: string, value: unknown): void;
  remove(key: string): void;
  /** Every key that begins so. */
  keys(prefix: string): string[];
}

/**
 * Wraps a `Storage`; a browser that refuses (private windows, full disks) falls back to memory, and says so in `durable`. What the page has
 * written or removed counts for it whatever the disk says later: somebody may have emptied it.
 */
export function openStore(storage: () => Storage): Store {
  /** What this page has written; null: removed. */
  const own = new Map<string, string | null>();
  /** Of that, what is not on the disk. */
  const unkept = new Set<string>();
  let disk: Storage | null = null;
  try {
    disk = storage();
    disk.setItem("kelir:probe", "1");
    disk.removeItem("kelir:probe");
  } catch {
    disk = null;
  }
  return {
    get durable() {
      return disk !== null && unkept.size === 0;
    },
    read<T>(key: string): T | null {
      try {
        const text = own.get(key) ?? (own.has(key) ? null : (disk?.getItem(key) ?? null));
        return text === null ? null : (JSON.parse(text) as T);
      } catch {
        return null;
      }
    },
    write(key, value) {
      const text = JSON.stringify(value);
      own.set(key, text);
      try {
        if (disk === null) throw new Error("no storage");
        disk.setItem(key, text);
        if (disk.getItem(key) !== text) throw new Error("what was stored is not there"); // some private windows take all and keep nothing
        unkept.delete(key);
      } catch {
        unkept.add(key);
      }
    },
    remove(key) {
      own.set(key, null);
      unkept.delete(key);
      try {
        disk?.removeItem(key);
      } catch {
        // nothing to remove from
      }
    },
    keys(prefix) {
      let kept: string[] = [];
      try {
        if (disk !== null) kept = Array.from({ length: disk.length }, (_, i) => disk?.key(i) ?? "");
      } catch {
        // a browser that lets nothing be listed
      }
      return [...new Set([...kept, ...own.keys()])].filter((key) => key.startsWith(prefix) && own.get(key) !== null);
    },
  };
}

/**
 * The key of a participant's session: the study and the link they came by, so that a reload resumes and a panel's
 * next participant on the same machine (other parameters in the link) starts anew.
 */
export function sessionKey(study: string, params: Record<string, string>): string {
  const query = new URLSearchParams(Object.entries(params).sort(([a], [b]) => (a < b ? -1 : 1))).toString();
  return `kelir:session:${study}${query === "" ? "" : `?${query}`}`;
}
