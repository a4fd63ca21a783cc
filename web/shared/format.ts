/** Numbers as a reader expects them: a true minus, no more digits than mean something, and a word for what is missing. */

const MINUS = "\u2212";
const MISSING = "\u2013";

const signed = (text: string) => text.replace("-", MINUS);

/** A number with so many decimals; an en dash for null. */
export function fixed(x: number | null | undefined, decimals: number): string {
  if (x === null || x === undefined || Number.isNaN(x)) return MISSING;
  if (!Number.isFinite(x)) return x > 0 ? "∞" : `${MINUS}∞`;
  const text = x.toFixed(decimals);
  // −0.00 is a rounding's artefact.
  return Number(text) === 0 ? (0).toFixed(decimals) : signed(text);
}

/** So many significant digits, with a power of ten where plain decimals would hide them. */
export function significant(x: number | null | undefined, digits = 3): string {
  if (x === null || x === undefined || Number.isNaN(x)) return MISSING;
  if (!Number.isFinite(x)) return x > 0 ? "∞" : `${MINUS}∞`;
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e-3 && size < 1e6) return signed(Number(x.toPrecision(digits)) === 0 ? "0" : plain(x, digits));
  const [mantissa = "", exponent = "0"] = x.toExponential(digits - 1).split("e");
  return `${signed(mantissa)} × 10${superscript(Number(exponent))}`;
}

/** "1 participant", "2 participants". */
export function count(n: number, one: string, many = `${one}s`): string {
  return `${n.toLocaleString("en")} ${n === 1 ? one : many}`;
}

/** Time of day of this browser, for "updated at". */
export function clockTime(date: Date): string {
  return date.toLocaleTimeString("en-GB");
}

/** The days of two ISO 8601 times, "2026-05-04 to 2026-06-03", or the one day. */
export function dateSpan(from: string, to: string): string {
  const [first, last] = [from.slice(0, 10), to.slice(0, 10)];
  return first === last ? first : `${first} to ${last}`;
}

function plain(x: number, digits: number): string {
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(x))));
  return x.toFixed(Math.min(20, decimals));
}

function superscript(n: number): string {
  return [...String(n)].map((c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)])).join("");
}
