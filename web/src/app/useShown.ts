import { useEffect } from "react";

import { frameOfPose } from "../scene/frames";
import { prefersStillness, stage } from "../scene/stage";
import { playWalk } from "../scene/walking";
import { usePlayback } from "../state/playback";
import { useStudio, type View } from "../state/store";
import { WALKING } from "./useFraming";

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
    return playWalk(robot, walk, loads);
  }, [robot, walk, loads, walking]);

  useFirstWalk(walk !== null);
}

let begun = false;

/** The first walk begins to play by itself, unless a link says at which moment it rests, or motion is unwelcome. */
function useFirstWalk(there: boolean): void {
  useEffect(() => {
    if (!there || begun) return;
    begun = true;
    const time = useStudio.getState().state?.picture.time_s ?? 0;
    usePlayback.setState({ time, playing: time === 0 && !prefersStillness() });
  }, [there]);
}
