import { Failure } from "../../controls/Failure";
import { Message } from "../../controls/Message";
import { Segments } from "../../controls/Segments";
import { Select } from "../../controls/Select";
import type { PhysicsOptions } from "../../protocol";
import { change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { TerrainInputs } from "./TerrainInputs";

const SENSORS: readonly { value: PhysicsOptions["sensors"]; label: string }[] = [
  { value: "ideal", label: "everything, exactly" },
  { value: "hobby", label: "foot switches and a cheap IMU" },
  { value: "smart", label: "servos that report position, speed and load" },
  { value: "blind", label: "none" },
];

/** The switch between plan and physics, and the options of physics. */
export function PhysicsFields({ driven = false }: { driven?: boolean }) {
  const { physics } = useInputs().state;
  const missing = useStudio((studio) => studio.welcome?.physics.missing ?? null);
  const set = (values: Partial<PhysicsOptions>) => change("physics", values);
  return (
    <fieldset>
      <legend>Physics</legend>
      <Segments
        label="Plan or physics"
        testId="physics"
        value={physics.on ? "on" : "off"}
        options={[
          { value: "off", label: "As planned" },
          { value: "on", label: "In physics" },
        ]}
        disabled={missing !== null && !physics.on}
        onChange={(value) => set({ on: value === "on" })}
      />
      {missing !== null && (
        <Message kind="plain" testId="physics-missing">
          {missing}
        </Message>
      )}
      <Failure of={["physics", "simulate"]} />
      {physics.on && missing === null && (
        <>
          <TerrainInputs />
          <Select
            label="Servos"
            testId="servo-model"
            value={physics.servos}
            options={[
              { value: "catalogue", label: "those of the robot, from the catalogue" },
              { value: "ideal", label: "ideal, without limits of torque and speed" },
            ]}
            onChange={(servos) => set({ servos: servos as PhysicsOptions["servos"] })}
          />
          {driven && (
            <Select
              label="Sensors"
              testId="sensors"
              value={physics.sensors}
              options={SENSORS}
              onChange={(sensors) => set({ sensors: sensors as PhysicsOptions["sensors"] })}
            />
          )}
          <p className="hint">
            Translucent: {driven ? "as commanded, over the place where the robot is" : "the plan"}. Arrows:
            ground forces. Red ring: a foot that slides faster than 15 mm/s. Red joint: a servo at its maximum
            torque.
          </p>
        </>
      )}
    </fieldset>
  );
}
