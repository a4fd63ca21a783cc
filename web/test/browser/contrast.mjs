// How well the words of buttons, links and notices can be read: WCAG 2's contrast, from computed styles.

/**
 * In the page: of every visible button, link and notice with words, what it says and the contrast of that with what is behind it, as the
 * browser would paint both: backgrounds and opacities of all ancestors count. `edge` is the contrast of what tells a button from the page.
 */
export function contrasts() {
  const channels = (css) => {
    const [r = 0, g = 0, b = 0, a = 1] = (css.match(/[\d.]+(?:e-?\d+)?/g) ?? []).map(Number);
    return css === "transparent" ? [0, 0, 0, 0] : css.startsWith("color(") ? [255 * r, 255 * g, 255 * b, a] : [r, g, b, a];
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((c, i) => a * c + (1 - a) * below[i]);
  const luminance = (rgb) => {
    const [r, g, b] = rgb.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (a, b) => {
    const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
    return (high + 0.05) / (low + 0.05);
  };
  /** The colour at an element's middle once its ancestors and it, and `ink` on it, have been painted. */
  const painted = (chain, ink, below) => {
    const [style, ...rest] = chain;
    const ground = over(channels(style.backgroundColor), below);
    const inner = rest.length > 0 ? painted(rest, ink, ground) : ink === null ? ground : over(channels(ink), ground);
    return over([...inner, Number(style.opacity)], below);
  };
  const paper = document.createElement("div");
  paper.style.backgroundColor = "Canvas";
  document.body.append(paper);
  const canvas = over(channels(getComputedStyle(paper).backgroundColor), [255, 255, 255]);
  paper.remove();
  return [
    ...document.querySelectorAll('button, a[href], summary, input:not([type="radio"], [type="checkbox"]), select, [role="button"], #notice, #ribbon span, #boot h1, .page [role="status"]'),
  ].flatMap((element) => {
    const words = (element.innerText || element.value || "").trim();
    if (words === "" || !element.checkVisibility({ visibilityProperty: true, opacityProperty: true })) return [];
    const chain = [];
    for (let at = element; at !== null; at = at.parentElement) chain.unshift(getComputedStyle(at));
    const own = chain[chain.length - 1];
    const [ground, behind] = [painted(chain, null, canvas), painted(chain.slice(0, -1), null, canvas)];
    const border = parseFloat(own.borderTopWidth) > 0 && own.borderTopStyle !== "none" ? contrast(painted(chain, own.borderTopColor, canvas), behind) : 1;
    return [{ words, kind: element.className, contrast: contrast(painted(chain, own.color, canvas), ground), edge: Math.max(border, contrast(ground, behind)) }];
  });
}

/** The states in which something can be pressed, as the browser's own developer tools force them. */
const STATES = [[], ["hover"], ["focus", "focus-visible"], ["hover", "active"], ["hover", "focus", "focus-visible", "active"]];
const PRESSABLE = 'button, a[href], summary, input, select, [role="button"]';

/** What `contrasts` finds in every state of everything that can be pressed, disabled too. */
export async function inEveryState(page) {
  const cdp = await page.context().newCDPSession(page);
  await cdp.send("DOM.enable");
  await cdp.send("CSS.enable");
  const { root } = await cdp.send("DOM.getDocument", { depth: 0 });
  const { nodeIds } = await cdp.send("DOM.querySelectorAll", { nodeId: root.nodeId, selector: PRESSABLE });
  const found = [];
  const look = async (state) => found.push(...(await page.evaluate(contrasts)).map((one) => ({ ...one, state })));
  for (const forcedPseudoClasses of STATES) {
    for (const nodeId of nodeIds) await cdp.send("CSS.forcePseudoState", { nodeId, forcedPseudoClasses });
    await look(forcedPseudoClasses.join("+") || "at rest");
  }
  for (const nodeId of nodeIds) await cdp.send("CSS.forcePseudoState", { nodeId, forcedPseudoClasses: [] });
  await page.evaluate(disable, true);
  await look("disabled");
  await page.evaluate(disable, false);
  await cdp.detach();
  return found;
}

function disable(off) {
  for (const element of document.querySelectorAll("button, input, select, .action")) {
    if (off && element.getAttribute("aria-disabled") === null && !element.disabled) {
      element.setAttribute("aria-disabled", "true");
      if ("disabled" in element) element.disabled = true;
      element.dataset.wasEnabled = "";
    } else if (!off && "wasEnabled" in element.dataset) {
      element.removeAttribute("aria-disabled");
      element.disabled = false;
      delete element.dataset.wasEnabled;
    }
  }
}
