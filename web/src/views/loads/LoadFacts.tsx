import { Facts } from "../../controls/Facts";
import { withUnit } from "../../controls/numbers";
import type { LoadsMessage } from "../../protocol";

/** Energy, current, and assumptions. */
export function LoadFacts({ loads }: { loads: LoadsMessage }) {
  return (
    <>
      <Facts
        testId="load-facts"
        rows={[
          ["Weight", withUnit(loads.weight_n, 1, "N")],
          ["Energy", withUnit(loads.energy_j, 1, "J")],
          ["Cost of transport", withUnit(loads.cost_of_transport, 2, "")],
          ["Peak current", withUnit(loads.peak_current_a, 1, "A")],
          ["Mean current", withUnit(loads.mean_current_a, 1, "A")],
          ["Battery life", withUnit(loads.battery_min, 0, "min")],
        ]}
      />
      <details>
        <summary>Assumptions</summary>
        <div className="inside">
          <ul>
            {loads.assumed.map((line) => (
              <li key={line}>{line}</li>
            ))}
          </ul>
        </div>
      </details>
    </>
  );
}
