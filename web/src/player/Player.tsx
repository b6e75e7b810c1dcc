import { useEffect, useMemo, useState } from "react";

import { CameraBar } from "../app/CameraBar";
import { PlayerBar } from "../app/PlayerBar";
import { StatusChips } from "../app/StatusChips";
import { toggleTheme, usePalette, useTheme } from "../app/theme";
import { IconButton } from "../controls/IconButton";
import { fixed } from "../controls/numbers";
import type { PlayerData } from "../protocol";
import type { CameraName, Place } from "../scene/cameras";
import { frameOfWalk } from "../scene/frames";
import { footTrails, lengthOf } from "../scene/trails";
import { shapeOf } from "../scene/kinematics";
import { legColours } from "../scene/palette";
import { framing } from "../scene/framing";
import { ForceLegend } from "../scene/ForceLegend";
import { SceneCanvas } from "../scene/SceneCanvas";
import { prefersReducedMotion, stage } from "../scene/stage";
import { playWalk } from "../scene/walking";
import { usePlayback } from "../state/playback";

/** Playback of a walk without a server, with the 3D view of the studio. */
export function Player({ data }: { data: PlayerData }) {
  const { robot, walk, loads } = data;
  const theme = useTheme((state) => state.theme);
  const palette = usePalette();
  const [camera, setCamera] = useState<CameraName>("free");
  const [place, setPlace] = useState<Place | null>(null);
  const [again, setAgain] = useState(0);
  const [forces, setForces] = useState(false);
  const shape = useMemo(() => shapeOf(robot), [robot]);
  const colours = useMemo(() => legColours(shape.mounts), [shape]);
  const trails = useMemo(() => footTrails(robot, walk), [robot, walk]);
  const view = useMemo(
    () => framing(robot, camera === "follow" ? null : walk),
    // Choosing the active camera again resets its position.
    // eslint-disable-next-line react-hooks/exhaustive-deps
    [robot, walk, camera === "follow", again],
  );
  useEffect(() => {
    stage.show(frameOfWalk(robot, walk, loads, 0), false);
    usePlayback.setState({ playing: !prefersReducedMotion() });
    return playWalk(robot, walk, loads);
  }, [robot, walk, loads]);

  return (
    <div className="player-page">
      <header>
        <h1>{robot.name}</h1>
        <p>
          {walk.gait}, {fixed(walk.speed_mm_s, 0)} mm/s, stroke {fixed(walk.stroke_mm, 0)} mm,{" "}
          {fixed(walk.duration_s, 1)} s
        </p>
        <span className="spring" />
        {loads && (
          <button
            type="button"
            className="button small"
            aria-pressed={forces}
            data-testid="forces"
            onClick={() => setForces(!forces)}
          >
            Forces and torques
          </button>
        )}
        <IconButton
          icon={theme === "dark" ? "sun" : "moon"}
          name={theme === "dark" ? "Light colours" : "Dark colours"}
          testId="theme"
          onClick={toggleTheme}
        />
      </header>
      <main className="picture" aria-label="Picture">
        <SceneCanvas
          shape={shape}
          colours={colours}
          palette={palette}
          camera={camera}
          view={view}
          trails={trails}
          forces={forces}
          torques={forces}
          description="The robot walking."
          place={place}
          onRest={(rested, turned) => {
            setPlace(rested);
            if (turned) setCamera("free");
          }}
        />
        <div className="corner">
          <StatusChips />
          {forces && <ForceLegend />}
        </div>
        <CameraBar
          camera={camera}
          onChoose={(name) => {
            setAgain(again + 1);
            setCamera(name);
            setPlace(null);
          }}
        />

        <PlayerBar duration={lengthOf(walk)} rate={walk.rate_hz} />
      </main>
    </div>
  );
}
