/** How many digits after the point a unit's numbers are shown with. */
export function digitsOf(unit: string): number {
  return unit === "mm" || unit === "deg" || unit === "°" ? 2 : 4;
}
