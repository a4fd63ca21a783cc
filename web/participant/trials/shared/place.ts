/** Where pictures stand on a trial's page: in the room between question and position, in whole device pixels. */
import { h } from "../../../shared/dom.ts";
import { rounded } from "../../clock.ts";
import type { Room, Size } from "../../layout.ts";

/** Room around the pictures for an outline, CSS px: 6 wide, 4 away. */
const EDGE = 10;

/** What pictures may fill, CSS px, outlines' room already taken off. */
export function roomWithin(root: HTMLElement, heading: HTMLElement, footer: HTMLElement): Room {
  const outer = (element: HTMLElement) => {
    const { marginTop, marginBottom } = getComputedStyle(element);
    return element.getBoundingClientRect().height + parseFloat(marginTop) + parseFloat(marginBottom);
  };
  const { paddingTop, paddingBottom } = getComputedStyle(root);
  const around = outer(heading) + outer(footer) + parseFloat(paddingTop) + parseFloat(paddingBottom);
  return { roomWidth: document.documentElement.clientWidth - 2 * EDGE, roomHeight: innerHeight - around - 2 * EDGE, devicePixelRatio };
}

/** What pictures could fill on a trial's page with this question, before there is one: it has no scroll bar. */
export function roomFor(question: string): Room {
  const [heading, footer] = [h("h1", {}, question), h("p", { class: "position" })];
  const root = h("section", { class: "trial", "aria-hidden": "true" }, heading, footer);
  Object.assign(root.style, { position: "absolute", inset: "0", visibility: "hidden", pointerEvents: "none" });
  document.body.append(root);
  const room = roomWithin(root, heading, footer);
  root.remove();
  return { ...room, roomWidth: innerWidth - 2 * EDGE };
}

/** Shifts `box` by less than a pixel, so that `picture` within it begins at a whole device pixel. */
export function toWholePixels(box: HTMLElement, picture: HTMLElement): void {
  box.style.left = box.style.top = "0px";
  const { left, top } = picture.getBoundingClientRect();
  const dpr = devicePixelRatio;
  box.style.left = `${(Math.round(left * dpr) - left * dpr) / dpr}px`;
  box.style.top = `${(Math.round(top * dpr) - top * dpr) / dpr}px`;
}

/** Gives a picture its size on the page; of whole multiples each pixel is a square. */
export function showAt(picture: HTMLElement, { scale, width, height }: Size): void {
  picture.style.width = `${width}px`;
  picture.style.height = `${height}px`;
  picture.style.imageRendering = scale > 1 && Number.isInteger(scale) ? "pixelated" : "auto";
}

/** How a stimulus was shown, from its layout (`scale` in device pixels per stimulus pixel, `width` in CSS px). */
export function shownAt({ scale, width }: Pick<Size, "scale" | "width">) {
  const zoom = globalThis.visualViewport?.scale ?? 1;
  return {
    scale: scale * zoom,
    css_width_px: rounded(width * zoom),
    device_pixel_ratio: devicePixelRatio,
    viewport: [innerWidth, innerHeight] as [number, number],
  };
}
