import type { ReactNode } from "react";

import { Failure, Refusal } from "../../controls/Failure";
import { Facts } from "../../controls/Facts";
import { Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import { Slider } from "../../controls/Slider";
import { useTouch } from "../../controls/useTouch";
import { useStudio } from "../../state/store";
import { BringUpOffer, BringUpView } from "../bringUp/BringUpView";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { numberAt, pathText, withValue } from "./document";
import { DocumentField } from "./DocumentField";
import { BODY, LEG_MORE, LENGTHS, LIMITS, MASSES } from "./fields";
import { GaitFields } from "./GaitFields";
import { MountFields } from "./MountFields";
import { RobotFiles } from "./RobotFiles";
import { ServoFields } from "./ServoFields";
import { setDocument } from "./setDocument";

/** Display and editing of all values of the robot file. */
export function RobotView() {
  const { robot } = useInputs();
  const { document } = robot;
  const touch = useTouch();
  const bringUp = useStudio((studio) => studio.bringUp);
  if (bringUp) return <BringUpView bringUp={bringUp} />;
  return (
    <div className="view">
      <ViewHead title="Robot">
        All values of the robot file. Every change is validated and shown immediately
        {touch ? "" : "; Ctrl+Z undoes it"}.
      </ViewHead>
      <RobotFiles />
      <Failure of={["document", "toml", "robot"]} />
      <Remarks kind="bad" items={robot.problems} testId="robot-problems" />
      <Facts
        testId="robot-facts"
        rows={[
          ["Name", robot.name],
          ["Legs", robot.leg_names.length],
          ["Total mass", withUnit(robot.mass_kg, 3, "kg")],
          ["Longest stroke", withUnit(robot.longest_stroke_mm, 1, "mm")],
        ]}
      />
      <fieldset>
        <legend>Links of all legs</legend>
        {LENGTHS.map(({ path, label, unit, step, min, max }) => (
          <Slider
            key={label}
            label={label}
            value={numberAt(document, path) ?? 0}
            min={min ?? 0}
            max={max}
            typedMax={10_000}
            step={step}
            unit={unit}
            testId={`robot-${label.toLowerCase()}`}
            note={<Refusal of="document" at={pathText(path)} />}
            onChange={(value, commit) => setDocument(withValue(document, path, value), commit)}
          />
        ))}
        {LEG_MORE.map((field) => (
          <DocumentField key={field.label} field={field} />
        ))}
      </fieldset>
      <Group title="Bring-up of the servos">
        <BringUpOffer />
      </Group>
      <Group title="Body">
        {BODY.map((field) => (
          <DocumentField key={field.label} field={field} />
        ))}
      </Group>
      <Group title="Leg mounts">
        <MountFields />
      </Group>
      <Group title="Joint limits">
        {LIMITS.flatMap(({ joint, low, high }) => [
          <DocumentField key={`${joint} low`} field={low} />,
          <DocumentField key={`${joint} high`} field={high} />,
        ])}
      </Group>
      <Group title="Masses of the legs">
        {MASSES.map((field) => (
          <DocumentField key={field.label} field={field} />
        ))}
      </Group>
      <Group title="Servos">
        <ServoFields />
      </Group>
      <Group title="Default gait">
        <GaitFields />
      </Group>
      {robot.missing.length > 0 && (
        <Group title="Missing values">
          <ul>
            {robot.missing.map((line) => (
              <li key={line}>{line}</li>
            ))}
          </ul>
        </Group>
      )}
    </div>
  );
}

function Group({ title, children }: { title: string; children: ReactNode }) {
  return (
    <details>
      <summary>{title}</summary>
      <div className="inside">{children}</div>
    </details>
  );
}
