/** Delay before the n-th attempt to reconnect, from 0 [ms]: doubles, with a random part. */
export function backoff(attempt: number, random: () => number = Math.random): number {
  const base = Math.min(15_000, 400 * 2 ** Math.min(attempt, 10));
  return Math.round(base * (0.75 + 0.5 * random()));
}
