import { Facts } from "../../controls/Facts";
import { Message, Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { SimulatedMessage } from "../../protocol";

/** What physics makes of the walk. */
export function SimulatedSummary({ simulated }: { simulated: SimulatedMessage }) {
  const percent = (ratio: number | null) =>
    ratio === null ? "–" : `${(100 * ratio).toFixed(1)} % of the plan`;
  const most = Math.max(...simulated.tilt_deg);
  return (
    <>
      <Message kind={simulated.ok ? "good" : "bad"} testId="simulated-verdict">
        In physics: {simulated.verdict}.
      </Message>
      <Remarks kind={simulated.ok ? "warn" : "bad"} items={simulated.problems} testId="simulated-problems" />
      <Facts
        testId="simulated-facts"
        rows={[
          ["Way in physics", percent(simulated.way_ratio)],
          ["Turn in physics", percent(simulated.turn_ratio)],
          ["Maximum deviation", withUnit(simulated.deviation_mm, 1, "mm")],
          ["Maximum tilt", withUnit(most, 1, "°")],
          ["Sag of the body", withUnit(simulated.sag_mm, 1, "mm")],
          ["Slip of a foot, mean", withUnit(simulated.slip_mm, 1, "mm")],
          ...simulated.joints.map(
            (joint) =>
              [
                `Peak torque of ${joint.joint}`,
                `${withUnit(joint.peak_nm, 2, "N m")}${joint.planned_peak_nm === null ? "" : ` (statics ${joint.planned_peak_nm.toFixed(2)})`}`,
              ] as const,
          ),
          ["Energy", withUnit(simulated.energy_j, 1, "J")],
        ]}
      />
      <details>
        <summary>Assumptions of physics</summary>
        <div className="inside">
          <ul>
            {simulated.assumed.map((line) => (
              <li key={line}>{line}</li>
            ))}
          </ul>
        </div>
      </details>
    </>
  );
}
