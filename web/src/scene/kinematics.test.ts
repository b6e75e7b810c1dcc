import { describe, expect, it } from "vitest";

import { aRobot } from "../testing/robot";
import { footOf, quaternionOf, turn } from "./frame";
import { frameOfWalk } from "./frames";
import { footTrails } from "./trails";
import { legPoints, pointsInBody } from "./kinematics";
import { aWalk } from "../testing/walk";

const robot = aRobot();
const STRAIGHT = robot.leg_names.flatMap(() => [0, 0, 0]);

describe("points of a leg", () => {
  it("are in a horizontal line outward if all angles are zero", () => {
    const [mount, axis, knee, foot] = pointsInBody(robot, STRAIGHT, 1);
    expect(mount).toEqual([0, 86, 0]);
    [68, 68 + 98, 68 + 98 + 181].forEach((far, i) => {
      const point = [axis, knee, foot][i];
      expect(point?.[0]).toBeCloseTo(0, 9);
      expect(point?.[1]).toBeCloseTo(86 + far, 9);
      expect(point?.[2]).toBeCloseTo(0, 9);
    });
  });

  it("keep the lengths of the links for any angles and body pose", () => {
    const angles = STRAIGHT.map((_, i) => ((i * 37) % 110) - 55);
    const points = legPoints(robot, angles, [10, -20, 130], quaternionOf(12, -7, 33));
    for (let leg = 0; leg < 6; leg++) {
      [68, 98, 181].forEach((length, link) => {
        const at = (leg * 4 + link) * 3;
        const gap = [0, 1, 2].map((k) => (points[at + 3 + k] ?? 0) - (points[at + k] ?? 0));
        expect(Math.hypot(...gap)).toBeCloseTo(length, 3);
      });
    }
  });

  it("rotate the offset of the femur axis with the coxa", () => {
    const offset = { ...robot, femur_axis_offset_mm: robot.leg_names.flatMap(() => [5, 3]) };
    const [, axis] = pointsInBody(offset, [90, 0, 0], 0);
    // The leg points at 30 deg; turned by 90 it points at 120, and its left is at 210.
    const at = (degrees: number) => [
      Math.cos((degrees * Math.PI) / 180),
      Math.sin((degrees * Math.PI) / 180),
    ];
    expect(axis[0]).toBeCloseTo(74.478 + 68 * (at(120)[0] ?? 0) + 5 * (at(210)[0] ?? 0), 6);
    expect(axis[1]).toBeCloseTo(43 + 68 * (at(120)[1] ?? 0) + 5 * (at(210)[1] ?? 0), 6);
    expect(axis[2]).toBeCloseTo(3, 9);
  });

  it("raise the foot for positive femur and tibia angles", () => {
    expect(pointsInBody(robot, [0, 30, 0], 0)[3][2]).toBeCloseTo(279 * Math.sin(Math.PI / 6), 6);
    expect(pointsInBody(robot, [0, 0, 90], 0)[3][2]).toBeCloseTo(181, 6);
  });
});

describe("rotations", () => {
  it("are yaw after pitch after roll", () => {
    const q = quaternionOf(90, 0, 90);
    // Roll takes y to z; yaw takes x to y and leaves z.
    const [x, y, z] = [turn(q, [1, 0, 0]), turn(q, [0, 1, 0]), turn(q, [0, 0, 1])];
    [
      [x, [0, 1, 0]],
      [y, [0, 0, 1]],
      [z, [1, 0, 0]],
    ].forEach(([got, expected]) =>
      got?.forEach((value, i) => expect(value).toBeCloseTo(expected?.[i] ?? 0, 9)),
    );
  });

  it("lower the front for a positive pitch", () => {
    expect(turn(quaternionOf(0, 10, 0), [1, 0, 0])[2]).toBeLessThan(0);
  });
});

describe("a walk", () => {
  const walk = aWalk();

  it("equals its samples at their times, and is interpolated between them", () => {
    expect(frameOfWalk(robot, walk, null, 0).position[0]).toBe(0);
    expect(frameOfWalk(robot, walk, null, 0.1).position[0]).toBeCloseTo(10, 4);
    expect(frameOfWalk(robot, walk, null, 0.125).position[0]).toBeCloseTo(12.5, 4);
  });

  it("is constant before its start and after its end", () => {
    expect(frameOfWalk(robot, walk, null, -1).position[0]).toBe(0);
    expect(frameOfWalk(robot, walk, null, 99).position[0]).toBeCloseTo(20, 4);
  });

  it("names the legs out of reach, by the codes of its samples", () => {
    const stuck = { ...walk, reach: ["000000", "010000", "000000"] };
    expect(frameOfWalk(robot, stuck, null, 0.1).trouble.map((one) => one?.short ?? "")).toEqual([
      "",
      "too far",
      "",
      "",
      "",
      "",
    ]);
  });

  it("has the paths of its feet", () => {
    const trails = footTrails(robot, walk);
    const foot = footOf(frameOfWalk(robot, walk, null, 0.2), 3);
    expect(trails).toHaveLength(6);
    expect(Array.from(trails[3]?.slice(-3) ?? [])).toEqual([...foot]);
  });
});
