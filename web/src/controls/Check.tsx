interface Props {
  label: string;
  checked: boolean;
  testId?: string;
  onChange: (checked: boolean) => void;
}

/** A checkbox with a label. */
export function Check({ label, checked, testId, onChange }: Props) {
  return (
    <label className="check">
      <input
        type="checkbox"
        data-testid={testId}
        checked={checked}
        onChange={(event) => onChange(event.target.checked)}
      />
      {label}
    </label>
  );
}
