import type { Vector3 } from "three";

/** Duration of a camera transition [s]. */
export const FLIGHT = 0.35;

/** A camera transition; `from` is set by the first frame, which may be late. */
export interface Flight {
  eye: Vector3;
  target: Vector3;
  /** [s] */
  lasts: number;
  from: { eye: Vector3; target: Vector3; at: number } | null;
}

/** Advance a transition to the present time; returns whether it is complete. */
export function fly(flight: Flight, eye: Vector3, target: Vector3): boolean {
  const now = performance.now() / 1000;
  flight.from ??= { eye: eye.clone(), target: target.clone(), at: now };
  const fraction = flight.lasts > 0 ? Math.min(1, (now - flight.from.at) / flight.lasts) : 1;
  const eased = fraction * fraction * (3 - 2 * fraction);
  eye.lerpVectors(flight.from.eye, flight.eye, eased);
  target.lerpVectors(flight.from.target, flight.target, eased);
  return fraction === 1;
}
