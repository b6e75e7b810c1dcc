import { Failure } from "../../controls/Failure";
import { Icon } from "../../controls/icons";
import { ask, change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { GaitChoice } from "./GaitChoice";
import { GaitDiagram } from "./GaitDiagram";
import { PathInputs } from "./PathInputs";
import { StepInputs } from "./StepInputs";
import { WalkAngles } from "./WalkAngles";
import { WalkPlots } from "./WalkPlots";
import { WalkSummary } from "./WalkSummary";

/** Plan a walk and play it. */
export function WalkView() {
  const { state } = useInputs();
  const walk = useStudio((studio) => studio.walk);
  const failure = useStudio((studio) => studio.failures.walk);
  const busy = useStudio((studio) => studio.busy.walk === true);
  const longest = failure?.longest_stroke_mm ?? null;
  return (
    <div className="view">
      <ViewHead title="Walk">Plan a complete walk, which is then played back in the browser.</ViewHead>
      <Failure of={["walk"]}>
        <div className="row">
          {longest !== null && (
            <button
              type="button"
              className="button small"
              onClick={() => change("walk", { stroke_mm: Math.floor(longest * 10) / 10 })}
            >
              Use {Math.floor(longest * 10) / 10} mm
            </button>
          )}
          <button type="button" className="button small" onClick={() => change("walk", { strict: false })}>
            Show it anyway
          </button>
        </div>
      </Failure>
      <GaitChoice />
      <PathInputs />
      <StepInputs />
      <p className="busy" aria-live="polite">
        {busy ? "Planning …" : " "}
      </p>
      {walk && <WalkSummary walk={walk} />}
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
