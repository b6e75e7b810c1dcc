import { Icon, type IconName } from "./icons";

interface Props {
  icon: IconName;
  /** Accessible name and tooltip. */
  name: string;
  disabled?: boolean;
  testId?: string;
  onClick: () => void;
}

/** A button with an icon only. */
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
