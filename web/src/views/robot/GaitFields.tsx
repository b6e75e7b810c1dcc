import { Select } from "../../controls/Select";
import { useInputs } from "../useInputs";
import { withValue } from "./document";
import { DocumentField } from "./DocumentField";
import { GAIT } from "./fields";
import { setDocument } from "./setDocument";

/** Default gait, body height and swing height of the robot. */
export function GaitFields() {
  const { robot } = useInputs();
  return (
    <>
      <Select
        label="Gait"
        testId="robot-gait"
        value={robot.gait}
        options={robot.gaits.map((name) => ({ value: name, label: name }))}
        onChange={(name) => setDocument(withValue(robot.document, ["gait", "name"], name))}
      />
      {GAIT.map((field) => (
        <DocumentField key={field.label} field={field} />
      ))}
    </>
  );
}
