import type { RobotFile } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";

/** Change the robot file: the inputs show it immediately, the 3D view after the server has checked it. */
export function setDocument(document: RobotFile, commit = true): void {
  const { robot } = useStudio.getState();
  if (!robot) return;
  useStudio.setState({ robot: { ...robot, document } });
  ask({ type: "document", document, commit });
}
