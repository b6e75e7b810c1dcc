import type { DriveFrame } from "../protocol";
import { frameOfDrive } from "../scene/frames";
import { stage } from "../scene/stage";
import { useStudio } from "./store";

/** Interval at which texts and numbers are updated while driving [ms]. */
const PANEL_INTERVAL = 120;
let shownAt = 0;

/** Show a frame of the driven robot: the 3D view for every frame, the panel at a lower rate. */
export function showDriveFrame(frame: DriveFrame): void {
  const { robot, state } = useStudio.getState();
  if (!robot || state?.view !== "drive") return;
  stage.show(frameOfDrive(robot, frame));
  const now = performance.now();
  if (now - shownAt < PANEL_INTERVAL) return;
  shownAt = now;
  useStudio.setState({ drive: frame });
}
