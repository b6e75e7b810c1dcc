import { Failure, Refusal } from "../controls/Failure";
import { Icon } from "../controls/icons";
import { Segments } from "../controls/Segments";
import { Slider } from "../controls/Slider";
import { useTouch } from "../controls/useTouch";
import type { BodyState } from "../protocol";
import { change } from "../state/session";
import { useStudio } from "../state/store";
import { AngleTable } from "./AngleTable";
import { FeetInputs } from "./FeetInputs";
import { Standing } from "./Standing";
import { useInputs } from "./useInputs";
import { ViewHead } from "./ViewHead";
import { WorkspaceChoice } from "./WorkspaceChoice";

type Key = "x_mm" | "y_mm" | "z_mm" | "roll_deg" | "pitch_deg" | "yaw_deg";

const SLIDERS: readonly { key: Key; label: string; span: number; step: number; unit: string }[] = [
  { key: "x_mm", label: "Forward", span: 120, step: 1, unit: "mm" },
  { key: "y_mm", label: "Left", span: 120, step: 1, unit: "mm" },
  { key: "z_mm", label: "Up", span: 120, step: 1, unit: "mm" },
  { key: "roll_deg", label: "Roll (left side up)", span: 35, step: 0.5, unit: "°" },
  { key: "pitch_deg", label: "Pitch (front down)", span: 35, step: 0.5, unit: "°" },
  { key: "yaw_deg", label: "Yaw (turn left)", span: 50, step: 0.5, unit: "°" },
];
const RESET: Partial<BodyState> = {
  x_mm: 0,
  y_mm: 0,
  z_mm: 0,
  roll_deg: 0,
  pitch_deg: 0,
  yaw_deg: 0,
  feet_mm: null,
};

/** Whether the body is moved at all: of no movement, no fraction is possible. */
function isMoved(body: BodyState): boolean {
  return SLIDERS.some(({ key }) => body[key] !== 0);
}

/** Inverse kinematics: the body moves, the feet stay on the ground. */
export function BodyView() {
  const { robot, state } = useInputs();
  const pose = useStudio((studio) => studio.poses.body);
  const { body } = state;
  const touch = useTouch();
  const set = (values: Partial<BodyState>, commit = true) => change("body", values, commit);
  return (
    <div className="view">
      <ViewHead title="Body">
        Move and rotate the body relative to the feet. Body and feet can also be dragged in the 3D view
        {touch ? "" : "; with Shift, vertically"}.
      </ViewHead>
      <Failure of={["body", "drag_foot"]} />
      {pose && <Standing pose={pose} />}
      {pose?.feasible_fraction != null && pose.feasible_fraction < 1 && isMoved(body) && (
        <p className="hint" data-testid="feasible-fraction">
          {Math.floor(pose.feasible_fraction * 100)} % of this movement is possible.
        </p>
      )}
      <fieldset>
        <legend>Body pose</legend>
        {SLIDERS.map(({ key, label, span, step, unit }) => (
          <Slider
            key={key}
            label={label}
            value={body[key]}
            min={-span}
            max={span}
            typedMin={-1000}
            typedMax={1000}
            step={step}
            unit={unit}
            testId={`body-${key}`}
            note={<Refusal of="body" at={key} />}
            onChange={(value, commit) => set({ [key]: value }, commit)}
          />
        ))}
        <div className="row">
          <button type="button" className="button" data-testid="body-home" onClick={() => set(RESET)}>
            <Icon name="reset" /> Reset
          </button>
        </div>
      </fieldset>
      <fieldset>
        <legend>Stance</legend>
        <Slider
          label="Body height"
          value={body.body_height_mm ?? robot.body_height_mm}
          min={0}
          max={Math.max(200, Math.round(robot.body_height_mm * 2))}
          typedMax={10_000}
          step={1}
          unit="mm"
          testId="body-height"
          note={<Refusal of="body" at="body_height_mm" />}
          auto={body.body_height_mm === null}
          onAuto={() => set({ body_height_mm: null })}
          onChange={(value, commit) => set({ body_height_mm: value }, commit)}
        />
        <div className="row">
          <span>Knee</span>
          <Segments
            label="Knee"
            testId="knee"
            value={body.knee}
            options={[
              { value: "up", label: "up" },
              { value: "down", label: "down" },
            ]}
            onChange={(knee) => set({ knee })}
          />
        </div>
      </fieldset>
      {pose && <FeetInputs pose={pose} />}
      <WorkspaceChoice />
      {pose && <AngleTable codes={robot.leg_codes} angles={pose.angles_deg} />}
    </div>
  );
}
