import { Spherical, type Vector3 } from "three";

/** A rotation of the camera by keyboard, applied by the camera rig in its next frame. */
export interface Turn {
  /** Changes of azimuth and polar angle [rad], and factor of the distance. */
  azimuth: number;
  polar: number;
  distance: number;
}

const STEP = Math.PI / 24;
const TURNS: Record<string, Turn> = {
  ArrowLeft: { azimuth: STEP, polar: 0, distance: 1 },
  ArrowRight: { azimuth: -STEP, polar: 0, distance: 1 },
  ArrowUp: { azimuth: 0, polar: -STEP, distance: 1 },
  ArrowDown: { azimuth: 0, polar: STEP, distance: 1 },
  "+": { azimuth: 0, polar: 0, distance: 0.9 },
  "=": { azimuth: 0, polar: 0, distance: 0.9 },
  "-": { azimuth: 0, polar: 0, distance: 1 / 0.9 },
};

let listener: ((turn: Turn) => void) | null = null;

/** Handle a key; returns whether it turns the camera. */
export function steer(key: string): boolean {
  const turn = TURNS[key];
  if (!turn || !listener) return false;
  listener(turn);
  return true;
}

/** Set the handler of rotations; returns a function that removes it. */
export function onSteer(take: (turn: Turn) => void): () => void {
  listener = take;
  return () => {
    if (listener === take) listener = null;
  };
}

/** Greatest polar angle of the camera [rad from the vertical]. */
export const LOWEST = Math.PI * 0.497;

/** Rotate the camera about its target. */
export function turnBy({ azimuth, polar, distance }: Turn, eye: Vector3, target: Vector3) {
  const offset = eye.clone().sub(target);
  // The spherical coordinates of three.js have y up.
  const angles = new Spherical().setFromCartesianCoords(offset.y, offset.z, offset.x);
  angles.theta += azimuth;
  angles.phi = Math.min(LOWEST, Math.max(0.001, angles.phi + polar));
  angles.radius *= distance;
  offset.setFromSpherical(angles);
  eye.set(offset.z, offset.x, offset.y).add(target);
}
