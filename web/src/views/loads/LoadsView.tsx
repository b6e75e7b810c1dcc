import { Failure } from "../../controls/Failure";
import { Message, Remarks } from "../../controls/Message";
import { unbroken } from "../../controls/numbers";
import type { LoadsMessage } from "../../protocol";
import { useStudio } from "../../state/store";
import { ViewHead } from "../ViewHead";
import { LoadFacts } from "./LoadFacts";
import { LoadInputs } from "./LoadInputs";
import { ServoChoice } from "./ServoChoice";
import { TorqueGrid } from "./TorqueGrid";
import { TorquePlots } from "./TorquePlots";
import { severityOf } from "./severity";

/** Joint torques of the walk, and whether the servos provide them. */
export function LoadsView() {
  const loads = useStudio((studio) => studio.loads);
  const busy = useStudio((studio) => studio.busy.loads === true || studio.busy.view === true);
  return (
    <div className="view">
      <ViewHead title="Loads">
        Joint torques of the walk, from the contact forces at the feet, which the arrows show.
      </ViewHead>
      <Failure of={["walk", "loads"]} />
      {loads ? <Verdict loads={loads} /> : <p className="busy">{busy ? "Computing torques …" : ""}</p>}
      {loads && <TorqueGrid loads={loads} />}
      {loads && <TorquePlots loads={loads} />}
      <LoadInputs />
      <ServoChoice />
      {loads && <LoadFacts loads={loads} />}
    </div>
  );
}

function Verdict({ loads }: { loads: LoadsMessage }) {
  const kind = severityOf(loads.grade);
  return (
    <>
      <Message kind={kind} testId="loads-verdict">
        <b>{loads.grade}</b>
        <ul>
          {loads.worst.map((joint) => (
            <li key={joint}>
              {joint}: {unbroken(textOf(loads, joint))}
            </li>
          ))}
        </ul>
      </Message>
      <Remarks kind="warn" items={loads.supply_warning === null ? [] : [unbroken(loads.supply_warning)]} />
      {!loads.balanced && (
        <Remarks
          kind="warn"
          items={["At some times the robot tips: vertical contact forces can’t balance it."]}
        />
      )}
    </>
  );
}

/** Verdict on a joint with a name such as "LM femur". */
function textOf(loads: LoadsMessage, joint: string): string {
  return loads.joints.find((one) => `${one.leg} ${one.joint}` === joint)?.text ?? "";
}
