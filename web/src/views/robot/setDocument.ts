import type { RobotFile } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";

/** Take a robot by the keys of its file: shown in the inputs at once, drawn when the server has checked it. */
export function setDocument(document: RobotFile, commit = true): void {
  const { robot } = useStudio.getState();
  if (!robot) return;
  useStudio.setState({ robot: { ...robot, document } });
  ask({ type: "document", document, commit });
}
