import { useId, type ReactNode } from "react";

import { NumberInput } from "./NumberInput";
import { clamp, decimalsOf, fixed } from "./numbers";
import { useCommit } from "./useCommit";

interface Props {
  label: string;
  /** Null where the server chooses it and has not sent it. */
  value: number | null;
  min: number;
  max: number;
  step: number;
  unit: string;
  /** Bounds of typed values, where they are wider than those of the slider. */
  typedMin?: number;
  typedMax?: number;
  /** Accessible name, where the label alone is ambiguous. */
  name?: string;
  /** Whether label, slider and field share a row; with "wide" there is room for a word as the label. */
  compact?: boolean | "wide";
  bad?: boolean;
  disabled?: boolean;
  testId?: string;
  /** What stands below it, such as the refusal of its value. */
  note?: ReactNode;
  /** Whether the server chooses the value, and the function that makes it do so; left out where it can't. */
  auto?: boolean;
  onAuto?: () => void;
  onChange: (value: number, commit: boolean) => void;
}

/** A slider and a numeric field for one value, with label and unit. */
export function Slider(props: Props) {
  const { label, value, min, max, step, unit, name, compact, bad, disabled, testId, auto, onAuto, onChange } =
    props;
  const id = useId();
  const range = useCommit((rested) => onChange(rested, true));
  const full = name ?? label;
  const digits = decimalsOf(step);
  return (
    <div
      className={`slider${compact ? " compact" : ""}${compact === "wide" ? " wide" : ""}${bad ? " bad" : ""}`}
    >
      <label htmlFor={id}>
        {bad && <span aria-hidden="true">⚠ </span>}
        {label}
      </label>
      <input
        id={id}
        ref={range}
        data-testid={testId}
        type="range"
        min={min}
        max={max}
        step={step}
        disabled={disabled}
        aria-label={name}
        aria-valuetext={
          value === null ? "automatic" : `${fixed(value, digits)} ${unit}${auto ? ", automatic" : ""}`
        }
        aria-invalid={bad}
        value={clamp(value ?? min, min, max)}
        onChange={(event) => onChange(event.target.valueAsNumber, false)}
      />
      <div className="number">
        {onAuto && (
          <button
            type="button"
            className="button auto"
            aria-pressed={auto}
            aria-label={`auto: ${full}`}
            data-testid={testId && `${testId}-auto`}
            onClick={() => (auto ? onChange(value ?? min, true) : onAuto())}
          >
            auto
          </button>
        )}
        <NumberInput
          id={`${id}n`}
          value={value}
          step={step}
          min={props.typedMin ?? min}
          max={props.typedMax ?? max}
          disabled={disabled}
          placeholder={auto ? "auto" : undefined}
          label={`${full} in ${unit || "numbers"}`}
          testId={testId && `${testId}-number`}
          onChange={onChange}
        />
        <span className="unit" aria-hidden="true">
          {unit}
        </span>
      </div>
      {props.note}
    </div>
  );
}
