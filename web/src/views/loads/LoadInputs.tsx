import { Check } from "../../controls/Check";
import { Refusal } from "../../controls/Failure";
import { Segments } from "../../controls/Segments";
import { Slider } from "../../controls/Slider";
import { change } from "../../state/session";
import { useInputs } from "../useInputs";

const AXES = [
  ["Payload x (forward)", 0],
  ["Payload y (left)", 1],
  ["Payload z (up)", 2],
] as const;

/** Payload, supply, and the criterion for the servos. */
export function LoadInputs() {
  const { state } = useInputs();
  const { loads } = state;
  return (
    <fieldset>
      <legend>Payload and safety</legend>
      <Slider
        label="Payload"
        value={loads.payload_kg}
        min={0}
        max={5}
        typedMax={1000}
        step={0.05}
        unit="kg"
        testId="payload"
        note={<Refusal of="loads" at="payload_kg" />}
        onChange={(payload_kg, commit) => change("loads", { payload_kg }, commit)}
      />
      <Slider
        label="Safety factor"
        value={loads.safety_factor}
        min={1}
        max={5}
        typedMax={100}
        step={0.1}
        unit="×"
        testId="safety-factor"
        note={<Refusal of="loads" at="safety_factor" />}
        onChange={(safety_factor, commit) => change("loads", { safety_factor }, commit)}
      />
      <div className="row">
        <span>Criterion</span>
        <Segments
          label="Criterion"
          testId="rule"
          value={loads.rule}
          options={[
            { value: "factor", label: "peak torque", hint: "Peak torque relative to the stall torque" },
            {
              value: "continuous",
              label: "continuous",
              hint: "RMS torque relative to a fifth of the stall torque",
            },
          ]}
          onChange={(rule) => change("loads", { rule })}
        />
      </div>
      <Check
        label="Include inertia"
        testId="inertial"
        checked={loads.inertial}
        onChange={(inertial) => change("loads", { inertial })}
      />
      <details>
        <summary>Payload position, supply voltage, battery</summary>
        <div className="inside">
          {AXES.map(([label, axis]) => (
            <Slider
              key={label}
              label={label}
              value={loads.payload_at_mm[axis]}
              min={-200}
              max={200}
              typedMin={-5000}
              typedMax={5000}
              step={5}
              unit="mm"
              note={<Refusal of="loads" at={`payload_at_mm[${axis}]`} />}
              onChange={(value, commit) => {
                const at: [number, number, number] = [...loads.payload_at_mm];
                at[axis] = value;
                change("loads", { payload_at_mm: at }, commit);
              }}
            />
          ))}
          <Slider
            label="Supply voltage"
            value={loads.supply_v}
            min={0}
            max={16}
            typedMax={100}
            step={0.1}
            unit="V"
            testId="supply"
            note={<Refusal of="loads" at="supply_v" />}
            auto={loads.supply_v === null}
            onAuto={() => change("loads", { supply_v: null })}
            onChange={(supply_v, commit) => change("loads", { supply_v }, commit)}
          />
          <Slider
            label="Battery capacity"
            value={loads.capacity_ah}
            min={0}
            max={10}
            typedMax={1000}
            step={0.1}
            unit="Ah"
            testId="capacity"
            note={<Refusal of="loads" at="capacity_ah" />}
            auto={loads.capacity_ah === null}
            onAuto={() => change("loads", { capacity_ah: null })}
            onChange={(capacity_ah, commit) => change("loads", { capacity_ah }, commit)}
          />
        </div>
      </details>
    </fieldset>
  );
}
