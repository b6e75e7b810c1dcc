import { useMemo } from "react";

import type { View as Framing } from "../scene/CameraRig";
import { extentOf } from "../scene/trails";
import { framing, reachOf } from "../scene/framing";
import { useStudio, type View } from "../state/store";

/** Views that show the planned walk. */
export const WALKING: ReadonlySet<View> = new Set(["walk", "loads"]);

const NOTHING: Framing = { target: [0, 0, 40], radius: 300 };

/**
 * Region that the camera should show: the robot, or its whole walk.
 *
 * It changes with the content, not with every slider: a camera that moves during an edit is confusing.
 */
export function useFraming(view: View, follow: boolean, again: number): Framing {
  const robot = useStudio((studio) => studio.robot);
  const walk = useStudio((studio) => (WALKING.has(view) && !follow ? studio.walk : null));
  const reach = robot ? reachOf(robot) : 300;
  const extent = useMemo(() => (walk ? extentOf(walk).radius : 0), [walk]);
  // Steps of half an octave: smaller changes of the path do not move the camera.
  const size = walk ? Math.round(Math.log2(extent + reach) * 2) : 0;
  const key = [robot?.name, Math.round(Math.log2(reach) * 4), size, again].join();
  return useMemo(
    () => (robot ? framing(robot, walk) : NOTHING),
    // eslint-disable-next-line react-hooks/exhaustive-deps
    [key],
  );
}
