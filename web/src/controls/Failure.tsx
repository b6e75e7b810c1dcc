import type { ReactNode } from "react";

import type { ClientType } from "../state/outbox";
import { useStudio } from "../state/store";
import { Message } from "./Message";

interface Props {
  /** Message types whose errors are shown. */
  of: readonly ClientType[];
  children?: ReactNode;
}

/** Error messages of the server. */
export function Failure({ of, children }: Props) {
  const failures = useStudio((studio) => studio.failures);
  const shown = of.flatMap((type) => failures[type] ?? []);
  return shown.map((failure) => (
    <Message key={failure.type} kind="bad" alert testId="failure">
      <span className="lines">{failure.text}</span>
      {children}
    </Message>
  ));
}
