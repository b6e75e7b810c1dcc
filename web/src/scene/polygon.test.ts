import { describe, expect, it } from "vitest";

import { convexHull, nearestOnEdge, type Point2 } from "./polygon";

const SQUARE: Point2[] = [
  [0, 0],
  [2, 0],
  [2, 2],
  [0, 2],
];

describe("convex hull", () => {
  it("omits points inside or on an edge, and is counter-clockwise", () => {
    const hull = convexHull([[1, 1], [1, 0], ...SQUARE]);
    expect(hull).toEqual(SQUARE);
  });

  it("contains all points", () => {
    const points = Array.from({ length: 60 }, (_, i): Point2 => [
      Math.sin(i * 12.9) * 50,
      Math.cos(i * 7.7) * 30,
    ]);
    const hull = convexHull(points);
    hull.forEach((a, i) => {
      const b = hull[(i + 1) % hull.length] ?? a;
      for (const [x, y] of points) {
        expect((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])).toBeGreaterThan(-1e-9);
      }
    });
  });
});

describe("nearest point of an edge", () => {
  it("is the foot of the perpendicular", () => {
    expect(nearestOnEdge(SQUARE, [1.5, 0.9])).toEqual([2, 0.9]);
  });

  it("is a corner for points beyond the edge", () => {
    expect(nearestOnEdge(SQUARE, [5, 5])).toEqual([2, 2]);
  });
});
