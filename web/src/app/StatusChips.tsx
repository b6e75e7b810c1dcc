import { useEffect, useState } from "react";

import { fixed } from "../controls/numbers";
import { SLIDING, type Frame } from "../scene/frame";
import { stage } from "../scene/stage";
import { motionText } from "../views/drive/robotState";

/** Interval at which the texts are updated [ms]: faster changes could not be read. */
const INTERVAL = 120;

interface Status {
  state: string | null;
  motion: string | null;
  belly: boolean;
  limitations: number;
  margin: string;
  /** Null where it is not a matter of statics. */
  stable: boolean | null;
  feet: string;
  troubled: number;
  tilt: string | null;
  sliding: number;
  saturated: number;
  fallen: boolean;
}

/** State, stability and contacts of the robot, over the picture. */
export function StatusChips() {
  const [status, setStatus] = useState<Status | null>(null);
  useEffect(() => {
    let timer: number | undefined;
    const update = () => {
      timer = undefined;
      const next = stage.current && statusOf(stage.current);
      setStatus((before) => (JSON.stringify(before) === JSON.stringify(next) ? before : next));
    };
    const stop = stage.watch(() => (timer ??= window.setTimeout(update, INTERVAL)));
    return () => {
      stop();
      window.clearTimeout(timer);
    };
  }, []);
  if (!status) return <div className="chips" />;
  return (
    <div className="chips" data-testid="status">
      {status.state !== null && (
        <span className={`chip ${status.state === "fault" ? "bad" : ""}`} data-testid="chip-state">
          {status.state}
        </span>
      )}
      {status.motion !== null && (
        <span className="chip" data-testid="chip-motion">
          {status.motion}
        </span>
      )}
      {status.belly ? (
        <span className="chip" data-testid="chip-margin">
          body on the ground
        </span>
      ) : status.stable === null ? null : (
        <span className={`chip ${status.stable ? "good" : "bad"}`} data-testid="chip-margin">
          {status.stable ? "✓ stable" : "⚠ unstable"}
          {status.margin && ` · ${status.margin}`}
        </span>
      )}
      <span className="chip" data-testid="chip-feet">
        {status.feet}
      </span>
      {status.limitations > 0 && (
        <span className="chip warn" data-testid="chip-limitations">
          △ {status.limitations === 1 ? "1 limitation" : `${status.limitations} limitations`}
        </span>
      )}
      {status.tilt !== null && (
        <span className="chip" data-testid="chip-tilt">
          {status.tilt}
        </span>
      )}
      {status.sliding > 0 && (
        <span className="chip warn" data-testid="chip-slip">
          △ {status.sliding === 1 ? "1 foot slides" : `${status.sliding} feet slide`}
        </span>
      )}
      {status.saturated > 0 && (
        <span className="chip warn" data-testid="chip-saturated">
          △ {status.saturated === 1 ? "1 servo" : `${status.saturated} servos`} at maximum torque
        </span>
      )}
      {status.fallen && (
        <span className="chip bad" data-testid="chip-fallen">
          ⚠ fallen
        </span>
      )}
      {status.troubled > 0 && (
        <span className="chip bad" data-testid="chip-trouble">
          ⚠ {status.troubled === 1 ? "problem in 1 leg" : `problems in ${status.troubled} legs`}
        </span>
      )}
    </div>
  );
}

function statusOf(frame: Frame): Status {
  const down = frame.contacts.filter(Boolean).length;
  return {
    state: frame.state,
    motion: frame.motion && motionText(frame.motion.speed, frame.motion.heading),
    belly: frame.belly,
    limitations: frame.limitations,
    margin: frame.margin === null ? "" : `${fixed(frame.margin, 0)} mm`,
    stable:
      (frame.physical ?? frame.highlight) && frame.margin === null
        ? null
        : frame.margin !== null && frame.margin >= 0,
    feet: `${down} ${down === 1 ? "foot" : "feet"} on the ground`,
    troubled: frame.trouble.filter(Boolean).length,
    tilt: frame.physical && `tilt ${frame.physical.tilt.toFixed(1)}°`,
    sliding: frame.physical?.slip.filter((speed) => speed > SLIDING).length ?? 0,
    saturated: frame.physical?.saturated.filter(Boolean).length ?? 0,
    fallen: frame.physical?.fallen ?? false,
  };
}
