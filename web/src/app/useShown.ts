import { useEffect } from "react";

import { frameOfBringUp, frameOfPose } from "../scene/frames";
import { prefersReducedMotion, stage } from "../scene/stage";
import { playWalk } from "../scene/walking";
import { usePlayback } from "../state/playback";
import { useStudio, type View } from "../state/store";
import { useInPhysics, useSimulation } from "../views/physics/usePhysics";
import { WALKING } from "./useFraming";

/** Show the pose or the walk of a view in the scene. Frames of driving are shown by `state/driving`. */
export function useShown(view: View): void {
  const robot = useStudio((studio) => studio.robot);
  const pose = useStudio(({ poses }) => poses[view] ?? poses.body ?? poses.joints ?? null);
  const walk = useStudio((studio) => studio.walk);
  const loads = useStudio((studio) => studio.loads);
  const physical = useInPhysics(view);
  const simulated = useStudio((studio) => (physical && view === "walk" ? studio.simulated : null));
  const walking = WALKING.has(view) && walk !== null;
  const bringUp = useStudio((studio) => (view === "robot" ? studio.bringUp : null));
  const standing = !walking && view !== "drive" && !bringUp;

  useEffect(() => {
    if (robot && pose && standing && pose.angles_deg.length === robot.leg_names.length * 3) {
      stage.show(frameOfPose(robot, pose));
    }
  }, [robot, pose, standing]);

  useEffect(() => {
    if (robot && bringUp?.angles_deg.length === robot.leg_names.length * 3) {
      stage.show(frameOfBringUp(robot, bringUp));
    }
  }, [robot, bringUp]);

  useEffect(() => {
    if (!robot || !walk || !walking || walk.angles_deg.length !== walk.count * robot.leg_names.length * 3)
      return;
    return playWalk(robot, walk, loads, simulated);
  }, [robot, walk, loads, simulated, walking]);

  useSimulation(view);

  useFirstWalk(walk !== null);
}

let begun = false;

/** Start the playback of the first walk, unless a link sets its time or the system asks for reduced motion. */
function useFirstWalk(there: boolean): void {
  useEffect(() => {
    if (!there || begun) return;
    begun = true;
    const time = useStudio.getState().state?.picture.time_s ?? 0;
    usePlayback.setState({ time, playing: time === 0 && !prefersReducedMotion() });
  }, [there]);
}
