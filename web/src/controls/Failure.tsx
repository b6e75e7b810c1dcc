import { useLayoutEffect, useRef, type ReactNode } from "react";
import { create } from "zustand";

import type { ErrorMessage } from "../protocol";
import type { ClientType } from "../state/outbox";
import { useStudio } from "../state/store";
import { Message } from "./Message";

/** Whether the refusal that stands beside its input is in sight; undefined for types without one. */
const useSeen = create<Partial<Record<ClientType, boolean>>>(() => ({}));

interface Props {
  /** Message types whose errors are shown. */
  of: readonly ClientType[];
  children?: ReactNode;
}

/** Errors of the server at the top of the panel, where they stay in sight: those that no visible input has beside it. */
export function Failure({ of, children }: Props) {
  const failures = useStudio((studio) => studio.failures);
  const seen = useSeen();
  const shown = of.flatMap((type) =>
    failures[type] && !seen[type] ? [{ type, failure: failures[type] }] : [],
  );
  if (shown.length === 0) return null;
  // Over the panel's content where the refusal also stands beside an input, which must not be moved away by that.
  const over = shown.every(({ type }) => seen[type] !== undefined);
  return (
    <div className={`failures${over ? " over" : ""}`}>
      {shown.map(({ type, failure }) => (
        <Text key={type} failure={failure}>
          {children}
        </Text>
      ))}
    </div>
  );
}

interface RefusalProps {
  of: ClientType;
  /** Key of the input: that of the last change decides where the refusal stands. */
  at: string;
  children?: ReactNode;
}

/** The refusal of a change, beside the input that was changed last. */
export function Refusal({ of, at, children }: RefusalProps) {
  const failure = useStudio((studio) => (studio.edited[of] === at ? studio.failures[of] : undefined));
  return failure ? (
    <Seen of={of}>
      <Text failure={failure}>{children}</Text>
    </Seen>
  ) : null;
}

/** Tells `Failure` whether its content is in sight: not scrolled away, nor folded. */
function Seen({ of, children }: { of: ClientType; children: ReactNode }) {
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    if (!box.current) return;
    // The input is in sight, as it has just been changed; what is below it may not be.
    box.current.scrollIntoView({ block: "nearest" });
    const set = (seen: boolean | undefined) => useSeen.setState({ [of]: seen });
    set(true);
    const watch = new IntersectionObserver(([entry]) => set(entry?.isIntersecting ?? false));
    watch.observe(box.current);
    return () => {
      watch.disconnect();
      set(undefined);
    };
  }, [of]);
  return (
    <div ref={box} className="refusal">
      {children}
    </div>
  );
}

function Text({ failure, children }: { failure: ErrorMessage; children?: ReactNode }) {
  return (
    <Message kind="bad" alert testId="failure">
      <span className="lines">{failure.text}</span>
      {children}
    </Message>
  );
}
