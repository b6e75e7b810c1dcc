import { Failure } from "../../controls/Failure";
import { Icon } from "../../controls/icons";
import { ask, change } from "../../state/session";
import { useStudio } from "../../state/store";
import { PhysicsFields } from "../physics/PhysicsFields";
import { SimulatedSummary } from "../physics/SimulatedSummary";
import { useInPhysics } from "../physics/usePhysics";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { GaitChoice } from "./GaitChoice";
import { GaitDiagram } from "./GaitDiagram";
import { PathInputs } from "./PathInputs";
import { StepInputs } from "./StepInputs";
import { WalkAngles } from "./WalkAngles";
import { WalkPlots } from "./WalkPlots";
import { WalkRemedies } from "./WalkRemedies";
import { WalkSummary } from "./WalkSummary";

/** Plan a walk and play it. */
export function WalkView() {
  const { state } = useInputs();
  const walk = useStudio((studio) => studio.walk);
  const refused = useStudio((studio) => studio.failures.walk !== undefined);
  const busy = useStudio((studio) => studio.busy.walk === true);
  const simulating = useStudio((studio) => studio.busy.simulate === true);
  const physical = useInPhysics("walk");
  const simulated = useStudio((studio) => studio.simulated);
  return (
    <div className="view">
      <ViewHead title="Walk">Plan a walk and play it back.</ViewHead>
      <Failure of={["walk"]}>
        <WalkRemedies />
      </Failure>
      <PhysicsFields />
      <GaitChoice />
      <PathInputs />
      <StepInputs />
      <p className="busy" aria-live="polite">
        {busy ? "Planning …" : simulating ? "Simulating …" : " "}
      </p>
      {physical && simulated && <SimulatedSummary simulated={simulated} />}
      {walk && <WalkSummary walk={walk} refused={refused} />}
      {walk && <GaitDiagram walk={walk} />}
      {walk && <WalkPlots walk={walk} />}
      <fieldset>
        <legend>Export</legend>
        <div className="row">
          {(["csv", "html"] as const).map((what) => (
            <button
              key={what}
              type="button"
              className="button"
              data-testid={`download-${what}`}
              disabled={!walk}
              onClick={() => ask({ type: "download", what })}
            >
              <Icon name="save" /> {what === "csv" ? "CSV table" : "HTML page with playback"}
            </button>
          ))}
        </div>
      </fieldset>
      {walk && <WalkAngles walk={walk} />}
      {!state.walk.strict && (
        <div className="row">
          <button type="button" className="button small" onClick={() => change("walk", { strict: true })}>
            Reject impossible walks
          </button>
        </div>
      )}
    </div>
  );
}
