import { useState } from "react";

import { decimalsOf, fixed, typedNumber } from "./numbers";

interface Props {
  id: string;
  value: number | null;
  step: number;
  min?: number;
  max?: number;
  disabled?: boolean;
  /** Show every digit: for what a file says, not for what a slider gave. */
  exact?: boolean;
  placeholder?: string;
  /** Names what says more about it, for screen readers. */
  describedBy?: string;
  label?: string;
  testId?: string;
  onChange: (value: number) => void;
  /** The field was emptied; left out where it must not be empty. */
  onEmpty?: () => void;
}

/** What is being typed. It stands while the value is what it was, or what was typed: undo, say, ends it. */
interface Draft {
  text: string;
  stands: readonly (number | null)[];
}

/** A number to type. What is typed is taken when it is a number, and put right when the field is left. */
export function NumberInput(props: Props) {
  const {
    id,
    value,
    step,
    min,
    max,
    disabled,
    exact,
    placeholder,
    describedBy,
    label,
    testId,
    onChange,
    onEmpty,
  } = props;
  const [draft, setDraft] = useState<Draft | null>(null);
  // One digit more than the step has: enough to see that a value lies between two steps.
  const shown = value === null ? "" : String(Number(fixed(value, exact ? 6 : decimalsOf(step) + 1)));

  const type = (text: string) => {
    const number = typedNumber(text);
    const inside = number !== null && number >= (min ?? -Infinity) && number <= (max ?? Infinity);
    setDraft({ text, stands: [value, inside ? number : value] });
    if (inside && number !== value) onChange(number);
    if (text.trim() === "" && value !== null) onEmpty?.();
  };
  return (
    <input
      id={id}
      data-testid={testId}
      type="number"
      inputMode="decimal"
      step={step}
      min={min}
      max={max}
      disabled={disabled}
      placeholder={placeholder}
      aria-describedby={describedBy}
      aria-label={label}
      value={draft?.stands.includes(value) ? draft.text : shown}
      onChange={(event) => type(event.target.value)}
      onBlur={() => setDraft(null)}
    />
  );
}
