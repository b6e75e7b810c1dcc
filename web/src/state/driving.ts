import type { DriveFrame } from "../protocol";
import { frameOfDrive } from "../scene/frames";
import { stage } from "../scene/stage";
import { useStudio } from "./store";

/** How often words and numbers change while driving [ms]. */
const WORDS = 120;
let told = 0;

/** Show a frame of the live walker: the picture at once, the numbers a few times a second. */
export function showDriveFrame(frame: DriveFrame): void {
  const { robot, state } = useStudio.getState();
  if (!robot || state?.view !== "drive") return;
  stage.show(frameOfDrive(robot, frame));
  const now = performance.now();
  if (now - told < WORDS) return;
  told = now;
  useStudio.setState({ drive: frame });
}
