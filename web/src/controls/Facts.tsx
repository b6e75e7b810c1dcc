import type { ReactNode } from "react";

interface Props {
  rows: readonly (readonly [string, ReactNode])[];
  testId?: string;
}

/** A list of names and values. */
export function Facts({ rows, testId }: Props) {
  return (
    <dl className="facts" data-testid={testId}>
      {rows.map(([name, value]) => (
        <div key={name} style={{ display: "contents" }}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
