import { Select } from "../../controls/Select";
import { withUnit } from "../../controls/numbers";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { withServos } from "./document";
import { setDocument } from "./setDocument";
import { JOINTS } from "../angleText";

/** The servo of each kind of joint, from the catalogue. */
export function ServoFields() {
  const { robot } = useInputs();
  const catalogue = useStudio((studio) => studio.welcome?.servos) ?? [];
  // The servos of the first leg are shown: a choice here applies to all legs.
  const now = JOINTS.map((_, i) => robot.servos[i] ?? "");
  const choose = (joint: number, name: string) => {
    const [coxa = name, femur = name, tibia = name] = now.map((servo, i) =>
      i === joint || servo === "" ? name : servo,
    );
    setDocument(withServos(robot.document, coxa, femur, tibia));
  };
  return (
    <>
      {JOINTS.map((joint, i) => {
        const known = catalogue.includes(now[i] ?? "");
        return (
          <div key={joint} className="field">
            <Select
              label={joint}
              testId={`servo-${joint}`}
              value={now[i] ?? ""}
              options={[
                ...(known
                  ? []
                  : [{ value: now[i] ?? "", label: now[i] ? `${now[i]} (custom data)` : "not given" }]),
                ...catalogue.map((name) => ({ value: name, label: name })),
              ]}
              onChange={(name) => name && choose(i, name)}
            />
            <p className="hint">Stall torque: {withUnit(robot.stall_torque_nm[i], 2, "N m")}</p>
          </div>
        );
      })}
    </>
  );
}
