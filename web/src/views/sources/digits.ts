/** Number of decimals for each unit. */
export function digitsOf(unit: string): number {
  return unit === "mm" || unit === "deg" || unit === "°" ? 2 : 4;
}
