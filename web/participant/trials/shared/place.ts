/** Where pictures stand on a trial's page: in the room between question and position, in whole device pixels. */
import { h } from "../../../shared/dom.ts";
import { rounded } from "../../clock.ts";

/** Room around the pictures for an outline, CSS px. */
const EDGE = 14;

/** What pictures may fill, CSS px, outlines' room already taken off. */
export function roomWithin(root: HTMLElement, heading: HTMLElement, footer: HTMLElement): { roomWidth: number; roomHeight: number; devicePixelRatio: number } {
  const outer = (element: HTMLElement) => {
    const { marginTop, marginBottom } = getComputedStyle(element);
    return element.getBoundingClientRect().height + parseFloat(marginTop) + parseFloat(marginBottom);
  };
  const { paddingTop, paddingBottom } = getComputedStyle(root);
  const around = outer(heading) + outer(footer) + parseFloat(paddingTop) + parseFloat(paddingBottom);
  return { roomWidth: document.documentElement.clientWidth - 2 * EDGE, roomHeight: innerHeight - around - 2 * EDGE, devicePixelRatio };
}

/** What pictures could fill on a trial's page with this question, before there is one. */
export function roomFor(question: string): ReturnType<typeof roomWithin> {
  const [heading, footer] = [h("h1", {}, question), h("p", { class: "position" })];
  const root = h("section", { class: "trial", "aria-hidden": "true" }, heading, footer);
  Object.assign(root.style, { position: "absolute", inset: "0", visibility: "hidden", pointerEvents: "none" });
  document.body.append(root);
  const room = roomWithin(root, heading, footer);
  root.remove();
  return room;
}

/** Shifts `box` by less than a pixel, so that `picture` within it begins at a whole device pixel. */
export function toWholePixels(box: HTMLElement, picture: HTMLElement): void {
  box.style.left = box.style.top = "0px";
  const { left, top } = picture.getBoundingClientRect();
  const dpr = devicePixelRatio;
  box.style.left = `${(Math.round(left * dpr) - left * dpr) / dpr}px`;
  box.style.top = `${(Math.round(top * dpr) - top * dpr) / dpr}px`;
}

/** How a stimulus was shown, from its layout (`scale` in device pixels per stimulus pixel, `width` in CSS px). */
export function shownAt({ scale, width }: { scale: number; width: number }) {
  const zoom = globalThis.visualViewport?.scale ?? 1;
  return {
    scale: scale * zoom,
    css_width_px: rounded(width * zoom),
    device_pixel_ratio: devicePixelRatio,
    viewport: [innerWidth, innerHeight] as [number, number],
  };
}
