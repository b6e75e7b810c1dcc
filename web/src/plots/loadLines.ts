import type { LoadsMessage, RobotMessage, WalkMessage } from "../protocol";
import type { Line } from "./Plot";

/** Column `at` of a flat list of rows. */
export function column(list: ArrayLike<number>, width: number, at: number): Float64Array {
  const count = Math.floor(list.length / width);
  const values = new Float64Array(count);
  for (let i = 0; i < count; i++) values[i] = list[i * width + at] ?? 0;
  return values;
}

/** Times of a walk's samples [s]. */
export function timesOf(walk: WalkMessage): Float64Array {
  return Float64Array.from({ length: walk.count }, (_, i) => i / walk.rate_hz);
}

/** The torques of one kind of joint on all legs, and the limits of its servo. */
export function torqueLines(
  robot: RobotMessage,
  loads: LoadsMessage,
  joint: number,
  colours: readonly string[],
  limitColour: string,
  safetyFactor: number,
): Line[] {
  const legs = robot.leg_codes.length;
  const lines: Line[] = robot.leg_codes.map((code, leg) => ({
    label: code,
    colour: colours[leg] ?? "#888888",
    values: column(loads.torques_nm, legs * 3, leg * 3 + joint),
  }));
  const most = Math.max(...lines.flatMap((line) => Array.from(line.values, Math.abs)));
  const stalls = robot.stall_torque_nm.filter(
    (stall, i): stall is number => i % 3 === joint && stall !== null,
  );
  const stall = Math.min(...stalls);
  for (const [label, limit] of [
    ["stall", stall],
    ["stall / safety factor", stall / safetyFactor],
  ] as const) {
    // A limit far above the lines would compress them.
    if (!Number.isFinite(limit) || limit > 2.5 * most) continue;
    for (const sign of [1, -1]) {
      lines.push({
        label,
        colour: limitColour,
        dashed: true,
        values: new Float64Array(loads.torques_nm.length / (legs * 3)).fill(sign * limit),
      });
    }
  }
  return lines;
}
