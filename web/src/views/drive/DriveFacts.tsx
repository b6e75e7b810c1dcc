import { Facts } from "../../controls/Facts";
import { Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { DriveFrame } from "../../protocol";
import { headingText } from "./robotState";

/** Limitations of the command, and interventions of the guard. */
export function DriveRemarks({ frame }: { frame: DriveFrame }) {
  return (
    <div className="remarks" aria-live="polite">
      <Remarks kind="warn" items={frame.limitations} testId="drive-limitations" />
      <Remarks
        kind="bad"
        items={frame.interventions.map((text) => `Guard: ${text}`)}
        testId="drive-interventions"
      />
    </div>
  );
}

/** The present values. */
export function DriveFacts({ frame }: { frame: DriveFrame }) {
  const [x, y] = frame.position_mm;
  return (
    <Facts
      testId="drive-facts"
      rows={[
        ["Heading", headingText(frame.heading_deg)],
        ["Position x, y", `${withUnit(x, 0, "")}, ${withUnit(y, 0, "mm")}`],
        ["Forward speed", withUnit(frame.twist[0], 0, "mm/s")],
        ["Left speed", withUnit(frame.twist[1], 0, "mm/s")],
        ["Left turn rate", withUnit(frame.twist[2], 1, "°/s")],
        ["Gait", frame.gait],
        ["Stability margin", frame.belly ? "body on the ground" : withUnit(frame.margin_mm, 0, "mm")],
        ["Guard interventions", frame.intervention_count],
      ]}
    />
  );
}
