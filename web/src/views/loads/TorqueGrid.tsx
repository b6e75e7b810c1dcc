import { useEffect, useRef } from "react";

import { withUnit } from "../../controls/numbers";
import type { JointLoad, LoadsMessage } from "../../protocol";
import { stage } from "../../scene/stage";
import { useInputs } from "../useInputs";
import { JOINTS } from "../angleText";
import { severityOf } from "./severity";

/** A bar for each joint: peak torque over the walk, and present torque, relative to the stall torque. */
export function TorqueGrid({ loads }: { loads: LoadsMessage }) {
  const { robot } = useInputs();
  const marks = useRef<(HTMLElement | null)[]>([]);
  useEffect(
    () =>
      stage.watch(({ torques }) =>
        marks.current.forEach((mark, i) => {
          const stall = robot.stall_torque_nm[i];
          if (mark && torques && stall)
            mark.style.left = `${Math.min(100, (Math.abs(torques[i] ?? 0) / stall) * 100)}%`;
        }),
      ),
    [robot],
  );
  return (
    <table className="torques" data-testid="torques">
      <caption>Peak torque and safety factor</caption>
      <thead>
        <tr>
          <th scope="col">Leg</th>
          {JOINTS.map((joint) => (
            <th key={joint} scope="col">
              {joint}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {robot.leg_codes.map((code, leg) => (
          <tr key={code}>
            <th scope="row">{code}</th>
            {JOINTS.map((joint, i) => {
              const load = loads.joints.find((one) => one.leg === code && one.joint === joint);
              return (
                <td key={joint} title={load && `${load.text}; ${load.peak_cause}`}>
                  {load && (
                    <Bar
                      load={load}
                      onMark={(mark) => {
                        marks.current[leg * 3 + i] = mark;
                      }}
                    />
                  )}
                </td>
              );
            })}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

const SIGNS: Record<string, string> = { good: "✓", marginal: "△", unknown: "?" };

function Bar({ load, onMark }: { load: JointLoad; onMark: (mark: HTMLElement | null) => void }) {
  const fraction = load.stall_nm ? Math.min(1, load.peak_nm / load.stall_nm) : 0;
  const kind = severityOf(load.grade);
  return (
    <div className="torque">
      <span>
        {withUnit(load.peak_nm, 2, "N m")}
        <small>
          <span aria-hidden="true">{SIGNS[load.grade] ?? "⚠"} </span>
          <span className="hidden-text">{load.grade}, </span>
          {load.factor !== null && load.factor >= 100 ? ">100×" : withUnit(load.factor, 1, "×")}
        </small>
      </span>
      <div className="bar" aria-hidden="true">
        <i className={kind} style={{ width: `${fraction * 100}%` }} />
        <b ref={onMark} />
      </div>
    </div>
  );
}
