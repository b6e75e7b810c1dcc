import type { RobotMessage, StudioState } from "../protocol";
import { useStudio } from "../state/store";

/** Robot and inputs, in views that are shown only when both are known. */
export function useInputs(): { robot: RobotMessage; state: StudioState } {
  const robot = useStudio((studio) => studio.robot);
  const state = useStudio((studio) => studio.state);
  if (!robot || !state) throw new Error("a view is shown before robot and state are known");
  return { robot, state };
}
