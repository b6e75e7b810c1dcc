import { Failure } from "../../controls/Failure";
import { Select } from "../../controls/Select";
import type { SourceMessage, StudioState } from "../../protocol";
import { change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { ErratumCard } from "./ErratumCard";
import { EquationCard } from "./EquationCard";
import { Givens } from "./Givens";

type DocumentNumber = StudioState["source"]["number"];

const DOCUMENTS: readonly { value: DocumentNumber; label: string }[] = [
  { value: "000", label: "000 – leg inverse kinematics" },
  { value: "001", label: "001 – offset femur axis, walks, tilt" },
  { value: "002", label: "002 – forward and inverse kinematics" },
  { value: "003", label: "003 – leg and body inverse kinematics" },
  { value: "004", label: "004 – torques and inverse kinematics" },
];

/** Equations of the source documents, with the values of this robot and pose. */
export function SourcesView() {
  const { robot, state } = useInputs();
  const source = useStudio((studio) => studio.source);
  const { number, leg } = state.source;
  const shown = source?.number === number ? source : null;
  return (
    <div className="view">
      <ViewHead title="Sources">
        Equations of the source documents, with the values of this robot in the pose of the view Body.
      </ViewHead>
      <Select
        label="Document"
        testId="source-number"
        value={number}
        options={DOCUMENTS}
        onChange={(value) => change("source", { number: value as DocumentNumber })}
      />
      <Select
        label="Leg"
        testId="source-leg"
        value={String(leg)}
        options={robot.leg_names.map((name, i) => ({
          value: String(i),
          label: `${robot.leg_codes[i] ?? ""} – ${name}`,
        }))}
        onChange={(value) => change("source", { leg: Number(value) })}
      />
      <Failure of={["source"]} />
      {shown && <Document source={shown} />}
    </div>
  );
}

function Document({ source }: { source: SourceMessage }) {
  return (
    <article className="source" data-testid="source">
      <h3>{source.title}</h3>
      <p className="hint">{source.about}</p>
      <Givens equations={source.equations.filter(({ formula }) => formula === null)} />
      <ol className="equations">
        {source.equations
          .filter(({ formula }) => formula !== null)
          .map((equation) => (
            <li key={equation.key}>
              <EquationCard equation={equation} />
            </li>
          ))}
      </ol>
      {source.errata.length > 0 && (
        <>
          <h3>Errata</h3>
          <ul className="equations">
            {source.errata.map((erratum) => (
              <li key={erratum.printed}>
                <ErratumCard erratum={erratum} />
              </li>
            ))}
          </ul>
        </>
      )}
    </article>
  );
}
