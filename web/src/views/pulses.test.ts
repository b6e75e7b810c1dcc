import { describe, expect, it } from "vitest";

import { beyondTexts, pulseOf, pulseTable } from "./pulses";

const CALIBRATION = {
  unit: ["us", "us", "us"],
  zero: [1500, 1500.4, 1500],
  per_deg: [10, -10, 10],
  low: [1000, 1000, 1401],
  high: [2000, 2000, 1600],
  low_deg: [-50, -50, -9.95],
  high_deg: [50, 50, 10],
};

describe("the pulses of joint angles", () => {
  it("are zero and slope times angle, in whole numbers within the limits", () => {
    expect(pulseOf(CALIBRATION, 0, 12)).toEqual({ command: 1620, beyond: false });
    expect(pulseOf(CALIBRATION, 1, 12)).toEqual({ command: 1380, beyond: false });
    expect(pulseOf(CALIBRATION, 2, -9.95)).toEqual({ command: 1401, beyond: false });
  });

  it("are marked where the calibration does not allow the angle", () => {
    expect(pulseOf(CALIBRATION, 2, 10.0004).beyond).toBe(false);
    expect(pulseOf(CALIBRATION, 2, 12)).toEqual({ command: 1620, beyond: true });
    expect(beyondTexts(["LF"], CALIBRATION, [0, 0, 12])).toEqual([
      "LF tibia is at 12.0°; the calibration allows -9.9° to 10.0°",
    ]);
  });

  it("are copied with their unit", () => {
    expect(pulseTable(["LF"], CALIBRATION, [0, 0, 5])).toBe(
      "leg\tcoxa_us\tfemur_us\ttibia_us\nLF\t1500\t1500\t1550",
    );
    const mixed = { ...CALIBRATION, unit: ["us", "ticks", "us"] };
    expect(pulseTable(["LF"], mixed, [0, 0, 5])).toBe(
      "leg\tcoxa\tfemur\ttibia\nLF\t1500 us\t1500 ticks\t1550 us",
    );
  });
});
