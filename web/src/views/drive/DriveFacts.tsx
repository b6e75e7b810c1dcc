import { Facts } from "../../controls/Facts";
import { Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { DriveFrame } from "../../protocol";
import { headingText } from "./robotState";

interface Props {
  frame: DriveFrame;
  onRestart: () => void;
}

/** Limitations of the command, interventions of the guard, and what goes wrong in physics. */
export function DriveRemarks({ frame, onRestart }: Props) {
  const problems = frame.physics?.problems ?? [];
  return (
    <div className="remarks" aria-live="polite">
      <Remarks kind="warn" items={frame.limitations} testId="drive-limitations" />
      <Remarks
        kind="bad"
        items={frame.interventions.map((text) => `Guard: ${text}`)}
        testId="drive-interventions"
      />
      <Remarks kind="bad" items={problems} testId="drive-physics" />
      {frame.physics?.fallen === true && (
        <button type="button" className="button" data-testid="drive-restart" onClick={onRestart}>
          Start anew
        </button>
      )}
    </div>
  );
}

/** The present values. */
export function DriveFacts({ frame }: { frame: DriveFrame }) {
  const { physics } = frame;
  const [x, y] = (physics ?? frame).position_mm;
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
        ...(physics
          ? ([
              ["Tilt from the commanded pose", withUnit(physics.tilt_deg, 1, "°")],
              ["Distance from the commanded place", withUnit(physics.deviation_mm, 0, "mm")],
            ] as const)
          : []),
      ]}
    />
  );
}
