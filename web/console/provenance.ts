/** What is known of how a stimulus was made. Provenance is free JSON, so each part is looked at before it is believed. */

/** Differences in units of the brightest unshadowed point. */
export interface Errors {
  rmse: number;
  max: number;
}

/** A stimulus's measured error against its reference. */
export interface Measured {
  reference: Record<string, unknown>;
  penumbra: Errors;
  /** The reference's own standard error: what no measured error can go below. */
  floor: number | null;
}

const object = (value: unknown): Record<string, unknown> => (typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Record<string, unknown>) : {});
const number = (value: unknown): number | null => (typeof value === "number" ? value : null);

/** The measured error of a stimulus; null where none is known. */
export function measuredError(provenance: unknown): Measured | null {
  const error = object(object(provenance).error);
  const penumbra = object(error.penumbra);
  const [rmse, max] = [number(penumbra.rmse), number(penumbra.max)];
  return rmse === null || max === null ? null : { reference: object(error.reference), penumbra: { rmse, max }, floor: number(error.floor) };
}

/** Monte Carlo's own standard error where it sampled, in the same units; null where there is none. */
export function standardError(provenance: unknown): { rms: number; max: number } | null {
  const own = object(object(provenance).standard_error);
  const [rms, max] = [number(own.rms_sampled), number(own.max)];
  return rms === null || max === null ? null : { rms, max };
}

/** `{ a: { b: 1 } }` as `[["a.b", 1]]`; lists of plain values stay in one piece, and what is null is left out. */
export function flatten(value: unknown, name = ""): Array<[string, unknown]> {
  if (Array.isArray(value) && value.every((item) => item === null || typeof item !== "object")) return [[name, value.join(", ")]];
  if (value !== null && typeof value === "object") {
    return Object.entries(value).flatMap(([key, inner]) => flatten(inner, name === "" ? key : `${name}.${key}`));
  }
  return value === undefined || value === null ? [] : [[name, value]];
}
