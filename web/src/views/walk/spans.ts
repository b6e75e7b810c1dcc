import type { WalkMessage } from "../../protocol";

/** Stance intervals of a foot as pairs of start and end [s]. */
export function stanceSpans(
  walk: Pick<WalkMessage, "contacts" | "rate_hz">,
  leg: number,
): [number, number][] {
  const isDown = (i: number) => walk.contacts[i]?.[leg] === "1";
  const last = walk.contacts.length - 1;
  const spans: [number, number][] = [];
  let start = 0;
  for (let i = 0; i <= last; i++) {
    if (!isDown(i)) continue;
    if (i === 0 || !isDown(i - 1)) start = i;
    // A stance ends with the first sample in the air, or with the walk.
    if (i === last || !isDown(i + 1))
      spans.push([start / walk.rate_hz, Math.min(i + 1, last) / walk.rate_hz]);
  }
  return spans;
}
