import { useEffect, useState } from "react";

import { useStudio } from "../state/store";

/** How long a passing message stays [ms]. */
const STAY = 3500;

/** A passing message, said by screen readers too. */
export function Toast() {
  const notice = useStudio((studio) => studio.notice);
  const [gone, setGone] = useState(0);
  useEffect(() => {
    if (!notice) return;
    const timer = window.setTimeout(() => setGone(notice.key), STAY);
    return () => window.clearTimeout(timer);
  }, [notice]);
  const shown = notice !== null && notice.key !== gone;
  return (
    <div role="status" aria-live="polite" data-testid="toast">
      {shown && <div className="toast">{notice.text}</div>}
    </div>
  );
}
