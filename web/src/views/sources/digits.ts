import { significant, withUnit } from "../../controls/numbers";

/** A value of an equation: lengths and angles with two decimals, others, which may be tiny, with four digits. */
export function valueText(value: number | null, unit: string): string {
  if (value === null) return "–";
  if (unit === "mm" || unit === "deg") return withUnit(value, 2, unit === "deg" ? "°" : unit);
  return `${significant(value, 4)} ${unit}`.trim();
}
