import type { ReactNode } from "react";

interface Props {
  kind: "good" | "warn" | "bad" | "plain";
  /** Whether screen readers announce it immediately. */
  alert?: boolean;
  testId?: string;
  children: ReactNode;
}

const MARKS = { good: "✓ ", warn: "△ ", bad: "⚠ ", plain: "" } as const;

/** A message; a symbol shows its kind too, not the colour alone. */
export function Message({ kind, alert, testId, children }: Props) {
  return (
    <div className={`message ${kind}`} role={alert ? "alert" : undefined} data-testid={testId}>
      <div>
        <span aria-hidden="true">{MARKS[kind]}</span>
        {children}
      </div>
    </div>
  );
}

/** A list of remarks; nothing where it is empty. */
export function Remarks({
  kind,
  items,
  testId,
}: {
  kind: Props["kind"];
  items: readonly string[];
  testId?: string;
}) {
  if (items.length === 0) return null;
  return (
    <Message kind={kind} testId={testId}>
      {items.length === 1 ? (
        items[0]
      ) : (
        <ul>
          {items.map((item) => (
            <li key={item}>{item}</li>
          ))}
        </ul>
      )}
    </Message>
  );
}
