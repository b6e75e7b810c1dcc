/** Formatting and parsing of numbers. */

/** Number of decimals that a step needs: 0.25 needs two. */
export function decimalsOf(step: number): number {
  if (!(step > 0)) return 0;
  for (let digits = 0; digits < 6; digits++) {
    const scaled = step * 10 ** digits;
    if (Math.abs(scaled - Math.round(scaled)) < 1e-9 * Math.max(1, scaled)) return digits;
  }
  return 6;
}

/** A number with a fixed number of decimals; never "-0". */
export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

const NO_BREAK = "\u00a0";

/** A text in which lines do not break between numbers and their units. */
export function unbroken(text: string): string {
  return text.replace(/\d (?:N m|N|mm|s|deg|kg|V|A|%)(?!\w)/g, (found) => found.replaceAll(" ", NO_BREAK));
}

/** A number with a unit, or a dash where it is unknown; lines do not break within it. */
export function withUnit(value: number | null | undefined, digits: number, unit: string): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  return (unit ? `${fixed(value, digits)} ${unit}` : fixed(value, digits)).replaceAll(" ", NO_BREAK);
}

/** Parse a typed number, with decimal point or comma; null where the text is not a complete number. */
export function typedNumber(text: string): number | null {
  const plain = text.trim().replace(",", ".").replace("−", "-");
  if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain)) return null;
  const value = Number(plain);
  return Number.isFinite(value) ? value : null;
}

/** What a field accepts, in words. */
export function rangeText(min: number | undefined, max: number | undefined): string {
  if (min !== undefined && max !== undefined) return `must be from ${min} to ${max}`;
  if (min !== undefined) return `must be at least ${min}`;
  return max === undefined ? "must be a number" : `must be at most ${max}`;
}

/** A number moved by a step within a range, without the rounding of binary fractions. */
export function stepped(value: number, step: number, min = -Infinity, max = Infinity): number {
  return clamp(Number((value + step).toFixed(6)), min, max);
}

/** A number clamped to a range. */
export function clamp(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}

/** Least and greatest number of digits after which two numbers are compared. */
const [FEW, MANY] = [4, 9];

/** A number with so many significant digits, in decimal notation. */
export function significant(value: number, digits: number): string {
  if (value === 0 || !Number.isFinite(value)) return fixed(value, 0);
  const decimals = digits - 1 - Math.floor(Math.log10(Math.abs(value)));
  return fixed(value, Math.min(12, Math.max(0, decimals)));
}

/** Two numbers with digits enough to tell them apart. */
export function apart(one: number, other: number): [string, string] {
  for (let digits = FEW; digits < MANY; digits++) {
    const texts: [string, string] = [significant(one, digits), significant(other, digits)];
    if (texts[0] !== texts[1]) return texts;
  }
  return [significant(one, FEW), significant(other, FEW)];
}
