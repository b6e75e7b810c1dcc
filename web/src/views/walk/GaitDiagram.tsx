import { useEffect, useMemo, useRef } from "react";

import type { WalkMessage } from "../../protocol";
import { lengthOf } from "../../scene/trails";
import { triple } from "../../scene/kinematics";
import { legColours } from "../../scene/palette";
import { usePlayback } from "../../state/playback";
import { useInputs } from "../useInputs";
import { stanceSpans } from "./spans";

const ROW = 16;
const LEFT = 30;
const WIDTH = 360;

/** Gait diagram: stance of each foot over the whole walk. A click sets the playback time. */
export function GaitDiagram({ walk }: { walk: WalkMessage }) {
  const { robot } = useInputs();
  const mark = useRef<SVGLineElement>(null);
  const duration = lengthOf(walk);
  const scale = (WIDTH - LEFT) / (duration || 1);
  const spans = useMemo(() => robot.leg_codes.map((_, leg) => stanceSpans(walk, leg)), [robot, walk]);
  const colours = useMemo(
    () => legColours(robot.leg_names.map((_, leg) => triple(robot.mount_mm, leg))),
    [robot],
  );
  const height = robot.leg_codes.length * ROW;

  useEffect(() => {
    const move = ({ time }: { time: number }) => {
      const x = (LEFT + time * scale).toFixed(1);
      mark.current?.setAttribute("x1", x);
      mark.current?.setAttribute("x2", x);
    };
    move(usePlayback.getState());
    return usePlayback.subscribe(move);
  }, [scale]);

  return (
    <figure className="gait-diagram">
      <figcaption>Gait diagram: stance of each foot</figcaption>
      {/* The scrubber does the same by keyboard. */}
      <svg
        viewBox={`0 0 ${WIDTH} ${height}`}
        role="img"
        aria-label={`${walk.gait}: each foot is in stance for ${Math.round(walk.duty_factor * 100)} % of a cycle.`}
        data-testid="gait-diagram"
        onClick={(event) => {
          const box = event.currentTarget.getBoundingClientRect();
          const time = (((event.clientX - box.left) / box.width) * WIDTH - LEFT) / scale;
          usePlayback.setState({ time: Math.min(duration, Math.max(0, time)), playing: false });
        }}
      >
        {robot.leg_codes.map((code, leg) => (
          <g key={code} transform={`translate(0 ${leg * ROW})`}>
            <text x={0} y={ROW - 4}>
              {code}
            </text>
            {spans[leg]?.map(([from, to]) => (
              <rect
                key={from}
                x={LEFT + from * scale}
                y={3}
                width={Math.max(0.5, (to - from) * scale)}
                height={ROW - 6}
                rx={2}
                fill={colours[leg]}
              />
            ))}
          </g>
        ))}
        <line ref={mark} y1={0} y2={height} />
      </svg>
    </figure>
  );
}
