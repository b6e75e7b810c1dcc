import { Facts } from "../../controls/Facts";
import { Message, Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { DriveFrame, FrameMachine } from "../../protocol";
import { ask } from "../../state/session";

/** The machine that is driven: its servos, what they measure, and the end of its run. */
export function RunPart({ bus, frame }: { bus: string; frame: DriveFrame | null }) {
  const machine = frame?.machine ?? null;
  return (
    <fieldset>
      <legend>Machine</legend>
      <p className="hint">
        Servos: <span data-testid="run-bus">{bus}</span>. Solid: measured joint angles. Translucent: as
        commanded.
      </p>
      <div className="remarks" aria-live="polite">
        {machine?.stopped && (
          <Message kind="warn" testId="run-stopped">
            The robot was stopped, as nothing was heard of this page.
          </Message>
        )}
        <Remarks kind="bad" items={machine?.problems ?? []} testId="run-problems" />
      </div>
      {machine && <MachineFacts machine={machine} />}
      <div className="row">
        <button
          type="button"
          className="button"
          data-testid="end-run"
          onClick={() => ask({ type: "end_run" })}
        >
          Stop, sit down and end the run
        </button>
      </div>
    </fieldset>
  );
}

function MachineFacts({ machine }: { machine: FrameMachine }) {
  const of = (joint: string | null) => (joint === null ? "" : ` (${joint})`);
  return (
    <Facts
      testId="machine-facts"
      rows={[
        ["Farthest behind", withUnit(machine.behind_deg, 1, "°") + of(machine.behind_joint)],
        ["Supply", withUnit(machine.voltage_v, 1, "V")],
        ["Warmest servo", withUnit(machine.temperature_c, 0, "°C") + of(machine.temperature_joint)],
        ["Ticks", `${withUnit(machine.rate_hz, 1, "Hz")}, ${machine.missed} missed`],
      ]}
    />
  );
}
