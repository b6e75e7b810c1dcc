import { describe, expect, it } from "vitest";

import { gamepadPush, isStill, keyPush, stickPush, sumOf } from "./push";

describe("keys", () => {
  it("walk and turn", () => {
    expect(keyPush(new Set(["w", "q"]))).toEqual({ forward: 1, left: 0, turn: 1 });
    expect(keyPush(new Set(["d"]))).toEqual({ forward: 0, left: -1, turn: 0 });
  });

  it("against each other are still, and aslant not faster", () => {
    expect(isStill(keyPush(new Set(["w", "s"])))).toBe(true);
    const aslant = keyPush(new Set(["w", "a"]));
    expect(Math.hypot(aslant.forward, aslant.left)).toBeCloseTo(1);
  });
});

describe("sticks", () => {
  it("are still in the middle, and grow from there without a jump", () => {
    expect(stickPush(0.1, -0.05)).toEqual({ x: 0, y: 0 });
    expect(stickPush(0.121, 0).x).toBeLessThan(0.01);
    expect(stickPush(1, 0).x).toBeCloseTo(1);
  });

  it("never push more than fully", () => {
    const { x, y } = stickPush(1, 1);
    expect(Math.hypot(x, y)).toBeCloseTo(1);
  });

  it("of a gamepad walk forward when pushed away, and turn left when pushed left", () => {
    expect(gamepadPush([0, -1, -1, 0])).toEqual({ forward: 1, left: 0, turn: 1 });
    expect(isStill(gamepadPush([]))).toBe(true);
  });
});

describe("all together", () => {
  it("stay within their bounds", () => {
    const full = { forward: 1, left: 1, turn: 1 };
    const sum = sumOf([full, full]);
    expect(Math.hypot(sum.forward, sum.left)).toBeCloseTo(1);
    expect(sum.turn).toBe(1);
  });
});
