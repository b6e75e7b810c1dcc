import { useEffect, useRef } from "react";

import { IconButton } from "../controls/IconButton";
import { fixed } from "../controls/numbers";
import { useCommit } from "../controls/useCommit";
import { SPEEDS, stepped, usePlayback } from "../state/playback";

interface Props {
  duration: number;
  rate: number;
  /** Called with the time when it has stopped changing [s]. */
  onRest?: (time: number) => void;
}

/** Play, pause, step, scrub. The slider follows the playback without rendering a component. */
export function PlayerBar({ duration, rate, onRest }: Props) {
  const playing = usePlayback((playback) => playback.playing);
  const speed = usePlayback((playback) => playback.speed);
  const loop = usePlayback((playback) => playback.loop);
  const scrub = useCommit((time) => onRest?.(time));
  const clock = useRef<HTMLOutputElement>(null);

  useEffect(() => {
    const show = ({ time }: { time: number }) => {
      const text = `${fixed(time, 2)} s`;
      if (scrub.current) {
        scrub.current.value = String(time);
        scrub.current.setAttribute("aria-valuetext", `${text} of ${fixed(duration, 2)} s`);
      }
      if (clock.current) clock.current.textContent = text;
    };
    show(usePlayback.getState());
    return usePlayback.subscribe(show);
  }, [duration, scrub]);

  const stop = (time: number) => {
    usePlayback.setState({ playing: false, time });
    onRest?.(time);
  };
  const toggle = () => {
    const { time } = usePlayback.getState();
    if (playing) stop(time);
    else usePlayback.setState({ playing: true, time: time >= duration ? 0 : time });
  };
  const step = (direction: 1 | -1) => stop(stepped(usePlayback.getState().time, direction, rate, duration));
  return (
    <div className="player" role="group" aria-label="Playback" data-testid="player">
      <IconButton icon="back" name="One sample back" testId="step-back" onClick={() => step(-1)} />
      <IconButton
        icon={playing ? "pause" : "play"}
        name={playing ? "Pause" : "Play"}
        testId="play"
        onClick={toggle}
      />
      <IconButton icon="forward" name="One sample forward" testId="step-forward" onClick={() => step(1)} />
      <input
        ref={scrub}
        type="range"
        aria-label="Time of the walk"
        data-testid="scrub"
        min={0}
        max={duration}
        step={1 / rate}
        defaultValue={0}
        onInput={(event) => usePlayback.setState({ playing: false, time: event.currentTarget.valueAsNumber })}
      />
      <span className="clock">
        <output ref={clock} data-testid="clock" aria-live="off" />
        <span className="total"> of {fixed(duration, 2)} s</span>
      </span>
      <select
        aria-label="Playback speed"
        data-testid="play-speed"
        value={speed}
        onChange={(event) => usePlayback.setState({ speed: Number(event.target.value) })}
      >
        {SPEEDS.map((times) => (
          <option key={times} value={times}>
            {times}×
          </option>
        ))}
      </select>
      <button
        type="button"
        className="button small wide"
        aria-pressed={loop}
        data-testid="loop"
        onClick={() => usePlayback.setState({ loop: !loop })}
      >
        Loop
      </button>
    </div>
  );
}
