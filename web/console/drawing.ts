/** The server's figures, taken onto the page: SVG text is parsed apart from it, and nothing but shapes and words come over. */

const SVG = "http://www.w3.org/2000/svg";
const ELEMENTS = new Set(["svg", "title", "desc", "g", "path", "rect", "circle", "text"]);
const ATTRIBUTES = new Set("viewBox width height role font-family font-size font-weight fill stroke stroke-width stroke-dasharray text-anchor paint-order transform x y dy cx cy r d".split(" "));

/** A figure's picture; null where the text is no SVG. */
export function drawing(svg: string): Element | null {
  const root = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  if (!isKnown(root) || root.querySelector("parsererror") !== null) return null;
  for (const element of [root, ...root.querySelectorAll("*")]) {
    if (!isKnown(element)) element.remove();
    for (const { name } of [...element.attributes]) if (!ATTRIBUTES.has(name)) element.removeAttribute(name);
  }
  return document.adoptNode(root);
}

const isKnown = (element: Element) => element.namespaceURI === SVG && ELEMENTS.has(element.localName);
