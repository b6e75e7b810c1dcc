import type { LoadsMessage, RobotMessage, WalkMessage } from "../protocol";
import { advanced, usePlayback } from "../state/playback";
import { frameOfWalk } from "./frames";
import { lengthOf } from "./trails";
import { stage } from "./stage";

/** Show a walk at the time of the playback; returns a function that ends this. */
export function playWalk(robot: RobotMessage, walk: WalkMessage, loads: LoadsMessage | null): () => void {
  const duration = lengthOf(walk);
  const frameNow = () => frameOfWalk(robot, walk, loads, usePlayback.getState().time);
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
