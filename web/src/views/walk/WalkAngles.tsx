import { useEffect, useState } from "react";

import type { WalkMessage } from "../../protocol";
import { usePlayback } from "../../state/playback";
import { AngleTable } from "../AngleTable";
import { useInputs } from "../useInputs";

/** Joint angles at the playback time, updated four times a second. */
export function WalkAngles({ walk }: { walk: WalkMessage }) {
  const { robot } = useInputs();
  const [sample, setSample] = useState(0);
  useEffect(() => {
    const at = () => Math.min(walk.count - 1, Math.round(usePlayback.getState().time * walk.rate_hz));
    const timer = window.setInterval(() => setSample(at()), 250);
    return () => window.clearInterval(timer);
  }, [walk]);
  const width = robot.leg_names.length * 3;
  return (
    <AngleTable
      codes={robot.leg_codes}
      angles={walk.angles_deg.slice(sample * width, (sample + 1) * width)}
      at={sample / walk.rate_hz}
    />
  );
}
