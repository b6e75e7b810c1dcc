import type { ReactNode } from "react";

/** Name of a view, and what it is for in one sentence. */
export function ViewHead({ title, children }: { title: string; children: ReactNode }) {
  return (
    <div className="view-head">
      <h2>{title}</h2>
      <p>{children}</p>
    </div>
  );
}
