/** Where the names of a plot's points go: beside their point, or as near as they hide no mark, interval or other name. */

export interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

/** A point to be named, and how wide its name is. */
export interface Named {
  x: number;
  y: number;
  width: number;
}

/** A name's place: the middle of its height, and the end that is at its point. */
export interface Label {
  box: Box;
  anchor: "start" | "end";
  /** Whether it stands away from its point, so that a line has to lead there. */
  led: boolean;
}

/** Between a point and its name, px. */
const BESIDE = 12;
/** Half the height of a name, px. */
const HALF = 8;
const STEP = { x: 16, y: 2 * HALF + 1 };
/** Where nothing is free within so many steps, a name stands at its point all the same. */
const STEPS = 24;

const meet = (a: Box, b: Box) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** The places of the names, in order, within the plot's room; `marks` are what is drawn already. */
export function placed(points: readonly Named[], marks: readonly Box[], room: Box): Label[] {
  const labels: Label[] = [];
  for (const point of points) {
    const blocked = [...marks, ...labels.map(({ box }) => box)];
    const free = candidates(point).find(({ box }) => inside(box, room) && !blocked.some((other) => meet(box, other)));
    labels.push(free ?? at(point, "start", 0, 0));
  }
  return labels;
}

const inside = (box: Box, room: Box) => box.left >= room.left && box.right <= room.right && box.top >= room.top && box.bottom <= room.bottom;

/** The places of a name, the nearest to its point first. */
function candidates(point: Named): Label[] {
  const found: Array<{ label: Label; far: number }> = [];
  for (let i = 0; i <= STEPS; i++) {
    for (let j = -STEPS; j <= STEPS; j++) {
      const far = Math.hypot(i * STEP.x, j * STEP.y);
      for (const anchor of ["start", "end"] as const) found.push({ label: at(point, anchor, i, j), far });
    }
  }
  return found.sort((a, b) => a.far - b.far).map(({ label }) => label);
}

function at({ x, y, width }: Named, anchor: Label["anchor"], i: number, j: number): Label {
  const away = BESIDE + i * STEP.x;
  const [left, right] = anchor === "start" ? [x + away, x + away + width] : [x - away - width, x - away];
  const middle = y + j * STEP.y;
  return { box: { left, right, top: middle - HALF, bottom: middle + HALF }, anchor, led: i > 0 || j !== 0 };
}
