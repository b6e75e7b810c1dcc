import { describe, expect, it } from "vitest";

import { changedKey } from "./edited";

describe("the input that was changed", () => {
  it("is named as in error messages", () => {
    expect(changedKey({ stroke_mm: null }, { stroke_mm: 500 })).toBe("stroke_mm");
    const curve = { path: { kind: "curve", angle_deg: 60, centre_mm: [0, 500] }, stroke_mm: null };
    expect(changedKey(curve, { ...curve, path: { ...curve.path, centre_mm: [0, 90] } })).toBe(
      "path.centre_mm[1]",
    );
    expect(changedKey({ leg: { coxa_mm: 5 } }, { leg: { coxa_mm: 5, mass_kg: { femur: 1 } } })).toBe(
      "leg.mass_kg",
    );
  });

  it("is a whole table where its kind changes", () => {
    expect(changedKey({ gait: "tripod" }, { gait: { duty_factor: 0.5, offsets: [0] } })).toBe("gait");
    expect(changedKey({ angles_deg: null }, { angles_deg: [1, 2, 3] })).toBe("angles_deg");
  });

  it("is none where nothing changes", () => {
    expect(changedKey({ a: [1, NaN], b: null }, { a: [1, NaN], b: null })).toBeNull();
  });
});
