import { Slider } from "../../controls/Slider";
import type { WalkMessage } from "../../protocol";
import { change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { WalkRefusal } from "./WalkRefusal";

type Key = "stroke_mm" | "speed_mm_s" | "body_height_mm" | "swing_height_mm";

interface Row {
  key: Key;
  label: string;
  chosen: (walk: WalkMessage) => number;
  max: number;
  typedMax: number;
  step: number;
  unit: string;
}

const ROWS: readonly Row[] = [
  {
    key: "speed_mm_s",
    label: "Speed",
    chosen: (walk) => walk.speed_mm_s,
    max: 300,
    typedMax: 5000,
    step: 1,
    unit: "mm/s",
  },
  {
    key: "stroke_mm",
    label: "Stroke",
    chosen: (walk) => walk.stroke_mm,
    max: 200,
    typedMax: 5000,
    step: 1,
    unit: "mm",
  },
  {
    key: "swing_height_mm",
    label: "Swing height",
    chosen: (walk) => walk.swing_height_mm,
    max: 100,
    typedMax: 2000,
    step: 1,
    unit: "mm",
  },
  {
    key: "body_height_mm",
    label: "Body height",
    chosen: (walk) => walk.body_height_mm,
    max: 220,
    typedMax: 5000,
    step: 1,
    unit: "mm",
  },
];

/** Parameters of the steps. Automatic values show what the plan has chosen. */
export function StepInputs() {
  const { state } = useInputs();
  const walk = useStudio((studio) => studio.walk);
  return (
    <fieldset>
      <legend>Steps</legend>
      {ROWS.map(({ key, label, chosen, max, typedMax, step, unit }) => {
        const value = state.walk[key];
        return (
          <Slider
            key={key}
            label={label}
            value={value ?? (walk ? chosen(walk) : null)}
            min={0}
            max={max}
            typedMax={typedMax}
            step={step}
            unit={unit}
            testId={key}
            note={<WalkRefusal at={key} />}
            auto={value === null}
            onAuto={() => change("walk", { [key]: null })}
            onChange={(next, commit) => change("walk", { [key]: next }, commit)}
          />
        );
      })}
      <details>
        <summary>Tilt, cycle time, distance between feet</summary>
        <div className="inside">
          {(["roll_deg", "pitch_deg"] as const).map((key) => (
            <Slider
              key={key}
              label={key === "roll_deg" ? "Roll while walking" : "Pitch while walking"}
              value={state.walk[key]}
              min={-20}
              max={20}
              typedMin={-60}
              typedMax={60}
              step={0.5}
              unit="°"
              testId={key}
              note={<WalkRefusal at={key} />}
              onChange={(next, commit) => change("walk", { [key]: next }, commit)}
            />
          ))}
          <Slider
            label="Cycle time"
            value={state.walk.cycle_time_s ?? walk?.cycle_time_s ?? null}
            min={0}
            max={5}
            typedMax={100}
            step={0.05}
            unit="s"
            testId="cycle_time_s"
            note={<WalkRefusal at="cycle_time_s" />}
            auto={state.walk.cycle_time_s === null}
            onAuto={() => change("walk", { cycle_time_s: null })}
            onChange={(next, commit) => change("walk", { cycle_time_s: next }, commit)}
          />
          <Slider
            label="Smallest allowed distance between feet"
            value={state.walk.foot_distance_mm}
            min={0}
            max={400}
            typedMax={5000}
            step={1}
            unit="mm"
            testId="foot_distance_mm"
            note={<WalkRefusal at="foot_distance_mm" />}
            auto={state.walk.foot_distance_mm === null}
            onAuto={() => change("walk", { foot_distance_mm: null })}
            onChange={(next, commit) => change("walk", { foot_distance_mm: next }, commit)}
          />
        </div>
      </details>
    </fieldset>
  );
}
