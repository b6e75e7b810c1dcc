import type { Vector3 } from "three";

/** Time a camera takes to fly to its place [s]. */
export const FLIGHT = 0.35;

/** On the way to a place; `from` is filled in by the first frame, which may come late. */
export interface Flight {
  eye: Vector3;
  target: Vector3;
  /** [s] */
  lasts: number;
  from: { eye: Vector3; target: Vector3; at: number } | null;
}

/** Go on with a flight by the clock, however slowly frames come; returns whether it has arrived. */
export function fly(flight: Flight, eye: Vector3, target: Vector3): boolean {
  const now = performance.now() / 1000;
  flight.from ??= { eye: eye.clone(), target: target.clone(), at: now };
  const share = flight.lasts > 0 ? Math.min(1, (now - flight.from.at) / flight.lasts) : 1;
  const eased = share * share * (3 - 2 * share);
  eye.lerpVectors(flight.from.eye, flight.eye, eased);
  target.lerpVectors(flight.from.target, flight.target, eased);
  return share === 1;
}
