import { useEffect } from "react";

import { Select } from "../controls/Select";
import { withUnit } from "../controls/numbers";
import { ask, look } from "../state/session";
import { useStudio } from "../state/store";
import { useInputs } from "./useInputs";

/** Choose the leg whose reachable zone is drawn. */
export function ZoneChoice() {
  const { robot, state } = useInputs();
  const zone = useStudio((studio) => studio.zone);
  const pose = useStudio((studio) => studio.poses[state.view]);
  const { leg } = state.picture;
  // The zone depends on how the body stands.
  useEffect(() => {
    if (leg !== null && leg < robot.leg_names.length) ask({ type: "zone", leg });
  }, [leg, pose, robot]);
  const shown = zone?.leg === leg ? zone : null;
  return (
    <div className="field">
      <Select
        label="Show what a leg can reach"
        testId="zone-leg"
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
        <p className="hint" data-testid="zone-text">
          {shown.farthest_mm === null
            ? "With the body as it is, this leg reaches nothing on the ground."
            : `Straight out on the ground: ${withUnit(shown.nearest_mm, 0, "")} to ${withUnit(shown.farthest_mm, 0, "mm")} from its coxa axis.`}
        </p>
      )}
    </div>
  );
}
