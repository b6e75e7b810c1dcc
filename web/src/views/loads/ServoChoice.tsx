import { Failure } from "../../controls/Failure";
import { Message, Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { Candidate, ServosMessage } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio } from "../../state/store";
import { withServos } from "../robot/document";
import { setDocument } from "../robot/setDocument";
import { useInputs } from "../useInputs";

/** Servo sizing; on request, as it takes a second or two. */
export function ServoChoice() {
  const servos = useStudio((studio) => studio.servos);
  const busy = useStudio((studio) => studio.busy.servos === true);
  return (
    <fieldset>
      <legend>Servo sizing</legend>
      <div className="row">
        <button
          type="button"
          className="button primary"
          data-testid="size-servos"
          disabled={busy}
          onClick={() => ask({ type: "servos" })}
        >
          {busy ? "Evaluating all servos …" : "Find sufficient servos"}
        </button>
      </div>
      <Failure of={["servos"]} />
      {servos && <Answer servos={servos} />}
    </fieldset>
  );
}

function Answer({ servos }: { servos: ServosMessage }) {
  const all = [...servos.candidates, ...(servos.mixed ? [servos.mixed] : [])];
  const leftOut = Object.entries(servos.left_out);
  return (
    <div className="field" data-testid="servo-answer">
      <Message kind={servos.sufficient ? "good" : "bad"}>
        {servos.sufficient ? "The present servos are sufficient." : "The present servos are not sufficient."}
      </Message>
      {servos.payload_kg !== null && (
        <p className="hint">
          Maximum payload: {withUnit(servos.payload_kg, 2, "kg")}
          {servos.maximum_payload_kg !== null &&
            `; ${withUnit(servos.maximum_payload_kg, 2, "kg")} at safety factor 1.5, below which servos stall or burn`}
          .
        </p>
      )}
      {all.length > 0 ? (
        <Candidates all={all} />
      ) : (
        <Remarks kind="warn" items={["No servo in the catalogue is sufficient."]} />
      )}
      {servos.advice.length > 0 && (
        <details>
          <summary>How to reduce the loads</summary>
          <div className="inside">
            <ul>
              {servos.advice.map((line) => (
                <li key={line}>{line}</li>
              ))}
            </ul>
          </div>
        </details>
      )}
      {leftOut.length > 0 && (
        <p className="hint">Not tried: {leftOut.map(([name, why]) => `${name} (${why})`).join(", ")}.</p>
      )}
    </div>
  );
}

function Candidates({ all }: { all: readonly Candidate[] }) {
  const { robot } = useInputs();
  return (
    <div className="scroll">
      <table>
        <caption className="hidden-text">Sufficient servos, lightest first</caption>
        <thead>
          <tr>
            <th scope="col">Servo</th>
            <th scope="col">Safety factor</th>
            <th scope="col">Mass of robot</th>
            <th scope="col">
              <span className="hidden-text">Choice</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {all.map((one) => (
            <tr key={one.name}>
              <td className="wrap">
                {one.coxa === one.femur && one.femur === one.tibia ? one.coxa : mixedName(one)}
              </td>
              <td>{withUnit(one.factor, 2, "×")}</td>
              <td>{withUnit(one.robot_mass_kg, 2, "kg")}</td>
              <td>
                <button
                  type="button"
                  className="button small"
                  aria-label={`Use ${one.name}`}
                  onClick={() => setDocument(withServos(robot.document, one.coxa, one.femur, one.tibia))}
                >
                  Use
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function mixedName({ coxa, femur, tibia }: Candidate): string {
  return `coxa ${coxa}, femur ${femur}, tibia ${tibia}`;
}
