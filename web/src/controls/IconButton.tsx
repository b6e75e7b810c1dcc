import { Icon, type IconName } from "./icons";

interface Props {
  icon: IconName;
  /** What it does: its name, and its tip. */
  name: string;
  disabled?: boolean;
  testId?: string;
  onClick: () => void;
}

/** A button that is a drawing. */
export function IconButton({ icon, name, disabled, testId, onClick }: Props) {
  return (
    <button
      type="button"
      className="button icon"
      aria-label={name}
      title={name}
      disabled={disabled}
      data-testid={testId}
      onClick={onClick}
    >
      <Icon name={icon} />
    </button>
  );
}
