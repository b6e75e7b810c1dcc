import { Centre } from "../scene/Centre";
import type { Shape } from "../scene/frame";
import { Ghost } from "../scene/Ghost";
import { Handles } from "../scene/Handles";
import { LiveTrails } from "../scene/LiveTrails";
import type { Palette } from "../scene/palette";
import { TerrainModel } from "../scene/TerrainModel";
import { Workspace } from "../scene/Workspace";
import { useStudio, type View } from "../state/store";
import { useInPhysics, useTerrain } from "../views/physics/usePhysics";
import { dragged } from "./drag";

interface Props {
  view: View;
  shape: Shape;
  palette: Palette;
  colours: readonly string[];
}

/** Parts of the scene that only some views show: handles, a leg's workspace, a curve's centre. */
export function SceneExtras({ view, shape, palette, colours }: Props) {
  const leg = useStudio((studio) => studio.state?.picture.leg ?? null);
  const workspace = useStudio((studio) => studio.workspace);
  const path = useStudio((studio) => studio.state?.walk.path);
  const physical = useInPhysics(view);
  const terrain = useTerrain(view);
  const runs = useStudio((studio) => studio.welcome?.run != null);
  const posing = view === "joints" || view === "body";
  return (
    <>
      {posing && <Handles shape={shape} palette={palette} body={view === "body"} onDrag={dragged} />}
      {posing && workspace?.leg === leg && (
        <Workspace ground={workspace.ground_mm} plane={workspace.plane_mm} palette={palette} />
      )}
      {terrain && <TerrainModel terrain={terrain} palette={palette} />}
      {(physical || runs) && <Ghost shape={shape} palette={palette} />}
      {view === "drive" && <LiveTrails colours={colours} />}
      {view === "walk" && path?.kind === "curve" && <Centre at={path.centre_mm} palette={palette} />}
    </>
  );
}
