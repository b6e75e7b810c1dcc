import { useState } from "react";

import { decimalsOf, fixed, typedNumber } from "./numbers";
import { useCommit } from "./useCommit";

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
  /** `commit` is false while it is being typed, and true when the field is left or Enter is pressed. */
  onChange: (value: number, commit: boolean) => void;
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

  const isInside = (number: number) => number >= (min ?? -Infinity) && number <= (max ?? Infinity);
  const standing = draft?.stands.includes(value) ?? false;
  // What was typed for another robot, say, is not meant for this one.
  const input = useCommit((number) => standing && isInside(number) && onChange(number, true));

  const type = (text: string) => {
    const number = typedNumber(text);
    const inside = number !== null && isInside(number);
    setDraft({ text, stands: [value, inside ? number : value] });
    if (inside && number !== value) onChange(number, false);
    if (text.trim() === "" && value !== null) onEmpty?.();
  };
  return (
    <input
      ref={input}
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
      value={draft && standing ? draft.text : shown}
      onChange={(event) => type(event.target.value)}
      onBlur={() => setDraft(null)}
    />
  );
}
