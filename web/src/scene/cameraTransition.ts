import type { Vector3 } from "three";

/** Duration of a camera transition [s]. */
export const TRANSITION_TIME = 0.35;

/** A camera transition; `from` is set by the first frame, which may be late. */
export interface CameraTransition {
  eye: Vector3;
  target: Vector3;
  /** [s] */
  lasts: number;
  from: { eye: Vector3; target: Vector3; at: number } | null;
}

/** Advance a transition to the present time; returns whether it is complete. */
export function fly(transition: CameraTransition, eye: Vector3, target: Vector3): boolean {
  const now = performance.now() / 1000;
  transition.from ??= { eye: eye.clone(), target: target.clone(), at: now };
  const fraction = transition.lasts > 0 ? Math.min(1, (now - transition.from.at) / transition.lasts) : 1;
  const eased = fraction * fraction * (3 - 2 * fraction);
  eye.lerpVectors(transition.from.eye, transition.eye, eased);
  target.lerpVectors(transition.from.target, transition.target, eased);
  return fraction === 1;
}
