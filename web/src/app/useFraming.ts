import { useMemo } from "react";

import type { RobotMessage, WalkMessage } from "../protocol";
import type { View as Framing } from "../scene/CameraRig";
import { extentOf } from "../scene/frames";
import { useStudio, type View } from "../state/store";

/** Views in which the robot walks its planned walk. */
export const WALKING: ReadonlySet<View> = new Set(["walk", "loads"]);

/**
 * What the camera should see: the robot, or all of its walk.
 *
 * It changes when another thing is shown, not with every slider: a picture that moves by itself can't be read.
 */
export function useFraming(view: View, follow: boolean, again: number): Framing {
  const robot = useStudio((studio) => studio.robot);
  const walk = useStudio((studio) => (WALKING.has(view) ? studio.walk : null));
  const extent = useMemo(() => (walk ? extentOf(walk) : null), [walk]);
  const walks = extent !== null && !follow;
  const reach = robot ? reachOf(robot) : 300;
  // Half an octave: a path must become that much longer before the camera steps back.
  const size = walks ? Math.round(Math.log2(extent.radius + reach) * 2) : 0;
  const key = [robot?.name, Math.round(reach / 20), size, again].join();
  return useMemo(
    () => framing(reach, walks ? extent : null),
    // eslint-disable-next-line react-hooks/exhaustive-deps
    [key],
  );
}

function framing(reach: number, extent: ReturnType<typeof extentOf> | null): Framing {
  const [x, y] = extent?.middle ?? [0, 0];
  return { target: [x, y, reach * 0.16], radius: reach + (extent?.radius ?? 0) };
}

/** How far from the body's middle the standing robot reaches [mm]. */
function reachOf(robot: RobotMessage): number {
  const feet = robot.stance_mm ?? robot.mount_mm;
  let far = 0;
  for (let i = 0; i + 1 < feet.length; i += 3)
    far = Math.max(far, Math.hypot(feet[i] ?? 0, feet[i + 1] ?? 0));
  return Math.max(far, robot.clearance_mm) * 1.12;
}

/** The walk's clock may only run where there is a walk. */
export function lengthOf(walk: WalkMessage | null): number {
  return walk ? (walk.count - 1) / walk.rate_hz : 0;
}
