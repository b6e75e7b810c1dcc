import { Spherical, type Vector3 } from "three";

/** Turning the picture by keyboard: the camera rig takes these turns at its next frame. */
export interface Turn {
  /** About the upright, and up or down [rad]; nearer by a factor. */
  round: number;
  over: number;
  nearer: number;
}

const STEP = Math.PI / 24;
const TURNS: Record<string, Turn> = {
  ArrowLeft: { round: STEP, over: 0, nearer: 1 },
  ArrowRight: { round: -STEP, over: 0, nearer: 1 },
  ArrowUp: { round: 0, over: -STEP, nearer: 1 },
  ArrowDown: { round: 0, over: STEP, nearer: 1 },
  "+": { round: 0, over: 0, nearer: 0.9 },
  "=": { round: 0, over: 0, nearer: 0.9 },
  "-": { round: 0, over: 0, nearer: 1 / 0.9 },
};

let listener: ((turn: Turn) => void) | null = null;

/** Turn by a key; returns whether the key means a turn. */
export function steer(key: string): boolean {
  const turn = TURNS[key];
  if (!turn || !listener) return false;
  listener(turn);
  return true;
}

/** Take the turns from now on; returns how to stop. */
export function onSteer(take: (turn: Turn) => void): () => void {
  listener = take;
  return () => {
    if (listener === take) listener = null;
  };
}

/** How far down one may look along the floor [rad from the upright]. */
export const LOWEST = Math.PI * 0.497;

/** Move the eye round what it looks at. */
export function turnBy({ round, over, nearer }: Turn, eye: Vector3, target: Vector3) {
  const offset = eye.clone().sub(target);
  // three's spherical angles have y up: z, x, y of ours.
  const angles = new Spherical().setFromCartesianCoords(offset.y, offset.z, offset.x);
  angles.theta += round;
  angles.phi = Math.min(LOWEST, Math.max(0.001, angles.phi + over));
  angles.radius *= nearer;
  offset.setFromSpherical(angles);
  eye.set(offset.z, offset.x, offset.y).add(target);
}
