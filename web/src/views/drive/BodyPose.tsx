import { Icon } from "../../controls/icons";
import { Slider } from "../../controls/Slider";
import type { BodyPoseValues } from "./useDriving";

const ROWS = [
  ["Forward", 60, 1, "mm"],
  ["Left", 60, 1, "mm"],
  ["Up", 50, 1, "mm"],
  ["Roll", 20, 0.5, "°"],
  ["Pitch", 20, 0.5, "°"],
  ["Yaw", 25, 0.5, "°"],
] as const;

interface Props {
  body: BodyPoseValues;
  onChange: (body: BodyPoseValues) => void;
}

/** Body pose while standing and walking, relative to the level body. */
export function BodyPose({ body, onChange }: Props) {
  const put = (index: number, value: number) => {
    const next: [number, number, number, number, number, number] = [...body];
    next[index] = value;
    onChange(next);
  };
  return (
    <details>
      <summary>Body pose</summary>
      <div className="inside">
        {ROWS.map(([label, span, step, unit], i) => (
          <Slider
            key={label}
            label={label}
            name={`Body ${label.toLowerCase()}`}
            value={body[i] ?? 0}
            min={-span}
            max={span}
            step={step}
            unit={unit}
            testId={`drive-body-${label.toLowerCase()}`}
            onChange={(value) => put(i, value)}
          />
        ))}
        <div className="row">
          <button type="button" className="button small" onClick={() => onChange([0, 0, 0, 0, 0, 0])}>
            <Icon name="reset" /> Reset
          </button>
        </div>
      </div>
    </details>
  );
}
