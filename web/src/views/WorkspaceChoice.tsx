import { useEffect } from "react";

import { Select } from "../controls/Select";
import { withUnit } from "../controls/numbers";
import { ask, look } from "../state/session";
import { useStudio } from "../state/store";
import { useInputs } from "./useInputs";

/** Choice of the leg whose workspace is shown. */
export function WorkspaceChoice() {
  const { robot, state } = useInputs();
  const workspace = useStudio((studio) => studio.workspace);
  const pose = useStudio((studio) => studio.poses[state.view]);
  const { leg } = state.picture;
  // The workspace depends on the body pose.
  useEffect(() => {
    if (leg !== null && leg < robot.leg_names.length) ask({ type: "workspace", leg });
  }, [leg, pose, robot]);
  const shown = workspace?.leg === leg ? workspace : null;
  return (
    <div className="field">
      <Select
        label="Show workspace of leg"
        testId="workspace-leg"
        value={leg === null ? "" : String(leg)}
        options={[
          { value: "", label: "none" },
          ...robot.leg_names.map((name, i) => ({
            value: String(i),
            label: `${robot.leg_codes[i] ?? ""} – ${name}`,
          })),
        ]}
        onChange={(value) => look(null, { leg: value === "" ? null : Number(value) })}
      />
      {shown && (
        <p className="hint" data-testid="workspace-text">
          {shown.farthest_mm === null
            ? "With this body pose, the leg reaches no point on the ground."
            : `On the ground, straight outward: ${withUnit(shown.nearest_mm, 0, "")} to ${withUnit(shown.farthest_mm, 0, "mm")} from its coxa axis.`}
        </p>
      )}
    </div>
  );
}
