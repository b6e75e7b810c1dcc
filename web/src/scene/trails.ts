import type { RobotMessage, WalkMessage } from "../protocol";
import type { Vec3 } from "./frame";
import { frameOfWalk, type Samples } from "./frames";
import { triple } from "./kinematics";

/** Path of each foot over a walk: x, y, z of at most `most` points for each leg [mm]. */
export function footTrails(robot: RobotMessage, walk: Samples, most = 600): Float32Array[] {
  const every = Math.max(1, Math.ceil(walk.count / most));
  const samples = Array.from({ length: Math.ceil(walk.count / every) }, (_, n) => n * every);
  const legs = robot.leg_names.length;
  const trails = Array.from({ length: legs }, () => new Float32Array(samples.length * 3));
  samples.forEach((sample, n) => {
    const { points } = frameOfWalk(robot, walk, null, sample / walk.rate_hz);
    trails.forEach((trail, leg) => trail.set(points.subarray(leg * 12 + 9, leg * 12 + 12), n * 3));
  });
  return trails;
}

/** Circle on the ground that contains the walk: centre and radius [mm]. */
export function extentOf(walk: WalkMessage): { middle: Vec3; radius: number } {
  const xs: number[] = [];
  const ys: number[] = [];
  for (let i = 0; i < walk.count; i++) {
    const [x, y] = triple(walk.position_mm, i);
    xs.push(x);
    ys.push(y);
  }
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  return { middle: [(x0 + x1) / 2, (y0 + y1) / 2, 0], radius: Math.hypot(x1 - x0, y1 - y0) / 2 };
}

/** Duration of a walk from its first to its last sample [s]. */
export function lengthOf(walk: WalkMessage | null): number {
  return walk ? (walk.count - 1) / walk.rate_hz : 0;
}
