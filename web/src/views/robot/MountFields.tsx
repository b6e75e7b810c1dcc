import { useState } from "react";

import { Select } from "../../controls/Select";
import { useInputs } from "../useInputs";
import { DocumentField } from "./DocumentField";
import { mountFields, ownFields } from "./fields";

/** Entry of one leg in the file: its mount, and values that differ from the other legs. */
export function MountFields() {
  const { robot } = useInputs();
  const [chosen, setChosen] = useState(0);
  const leg = Math.min(chosen, robot.leg_names.length - 1);
  return (
    <>
      <Select
        label="Leg"
        testId="mount-leg"
        value={String(leg)}
        options={robot.leg_names.map((name, i) => ({
          value: String(i),
          label: `${robot.leg_codes[i] ?? ""} – ${name}`,
        }))}
        onChange={(value) => setChosen(Number(value))}
      />
      {[...mountFields(leg), ...ownFields(leg)].map((field) => (
        <DocumentField key={`${leg} ${field.label}`} field={field} />
      ))}
    </>
  );
}
