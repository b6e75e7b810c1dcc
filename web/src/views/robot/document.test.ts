import { describe, expect, it } from "vitest";

import type { RobotFile } from "../../protocol";
import { numberAt, pathText, withoutKey, withServos, withValue } from "./document";

const FILE: RobotFile = {
  name: "test",
  leg: { coxa_mm: 50, limits_deg: { coxa: [-60, 60] } },
  legs: [
    { name: "a", position_mm: [1, 2, 3], yaw_deg: 30 },
    { name: "b", position_mm: [4, 5, 6], yaw_deg: -30, servo: "MG996R" },
  ],
};

describe("a robot file", () => {
  it("is not modified when a value is set", () => {
    const next = withValue(FILE, ["legs", 1, "position_mm", 0], 9);
    expect(numberAt(next, ["legs", 1, "position_mm", 0])).toBe(9);
    expect(numberAt(FILE, ["legs", 1, "position_mm", 0])).toBe(4);
    expect(next.legs[0]).toBe(FILE.legs[0]);
  });

  it("gets the tables and lists that a value needs", () => {
    expect(withValue(FILE, ["body", "size_mm", 1], 80, [100, 100, 40]).body).toEqual({
      size_mm: [100, 80, 40],
    });
    expect(withValue(FILE, ["leg", "mass_kg", "femur"], 0.1).leg?.mass_kg).toEqual({ femur: 0.1 });
  });

  it("loses a removed key, its list, and empty tables", () => {
    expect(withoutKey(FILE, ["leg", "limits_deg", "coxa", 1]).leg).toEqual({ coxa_mm: 50 });
    expect(withoutKey(FILE, ["leg", "coxa_mm"]).leg).toEqual({ limits_deg: { coxa: [-60, 60] } });
    expect(withoutKey(FILE, ["legs", 1, "servo"]).legs[1]).toEqual({
      name: "b",
      position_mm: [4, 5, 6],
      yaw_deg: -30,
    });
  });

  it("is unchanged if the key is missing", () => {
    expect(withoutKey(FILE, ["body", "mass_kg"])).toEqual(FILE);
  });

  it("has null for missing values", () => {
    expect(numberAt(FILE, ["body", "mass_kg"])).toBeNull();
    expect(numberAt(FILE, ["name"])).toBeNull();
  });

  it("gets the servos of all legs, including legs with their own", () => {
    const next = withServos(FILE, "A", "B", "B");
    expect(next.leg?.servo).toEqual({ coxa: "A", femur: "B", tibia: "B" });
    expect(next.legs[1]).not.toHaveProperty("servo");
    expect(withServos(FILE, "A", "A", "A").leg?.servo).toBe("A");
  });

  it("has paths as in error messages", () => {
    expect(pathText(["legs", 2, "position_mm", 0])).toBe("legs[2].position_mm[0]");
  });
});
