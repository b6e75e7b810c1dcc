import { useId } from "react";

export interface Option {
  value: string;
  label: string;
}

interface Props {
  label: string;
  value: string;
  options: readonly Option[];
  /** Whether the label is for screen readers only. */
  quiet?: boolean;
  testId?: string;
  onChange: (value: string) => void;
}

/** A native drop-down list with a label. */
export function Select({ label, value, options, quiet, testId, onChange }: Props) {
  const id = useId();
  return (
    <div className="field">
      <label htmlFor={id} className={quiet ? "hidden-text" : undefined}>
        {label}
      </label>
      <select id={id} data-testid={testId} value={value} onChange={(event) => onChange(event.target.value)}>
        {options.map((option) => (
          <option key={option.value} value={option.value}>
            {option.label}
          </option>
        ))}
      </select>
    </div>
  );
}
