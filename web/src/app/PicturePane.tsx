import { useMemo, useState } from "react";

import { legColours } from "../scene/palette";
import type { CameraName, Place } from "../scene/cameras";
import { footTrails, lengthOf } from "../scene/trails";
import { shapeOf } from "../scene/kinematics";
import { ForceLegend } from "../scene/ForceLegend";
import { SceneCanvas } from "../scene/SceneCanvas";
import { useOptions } from "../state/options";
import { look } from "../state/session";
import { useStudio, type View } from "../state/store";
import { useInPhysics, useTerrain } from "../views/physics/usePhysics";
import { CameraBar } from "./CameraBar";
import { PlayerBar } from "./PlayerBar";
import { SceneExtras } from "./SceneExtras";
import { StatusChips } from "./StatusChips";
import { usePalette } from "./theme";
import { useFraming, WALKING } from "./useFraming";
import { useFloor } from "./useFloor";
import { useShown } from "./useShown";

const DESCRIPTIONS: Record<View, string> = {
  joints: "The robot at rest with these joint angles.",
  body: "The robot with its body moved relative to its feet.",
  walk: "The robot on its planned walk.",
  drive: "The robot while it is driven.",
  loads: "The robot on its planned walk, with forces and torques.",
  robot: "The robot as its file describes it.",
  sources: "The robot whose values are used in the equations.",
};

const RUNNING = "The robot that runs, with measured joint angles; as commanded, it is translucent.";
const PHYSICAL = "The robot in physics on its terrain, with the plan as a translucent robot.";

/** The 3D view, shared by all views, with its overlays. */
export function PicturePane({ view }: { view: View }) {
  const robot = useStudio((studio) => studio.robot);
  const picture = useStudio((studio) => studio.state?.picture ?? null);
  const walk = useStudio((studio) => studio.walk);
  const palette = usePalette();
  const [again, setAgain] = useState(0);
  const camera: CameraName = picture?.camera ?? "free";
  const framing = useFraming(view, camera === "follow", again);
  const onFloor = useFloor(view);
  useShown(view);

  const shape = useMemo(() => (robot ? shapeOf(robot) : null), [robot]);
  const colours = useMemo(() => (shape ? legColours(shape.mounts) : []), [shape]);
  const walking = WALKING.has(view);
  const forces = useOptions((options) => options.forces);
  const physical = useInPhysics(view);
  const terrain = useTerrain(view);
  const runs = useStudio((studio) => studio.welcome?.run != null);
  const simulated = useStudio((studio) => (physical && view === "walk" ? studio.simulated : null));
  const loaded = view === "loads" || (forces && (view === "joints" || view === "body"));
  const trails = useMemo(
    () => (walking && robot && walk ? footTrails(robot, simulated ?? walk) : undefined),
    [walking, robot, walk, simulated],
  );
  if (!shape || !picture) return <Waiting />;
  const place =
    picture.eye_mm && picture.target_mm ? { eye: picture.eye_mm, target: picture.target_mm } : null;
  return (
    <>
      <SceneCanvas
        shape={shape}
        colours={colours}
        palette={palette}
        camera={camera}
        view={framing}
        place={place}
        trails={trails}
        forces={loaded || physical}
        torques={loaded}
        ground={terrain?.level ?? true}
        driven={view === "drive"}
        description={runs ? RUNNING : physical ? PHYSICAL : DESCRIPTIONS[view]}
        onFloor={onFloor}
        onRest={keepPlace}
      >
        <SceneExtras view={view} shape={shape} palette={palette} colours={colours} />
      </SceneCanvas>
      <div className="corner">
        <StatusChips />
        {loaded && <ForceLegend />}
      </div>
      <CameraBar
        camera={camera}
        onChoose={(name) => {
          setAgain(again + 1);
          look(null, { camera: name, eye_mm: null, target_mm: null });
        }}
      />
      {walking && walk && (
        <PlayerBar
          duration={lengthOf(walk)}
          rate={walk.rate_hz}
          onRest={(time) => look(null, { time_s: time })}
        />
      )}
    </>
  );
}

/** Store the position of the camera; a camera that the user has turned becomes the free one. */
function keepPlace({ eye, target }: Place, turned: boolean) {
  look(null, { eye_mm: [...eye], target_mm: [...target], ...(turned ? { camera: "free" } : {}) });
}

function Waiting() {
  const link = useStudio((studio) => studio.link);
  return (
    <p className="no-picture">
      {link.kind === "connecting" || link.kind === "open" ? "Loading the robot …" : ""}
    </p>
  );
}
