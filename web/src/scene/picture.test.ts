import { Ray, Vector3 } from "three";
import { describe, expect, it } from "vitest";

import { CAMERAS, distanceFor, isFrom, placeCamera } from "./cameras";
import { dragPlane, intersection } from "./dragging";
import { blend, blendRotation, quaternionOf, turn, type Frame } from "./frame";

function aFrame(x: number): Frame {
  return {
    points: new Float32Array(12).fill(x),
    highlight: null,
    ghost: null,
    physical: null,
    position: [x, 0, 0],
    rotation: quaternionOf(0, 0, x),
    contacts: [x > 5],
    touching: [],
    support: null,
    com: [x, 0, 0],
    margin: x,
    state: null,
    motion: null,
    belly: false,
    limitations: 0,
    trouble: [null],
    forces: null,
    torques: null,
  };
}

describe("interpolation between frames", () => {
  it("interpolates positions and takes contacts from the second", () => {
    const middle = blend(aFrame(0), aFrame(10), 0.25);
    expect(middle.points[0]).toBeCloseTo(2.5);
    expect(middle.position[0]).toBeCloseTo(2.5);
    expect(middle.margin).toBeCloseTo(2.5);
    expect(middle.contacts).toEqual([true]);
  });

  it("does not interpolate between numbers of legs", () => {
    const other = { ...aFrame(10), points: new Float32Array(24) };
    expect(blend(aFrame(0), other, 0.1)).toBe(other);
  });

  it("rotates along the shorter path", () => {
    const [x, y] = turn(blendRotation(quaternionOf(0, 0, 170), quaternionOf(0, 0, -170), 0.5), [1, 0, 0]);
    expect(x).toBeCloseTo(-1, 6);
    expect(y).toBeCloseTo(0, 6);
  });
});

describe("cameras", () => {
  it("have the direction of their names", () => {
    for (const { name } of CAMERAS) {
      const place = placeCamera(name, [100, 50, 20], 300, 32, 1.5);
      expect(place.target).toEqual([100, 50, 20]);
      expect(isFrom(name, place)).toBe(true);
    }
    expect(isFrom("top", placeCamera("side", [0, 0, 0], 300, 32, 1.5))).toBe(false);
  });

  it("are farther away in a narrow view", () => {
    expect(distanceFor(300, 32, 0.5)).toBeGreaterThan(1.5 * distanceFor(300, 32, 1));
    expect(distanceFor(300, 32, 2)).toBe(distanceFor(300, 32, 1));
  });
});

describe("dragging", () => {
  const ray = new Ray(new Vector3(-100, 0, 100), new Vector3(1, 0, -1).normalize());

  it("is horizontal seen from above, and vertical seen from the side", () => {
    expect(dragPlane([0, 0, 40], [0.7, 0, -0.7], false).normal.toArray()).toEqual([0, 0, 1]);
    expect(dragPlane([0, 0, 40], [1, 0, -0.1], false).normal.toArray()).toEqual([1, 0, 0]);
  });

  it("uses the other plane with Shift", () => {
    expect(dragPlane([0, 0, 40], [0.7, 0, -0.7], true).normal.toArray()).toEqual([1, 0, 0]);
  });

  it("keeps the height of the handle", () => {
    expect(intersection(ray, dragPlane([0, 0, 40], [0.7, 0, -0.7], false))).toEqual([
      -40,
      0,
      expect.closeTo(40),
    ]);
  });

  it("has no intersection with a parallel ray", () => {
    const level = new Ray(new Vector3(0, 0, 100), new Vector3(1, 0, 0));
    expect(intersection(level, dragPlane([0, 0, 40], [0.7, 0, -0.7], false))).toBeNull();
  });
});
