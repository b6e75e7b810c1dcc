import { useEffect, useState } from "react";

import { useStudio } from "../state/store";

/** Duration of a notification [ms]. */
const DURATION = 3500;

/** A notification that disappears by itself; screen readers announce it. */
export function Toast() {
  const notice = useStudio((studio) => studio.notice);
  const [expired, setExpired] = useState(0);
  useEffect(() => {
    if (!notice) return;
    const timer = window.setTimeout(() => setExpired(notice.key), DURATION);
    return () => window.clearTimeout(timer);
  }, [notice]);
  const shown = notice !== null && notice.key !== expired;
  return (
    <div role="status" aria-live="polite" data-testid="toast">
      {shown && <div className="toast">{notice.text}</div>}
    </div>
  );
}
