import { useMemo } from "react";

import type { View as Framing } from "../scene/CameraRig";
import { extentOf } from "../scene/trails";
import { framing, reachOf } from "../scene/framing";
import { useStudio, type View } from "../state/store";

/** Views in which the robot walks its planned walk. */
export const WALKING: ReadonlySet<View> = new Set(["walk", "loads"]);

const NOTHING: Framing = { target: [0, 0, 40], radius: 300 };

/**
 * What the camera should see: the robot, or all of its walk.
 *
 * It changes when another thing is shown, not with every slider: a picture that moves by itself can't be read.
 */
export function useFraming(view: View, follow: boolean, again: number): Framing {
  const robot = useStudio((studio) => studio.robot);
  const walk = useStudio((studio) => (WALKING.has(view) && !follow ? studio.walk : null));
  const reach = robot ? reachOf(robot) : 300;
  const extent = useMemo(() => (walk ? extentOf(walk).radius : 0), [walk]);
  // Half an octave: a path must become that much longer before the camera steps back.
  const size = walk ? Math.round(Math.log2(extent + reach) * 2) : 0;
  const key = [robot?.name, Math.round(Math.log2(reach) * 4), size, again].join();
  return useMemo(
    () => (robot ? framing(robot, walk) : NOTHING),
    // eslint-disable-next-line react-hooks/exhaustive-deps
    [key],
  );
}
