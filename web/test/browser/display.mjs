// A display of a given refresh rate.

/** In the page, before all else: animation frames at `hz`, but for those that `drop` names, counted from the film's first. */
export function display({ hz, drop }) {
  const period = 1000 / hz;
  let queue = [];
  let next = 0;
  let first = null;
  let handle = 0;
  let ofFilm = 0;
  const tick = () => {
    const now = performance.now();
    first ??= now;
    if (first + next * period > now) return void setTimeout(tick, 1);
    const at = first + next * period;
    next += 1;
    if (globalThis.drawn > 0 && drop.includes(ofFilm++)) return void setTimeout(tick, 0);
    const due = queue;
    queue = [];
    for (const [, run] of due) run(at);
    setTimeout(tick, 0);
  };
  globalThis.requestAnimationFrame = (run) => {
    queue.push([++handle, run]);
    return handle;
  };
  globalThis.cancelAnimationFrame = (id) => (queue = queue.filter(([known]) => known !== id));
  // What is drawn of a film that is shown: a picture that is a bitmap.
  globalThis.drawn = 0;
  const draw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...args) {
    if (args[0] instanceof ImageBitmap && document.querySelector(".pair.shown") !== null) globalThis.drawn += 1;
    return draw.apply(this, args);
  };
  setTimeout(tick, 0);
}
