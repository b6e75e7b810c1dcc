import { useState, type KeyboardEvent } from "react";

import { decimalsOf, fixed, rangeText, stepped, typedNumber } from "./numbers";

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

/**
 * A text field for a number, with a point or a comma. Valid numbers take effect while typing. What is not applied is not
 * shown either: on Enter, and when the focus leaves, the field shows its value again, and a note says what is possible.
 */
export function NumberInput(props: Props) {
  const { id, value, step, min, max, disabled, exact, placeholder, label, testId, onChange, onEmpty } = props;
  const [draft, setDraft] = useState<Draft | null>(null);
  const [refused, setRefused] = useState<{ text: string; value: number | null } | null>(null);
  // One digit more than the step has shows values between two steps.
  const shown = value === null ? "" : String(Number(fixed(value, exact ? 6 : decimalsOf(step) + 1)));

  const inside = (text: string) => {
    const number = typedNumber(text);
    return number !== null && number >= (min ?? -Infinity) && number <= (max ?? Infinity) ? number : null;
  };
  // Text typed for another robot, for example, does not apply.
  const typed = draft?.stands.includes(value) ? draft.text : null;
  const isWrong = typed !== null && inside(typed) === null && !(onEmpty && typed.trim() === "");
  const note = refused?.value === value && typed === null ? refused.text : null;

  const type = (text: string) => {
    const number = inside(text);
    setRefused(null);
    setDraft({ text, stands: [value, number ?? value] });
    if (number !== null && number !== value) onChange(number, false);
    if (text.trim() === "" && value !== null) onEmpty?.();
  };
  const settle = () => {
    setDraft(null);
    if (typed === null) return;
    const number = inside(typed);
    if (number !== null) onChange(number, true);
    else if (isWrong) setRefused({ text: `${typed.trim() || "Empty"}: ${rangeText(min, max)}`, value });
  };
  const keys = (event: KeyboardEvent) => {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.key === "Enter") settle();
    else if (event.key === "Escape") setDraft(null);
    else if (direction && value !== null) {
      event.preventDefault();
      setDraft(null);
      onChange(stepped(value, direction * step, min, max), true);
    }
  };
  return (
    <span className="number-input">
      <input
        id={id}
        data-testid={testId}
        data-draft={typed !== null}
        className="typed"
        type="text"
        inputMode={min !== undefined && min >= 0 ? "decimal" : "text"}
        role="spinbutton"
        aria-valuenow={value ?? undefined}
        aria-valuetext={value === null ? (placeholder ?? "empty") : undefined}
        aria-valuemin={min}
        aria-valuemax={max}
        aria-invalid={isWrong || note !== null}
        autoComplete="off"
        disabled={disabled}
        placeholder={placeholder}
        aria-describedby={note === null ? props.describedBy : `${id}note`}
        aria-label={label}
        value={typed ?? shown}
        onChange={(event) => type(event.target.value)}
        onKeyDown={keys}
        onBlur={settle}
      />
      {note !== null && (
        <span id={`${id}note`} className="number-note" role="alert" data-testid={testId && `${testId}-note`}>
          {note}
        </span>
      )}
    </span>
  );
}
