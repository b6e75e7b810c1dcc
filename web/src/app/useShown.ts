import { useEffect } from "react";

import { frameOfPose, frameOfWalk } from "../scene/frames";
import { stage } from "../scene/stage";
import { advanced, usePlayback } from "../state/playback";
import { useStudio, type View } from "../state/store";
import { lengthOf, WALKING } from "./useFraming";

/** Put on the stage what a view shows: a pose, or the walk at its time. Live frames come there by themselves. */
export function useShown(view: View): void {
  const robot = useStudio((studio) => studio.robot);
  const pose = useStudio(({ poses }) => poses[view] ?? poses.body ?? poses.joints ?? null);
  const walk = useStudio((studio) => studio.walk);
  const loads = useStudio((studio) => studio.loads);
  const walking = WALKING.has(view) && walk !== null;
  const standing = !walking && view !== "drive";

  useEffect(() => {
    if (robot && pose && standing && pose.angles_deg.length === robot.leg_names.length * 3) {
      stage.show(frameOfPose(robot, pose));
    }
  }, [robot, pose, standing]);

  useEffect(() => {
    if (!robot || !walk || !walking || walk.angles_deg.length !== walk.count * robot.leg_names.length * 3)
      return;
    const duration = lengthOf(walk);
    const frameNow = () => frameOfWalk(robot, walk, loads, usePlayback.getState().time);
    if (usePlayback.getState().time > duration) usePlayback.setState({ time: duration });
    stage.show(frameNow(), false);
    const stopWatching = usePlayback.subscribe((playback, before) => {
      if (playback.playing && !before.playing) start();
      else if (!playback.playing) stage.show(frameNow(), false);
    });
    let stop: (() => void) | null = null;
    const start = () => {
      stop = stage.play((dt) => {
        const playback = usePlayback.getState();
        if (!playback.playing) return null;
        usePlayback.setState(advanced(playback, dt, duration));
        return frameNow();
      });
    };
    if (usePlayback.getState().playing) start();
    return () => {
      stopWatching();
      stop?.();
    };
  }, [robot, walk, loads, walking]);
}
