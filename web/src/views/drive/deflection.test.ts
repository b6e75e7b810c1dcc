import { describe, expect, it } from "vitest";

import {
  gamepadDeflection,
  isCentred,
  isDriveKey,
  keyDeflection,
  stickDeflection,
  sumOf,
} from "./deflection";

describe("keys", () => {
  it("walk and turn", () => {
    expect(keyDeflection(new Set(["w", "q"]))).toEqual({ forward: 1, left: 0, turn: 1 });
    expect(keyDeflection(new Set(["d"]))).toEqual({ forward: 0, left: -1, turn: 0 });
  });

  it("are the arrow keys too", () => {
    expect(keyDeflection(new Set(["arrowup", "arrowright"]))).toEqual({ forward: 1, left: 0, turn: -1 });
    expect(keyDeflection(new Set(["q", "arrowleft"])).turn).toBe(1);
    expect(["ArrowUp", "ArrowLeft", "w", "x"].map(isDriveKey)).toEqual([true, true, true, false]);
  });

  it("cancel if opposite, and are not faster diagonally", () => {
    expect(isCentred(keyDeflection(new Set(["w", "s"])))).toBe(true);
    const diagonal = keyDeflection(new Set(["w", "a"]));
    expect(Math.hypot(diagonal.forward, diagonal.left)).toBeCloseTo(1);
  });
});

describe("sticks", () => {
  it("have a dead workspace, from whose edge the deflection grows continuously", () => {
    expect(stickDeflection(0.1, -0.05)).toEqual({ x: 0, y: 0 });
    expect(stickDeflection(0.121, 0).x).toBeLessThan(0.01);
    expect(stickDeflection(1, 0).x).toBeCloseTo(1);
  });

  it("never exceed full deflection", () => {
    const { x, y } = stickDeflection(1, 1);
    expect(Math.hypot(x, y)).toBeCloseTo(1);
  });

  it("of a gamepad walk forward if pushed away, and turn left if pushed left", () => {
    expect(gamepadDeflection([0, -1, -1, 0])).toEqual({ forward: 1, left: 0, turn: 1 });
    expect(isCentred(gamepadDeflection([]))).toBe(true);
  });
});

describe("the sum", () => {
  it("is limited to the full range", () => {
    const full = { forward: 1, left: 1, turn: 1 };
    const sum = sumOf([full, full]);
    expect(Math.hypot(sum.forward, sum.left)).toBeCloseTo(1);
    expect(sum.turn).toBe(1);
  });
});
