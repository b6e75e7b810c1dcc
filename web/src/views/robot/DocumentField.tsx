import { useId } from "react";

import { Refusal } from "../../controls/Failure";
import { NumberInput } from "../../controls/NumberInput";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { numberAt, pathText, withoutKey, withValue } from "./document";
import type { NumberField } from "./fields";
import { setDocument } from "./setDocument";
import { SourceMark } from "./SourceMark";

/** A value of the robot file, with unit, confidence and errors. */
export function DocumentField({ field }: { field: NumberField }) {
  const { robot } = useInputs();
  const id = useId();
  const problem = useProblem(field);
  return (
    <div className="doc-field">
      <label htmlFor={id}>
        {field.label} <SourceMark path={field.path} />
      </label>
      <span className="number">
        <NumberInput
          id={id}
          value={numberAt(robot.document, field.path)}
          exact
          step={field.step}
          min={field.min}
          placeholder="not given"
          describedBy={problem ? `${id}p` : undefined}
          testId={`doc-${pathText(field.path)}`}
          onChange={(value, commit) =>
            setDocument(withValue(robot.document, field.path, value, field.list), commit)
          }
          onEmpty={() => setDocument(withoutKey(robot.document, field.path))}
        />
        <span className="unit">{field.unit}</span>
      </span>
      <Refusal of="document" at={pathText(field.path)} />
      {problem && (
        <p id={`${id}p`} className="field-problem">
          ⚠ {problem}
        </p>
      )}
    </div>
  );
}

/** Error of the server for the key of a field. */
function useProblem({ path }: NumberField): string | null {
  const problems = useStudio((studio) => studio.failures.document?.problems);
  const text = pathText(path);
  const changed = useStudio((studio) => studio.edited.document);
  // Beside the field that was changed last stands the whole refusal.
  if (changed === text) return null;
  const problem = problems?.find(({ key }) => key !== null && (key === text || text.startsWith(`${key}[`)));
  return problem?.text ?? null;
}
