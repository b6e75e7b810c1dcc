import { useId } from "react";

import { Icon } from "../controls/icons";
import { NumberInput } from "../controls/NumberInput";
import type { PoseMessage } from "../protocol";
import { triple } from "../scene/kinematics";
import { change, dragFoot } from "../state/session";
import { useInputs } from "./useInputs";

/** Greatest coordinate of a foothold [mm]. */
const FAR = 5000;
const AXES = ["x", "y", "z"] as const;

/** Numeric inputs of the footholds. */
export function FeetInputs({ pose }: { pose: PoseMessage }) {
  const { robot, state } = useInputs();
  const id = useId();
  const move = (leg: number, axis: number, value: number, commit: boolean) => {
    const at: [number, number, number] = [...triple(pose.feet_mm, leg)];
    at[axis] = value;
    dragFoot(leg, at, commit);
  };
  return (
    <details>
      <summary>Footholds</summary>
      <div className="inside">
        <div className="scroll">
          <table className="inputs">
            <caption className="hidden-text">Footholds in mm</caption>
            <thead>
              <tr>
                <th scope="col">Leg</th>
                {AXES.map((axis) => (
                  <th key={axis} scope="col">
                    {axis} mm
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {robot.leg_codes.map((code, leg) => (
                <tr key={code}>
                  <th scope="row">{code}</th>
                  {AXES.map((axis, i) => (
                    <td key={axis}>
                      <NumberInput
                        id={`${id}${leg}${axis}`}
                        label={`${robot.leg_names[leg] ?? ""} foot ${axis} in mm`}
                        value={triple(pose.feet_mm, leg)[i] ?? 0}
                        step={0.5}
                        min={axis === "z" ? 0 : -FAR}
                        max={FAR}
                        testId={`foot-${code}-${axis}`}
                        onChange={(value, commit) => move(leg, i, value, commit)}
                      />
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
        <div className="row">
          <button
            type="button"
            className="button small"
            data-testid="feet-home"
            disabled={state.body.feet_mm === null}
            onClick={() => change("body", { feet_mm: null })}
          >
            <Icon name="reset" /> Default footholds
          </button>
        </div>
      </div>
    </details>
  );
}
