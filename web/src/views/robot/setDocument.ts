import type { RobotFile } from "../../protocol";
import { changedKey } from "../../state/edited";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";

/** Change the robot file: the inputs show it immediately, the 3D view after the server has checked it. */
export function setDocument(document: RobotFile, commit = true): void {
  const { robot } = useStudio.getState();
  if (!robot) return;
  useStudio.setState((studio) => ({
    robot: { ...robot, document },
    edited: { ...studio.edited, document: changedKey(robot.document, document) ?? studio.edited.document },
  }));
  ask({ type: "document", document, commit });
}
