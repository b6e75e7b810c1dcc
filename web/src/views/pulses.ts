import { fixed } from "../controls/numbers";
import type { CalibrationMessage } from "../protocol";
import { JOINTS } from "./angleText";

type Calibration = Pick<
  CalibrationMessage,
  "unit" | "zero" | "per_deg" | "low" | "high" | "low_deg" | "high_deg"
>;

/** Angles are sent with three decimals [deg]. */
const ROUNDING = 0.0006;

/** The command of a joint, and whether its angle is beyond what the calibration allows. */
export function pulseOf(
  calibration: Calibration,
  joint: number,
  angle: number,
): { command: number; beyond: boolean } {
  const at = (list: readonly number[]) => list[joint] ?? 0;
  const exact = at(calibration.zero) + at(calibration.per_deg) * angle;
  const beyond = angle < at(calibration.low_deg) - ROUNDING || angle > at(calibration.high_deg) + ROUNDING;
  const inside = Math.min(Math.max(Math.round(exact), at(calibration.low)), at(calibration.high));
  return { command: beyond ? Math.round(exact) : inside, beyond };
}

/** Joints whose angles are beyond the calibration, with their bounds. */
export function beyondTexts(
  codes: readonly string[],
  calibration: Calibration,
  angles: ArrayLike<number>,
): string[] {
  return codes.flatMap((code, leg) =>
    JOINTS.flatMap((joint, i) => {
      const at = leg * JOINTS.length + i;
      if (!pulseOf(calibration, at, angles[at] ?? 0).beyond) return [];
      const [low, high] = [calibration.low_deg[at] ?? 0, calibration.high_deg[at] ?? 0];
      return [
        `${code} ${joint} is at ${fixed(angles[at] ?? 0, 1)}°; the calibration allows ${fixed(low, 1)}° to ${fixed(high, 1)}°`,
      ];
    }),
  );
}

/** The commands as tab-separated text for spreadsheets; the unit is in the head, where all joints have the same. */
export function pulseTable(
  codes: readonly string[],
  calibration: Calibration,
  angles: ArrayLike<number>,
): string {
  const units = new Set(calibration.unit);
  const [unit] = units.size === 1 ? units : [];
  const rows = codes.map((code, leg) =>
    [
      code,
      ...JOINTS.map((_, i) => {
        const at = leg * JOINTS.length + i;
        const { command } = pulseOf(calibration, at, angles[at] ?? 0);
        return unit ? String(command) : `${command} ${calibration.unit[at] ?? ""}`;
      }),
    ].join("\t"),
  );
  return [["leg", ...JOINTS.map((joint) => (unit ? `${joint}_${unit}` : joint))].join("\t"), ...rows].join(
    "\n",
  );
}
