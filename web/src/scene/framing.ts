import type { RobotMessage, WalkMessage } from "../protocol";
import type { View } from "./CameraRig";
import { extentOf } from "./trails";

/** Region that the camera shows: the robot in its stance, or its whole walk. */
export function framing(robot: RobotMessage, walk: WalkMessage | null): View {
  const reach = reachOf(robot);
  const extent = walk && extentOf(walk);
  const [x, y] = extent?.middle ?? [0, 0];
  return { target: [x, y, reach * 0.2], radius: reach + (extent?.radius ?? 0) * 0.7 };
}

/** Radius of the standing robot about the centre of its body, with a margin [mm]. */
export function reachOf(robot: RobotMessage): number {
  const feet = robot.stance_mm ?? robot.mount_mm;
  let far = 0;
  for (let i = 0; i + 1 < feet.length; i += 3)
    far = Math.max(far, Math.hypot(feet[i] ?? 0, feet[i + 1] ?? 0));
  return Math.max(far, robot.body_height_mm) * 1.3;
}
