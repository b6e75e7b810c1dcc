import { useEffect, useMemo, useRef, useState } from "react";

import { useTheme } from "../../app/theme";
import { Segments } from "../../controls/Segments";
import { fixed } from "../../controls/numbers";
import { timesOf, torqueLines } from "../../plots/loadLines";
import { Plot } from "../../plots/Plot";
import type { LoadsMessage } from "../../protocol";
import { triple } from "../../scene/kinematics";
import { legColours } from "../../scene/palette";
import { usePlayback } from "../../state/playback";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { JOINTS } from "../angleText";

type Joint = (typeof JOINTS)[number];

/** Torques over the walk for one kind of joint, with the limits of the servos. A click sets the playback time. */
export function TorquePlots({ loads }: { loads: LoadsMessage }) {
  const { robot, state } = useInputs();
  const walk = useStudio((studio) => studio.walk);
  const theme = useTheme((one) => one.theme);
  const [joint, setJoint] = useState<Joint>("femur");
  const mark = useRef<((time: number) => void) | null>(null);
  const factor = state.loads.safety_factor;

  const colours = useMemo(
    () => legColours(robot.leg_names.map((_, leg) => triple(robot.mount_mm, leg))),
    [robot],
  );
  const x = useMemo(() => (walk ? timesOf(walk) : new Float64Array()), [walk]);
  const lines = useMemo(
    () =>
      torqueLines(
        robot,
        loads,
        JOINTS.indexOf(joint),
        colours,
        theme === "dark" ? "#ff8188" : "#b3121f",
        factor,
      ),
    [robot, loads, joint, colours, theme, factor],
  );
  useEffect(() => usePlayback.subscribe(({ time }) => mark.current?.(time)), []);

  const peak = loads.joints
    .filter((one) => one.joint === joint)
    .reduce((most, one) => Math.max(most, one.peak_nm), 0);
  return (
    <fieldset>
      <legend>Torque over time</legend>
      <div className="row">
        <Segments
          label="Kind of joint"
          testId="plot-joint"
          value={joint}
          options={JOINTS.map((name) => ({ value: name, label: name }))}
          onChange={setJoint}
        />
      </div>
      {x.length === lines[0]?.values.length && (
        <Plot
          summary={`Torques of the ${joint} joints over the walk. Maximum: ${fixed(peak, 2)} N m.`}
          x={x}
          lines={lines}
          unit="N m"
          height={190}
          onPick={(time) => usePlayback.setState({ time, playing: false })}
          onMark={(move) => {
            mark.current = move;
            move?.(usePlayback.getState().time);
          }}
        />
      )}
      <ul className="legend">
        {robot.leg_codes.map((code, leg) => (
          <li key={code}>
            <i style={{ background: colours[leg] }} />
            {code}
          </li>
        ))}
        <li>
          <i className="dashed" /> stall; stall ÷ {factor}
        </li>
      </ul>
    </fieldset>
  );
}
