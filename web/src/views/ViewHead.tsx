import type { ReactNode } from "react";

/** Title and description of a view. */
export function ViewHead({ title, children }: { title: string; children: ReactNode }) {
  return (
    <div className="view-head">
      <h2>{title}</h2>
      <p>{children}</p>
    </div>
  );
}
