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
  /** Whether to show every digit, as for the values of a file. */
  exact?: boolean;
  placeholder?: string;
  /** Id of the element that describes the input, for screen readers. */
  describedBy?: string;
  label?: string;
  testId?: string;
  /** `commit` is false while the user types, and true on Enter or when the field loses the focus. */
  onChange: (value: number, commit: boolean) => void;
  /** Called when the field has been emptied; left out where it must not be empty. */
  onEmpty?: () => void;
}

/** Text being typed; discarded when the value is changed elsewhere, for example by undo. */
interface Draft {
  text: string;
  stands: readonly (number | null)[];
}

/** A numeric text field. Valid numbers take effect while typing; the text is formatted when the focus leaves. */
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
  // One digit more than the step has shows values between two steps.
  const shown = value === null ? "" : String(Number(fixed(value, exact ? 6 : decimalsOf(step) + 1)));

  const isInside = (number: number) => number >= (min ?? -Infinity) && number <= (max ?? Infinity);
  const standing = draft?.stands.includes(value) ?? false;
  // Text typed for another robot, for example, does not apply.
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
