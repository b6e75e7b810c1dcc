import { useEffect, useMemo, useRef, useState } from "react";

import { useTheme } from "../../app/theme";
import { fixed } from "../../controls/numbers";
import { Segments } from "../../controls/Segments";
import { column, timesOf } from "../../plots/loadLines";
import { Plot, type Line } from "../../plots/Plot";
import type { RobotMessage, WalkMessage } from "../../protocol";
import { triple } from "../../scene/kinematics";
import { legColours } from "../../scene/palette";
import { usePlayback } from "../../state/playback";
import { JOINTS } from "../angleText";
import { useInputs } from "../useInputs";

const KINDS = [...JOINTS, "margin"] as const;
type Kind = (typeof KINDS)[number];

/** Joint angles and stability margin over the walk. A click sets the playback time. */
export function WalkPlots({ walk }: { walk: WalkMessage }) {
  const { robot } = useInputs();
  const theme = useTheme((one) => one.theme);
  const [kind, setKind] = useState<Kind>("coxa");
  const mark = useRef<((time: number) => void) | null>(null);
  const x = useMemo(() => timesOf(walk), [walk]);
  const lines = useMemo(() => linesOf(robot, walk, kind, theme === "dark"), [robot, walk, kind, theme]);
  useEffect(() => usePlayback.subscribe(({ time }) => mark.current?.(time)), []);
  const unit = kind === "margin" ? "mm" : "°";
  return (
    <details>
      <summary>Joint angles and stability margin over time</summary>
      <div className="inside">
        <div className="row">
          <Segments
            label="Quantity"
            testId="walk-plot"
            value={kind}
            options={KINDS.map((name) => ({ value: name, label: name }))}
            onChange={setKind}
          />
        </div>
        <Plot
          summary={summaryOf(kind, lines, unit)}
          x={x}
          lines={lines}
          unit={unit}
          height={170}
          onPick={(time) => usePlayback.setState({ time, playing: false })}
          onMark={(move) => {
            mark.current = move;
            move?.(usePlayback.getState().time);
          }}
        />
      </div>
    </details>
  );
}

function linesOf(robot: RobotMessage, walk: WalkMessage, kind: Kind, dark: boolean): Line[] {
  if (kind === "margin") {
    const values = Float64Array.from(walk.margin_mm, (margin) => margin ?? NaN);
    return [{ label: "margin", colour: dark ? "#66cf96" : "#17703c", values }];
  }
  const colours = legColours(robot.leg_names.map((_, leg) => triple(robot.mount_mm, leg)));
  const width = robot.leg_codes.length * 3;
  return robot.leg_codes.map((code, leg) => ({
    label: code,
    colour: colours[leg] ?? "#888888",
    values: column(walk.angles_deg, width, leg * 3 + JOINTS.indexOf(kind)),
  }));
}

function summaryOf(kind: Kind, lines: readonly Line[], unit: string): string {
  const values = lines.flatMap((line) => Array.from(line.values)).filter(Number.isFinite);
  const low = values.reduce((least, value) => Math.min(least, value), Infinity);
  const high = values.reduce((most, value) => Math.max(most, value), -Infinity);
  const what = kind === "margin" ? "Stability margin" : `Angles of the ${kind} joints`;
  return `${what} over the walk, from ${fixed(low, 1)} to ${fixed(high, 1)} ${unit}.`;
}
