import type { ReactNode } from "react";

import { useStudio, type View } from "../state/store";
import { BodyView } from "./BodyView";
import { DriveView } from "./drive/DriveView";
import { JointsView } from "./JointsView";
import { LoadsView } from "./loads/LoadsView";
import { RobotView } from "./robot/RobotView";
import { SourcesView } from "./sources/SourcesView";
import { WalkView } from "./walk/WalkView";

const VIEWS: Record<View, () => ReactNode> = {
  joints: JointsView,
  body: BodyView,
  walk: WalkView,
  drive: DriveView,
  loads: LoadsView,
  robot: RobotView,
  sources: SourcesView,
};

/** The panel beside the 3D view: inputs and values of the view. */
export function ViewPanel({ view }: { view: View }) {
  const ready = useStudio((studio) => studio.robot !== null && studio.state !== null);
  const link = useStudio((studio) => studio.link);
  const Chosen = VIEWS[view];
  if (ready) return <Chosen />;
  return (
    <div className="view">
      <p className="hint" role="status">
        {link.kind === "refused" ? link.text : "Connecting to the server …"}
      </p>
    </div>
  );
}
