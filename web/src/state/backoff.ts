/** How long to wait before trying to connect for the n-th time, 0 the first [ms]: doubling, and not all at once. */
export function backoff(attempt: number, random: () => number = Math.random): number {
  const base = Math.min(15_000, 400 * 2 ** Math.min(attempt, 10));
  return Math.round(base * (0.75 + 0.5 * random()));
}
