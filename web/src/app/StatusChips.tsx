import { useEffect, useState } from "react";

import { fixed } from "../controls/numbers";
import type { Frame } from "../scene/frame";
import { stage } from "../scene/stage";

/** How often the numbers change [ms]: faster could not be read. */
const EVERY = 120;

interface Status {
  margin: string;
  stands: boolean;
  feet: string;
  troubled: number;
}

/** How it stands, in a few words over the picture. */
export function StatusChips() {
  const [status, setStatus] = useState<Status | null>(null);
  useEffect(() => {
    let timer: number | undefined;
    const tell = () => {
      timer = undefined;
      const next = stage.current && statusOf(stage.current);
      setStatus((before) => (JSON.stringify(before) === JSON.stringify(next) ? before : next));
    };
    const stop = stage.watch(() => (timer ??= window.setTimeout(tell, EVERY)));
    return () => {
      stop();
      window.clearTimeout(timer);
    };
  }, []);
  if (!status) return <div className="chips" />;
  return (
    <div className="chips" data-testid="status">
      <span className={`chip ${status.stands ? "good" : "bad"}`} data-testid="chip-margin">
        {status.stands ? "✓ stable" : "⚠ falls"}
        {status.margin && ` · ${status.margin}`}
      </span>
      <span className="chip" data-testid="chip-feet">
        {status.feet}
      </span>
      {status.troubled > 0 && (
        <span className="chip bad" data-testid="chip-trouble">
          ⚠ {status.troubled === 1 ? "1 leg can’t" : `${status.troubled} legs can’t`}
        </span>
      )}
    </div>
  );
}

function statusOf(frame: Frame): Status {
  const down = frame.contacts.filter(Boolean).length;
  return {
    margin: frame.margin === null ? "" : `${fixed(frame.margin, 0)} mm`,
    stands: frame.margin !== null && frame.margin >= 0,
    feet: `${down} ${down === 1 ? "foot" : "feet"} down`,
    troubled: frame.trouble.filter(Boolean).length,
  };
}
