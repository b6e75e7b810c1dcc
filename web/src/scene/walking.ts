import type { LoadsMessage, RobotMessage, SimulatedMessage, WalkMessage } from "../protocol";
import { advanced, usePlayback } from "../state/playback";
import { frameOfSimulated, frameOfWalk } from "./frames";
import { lengthOf } from "./trails";
import { stage } from "./stage";

/** Show a walk at the time of the playback, planned or in physics; returns a function that ends this. */
export function playWalk(
  robot: RobotMessage,
  walk: WalkMessage,
  loads: LoadsMessage | null,
  simulated: SimulatedMessage | null = null,
): () => void {
  const duration = lengthOf(walk);
  const frameNow = () => {
    const { time } = usePlayback.getState();
    return simulated ? frameOfSimulated(robot, simulated, walk, time) : frameOfWalk(robot, walk, loads, time);
  };
  let stop: (() => void) | null = null;
  const start = () => {
    stop = stage.play((dt) => {
      const playback = usePlayback.getState();
      if (!playback.playing) return null;
      usePlayback.setState(advanced(playback, dt, duration));
      return frameNow();
    });
  };
  const stopWatching = usePlayback.subscribe((playback, before) => {
    if (playback.playing && !before.playing) start();
    else if (!playback.playing) stage.show(frameNow(), false);
  });
  if (usePlayback.getState().time > duration) usePlayback.setState({ time: duration });
  stage.show(frameNow(), false);
  if (usePlayback.getState().playing) start();
  return () => {
    stopWatching();
    stop?.();
  };
}
