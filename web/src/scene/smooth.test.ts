import { describe, expect, it } from "vitest";

import { forceText } from "./forceText";
import { roomFor, smoothed } from "./smooth";

const curve = (...points: number[][]) => {
  const flat = smoothed(new Float32Array(points.flat()), roomFor(points.length));
  return Array.from({ length: flat.length / 3 }, (_, i) => Array.from(flat.subarray(i * 3, i * 3 + 3)));
};

describe("a smooth trail", () => {
  it("passes through all points", () => {
    const points = [
      [0, 0, 0],
      [10, 5, 20],
      [30, 0, 5],
    ];
    const found = curve(...points);
    points.forEach((point) => expect(found).toContainEqual(point));
    expect(found[0]).toEqual(points[0]);
    expect(found.at(-1)).toEqual(points[2]);
  });

  it("has no corners: it turns by less at each of its points than the points do", () => {
    const found = curve([0, 0, 0], [10, 0, 0], [20, 10, 0], [30, 10, 0]);
    const angles = found.slice(1).map((to, i) => {
      const from = found[i] ?? to;
      return Math.atan2((to[1] ?? 0) - (from[1] ?? 0), (to[0] ?? 0) - (from[0] ?? 0));
    });
    const turns = angles.slice(1).map((angle, i) => Math.abs(angle - (angles[i] ?? angle)));
    expect(Math.max(...turns)).toBeLessThan(Math.PI / 6);
  });

  it("stays on a straight line, and never goes below the ground", () => {
    expect(curve([0, 0, 0], [8, 8, 0], [16, 16, 0]).every(([x, y]) => x === y)).toBe(true);
    const landing = curve([0, 0, 40], [5, 0, 5], [5, 0, 0], [5, 0, 0], [5, 0, 12]);
    expect(Math.min(...landing.map(([, , z]) => z ?? 0))).toBe(0);
  });
});

describe("the force on a foot", () => {
  it("is labelled in newtons where there is one", () => {
    const forces = new Float32Array([0, 0, 10.24, 0, 0, 0, 60, 80, 0]);
    expect([0, 1, 2].map((leg) => forceText(forces, leg))).toEqual(["10.2 N", "", "100 N"]);
    expect(forceText(null, 0)).toBe("");
  });
});
