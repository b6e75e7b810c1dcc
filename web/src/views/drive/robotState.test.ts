import { describe, expect, it } from "vitest";

import { aDriveFrame } from "../../testing/drive";
import { canRequest, headingText, motionText, stateText } from "./robotState";

describe("requests for a state", () => {
  it("are possible unless the state is requested already", () => {
    expect(canRequest("lying", "standing", "walking")).toBe(true);
    expect(canRequest("standing", "standing", "rising")).toBe(false);
    expect(canRequest("standing", "folded", "folding")).toBe(true);
  });

  it("are possible for any other state where none was requested yet", () => {
    expect(canRequest("standing", null, "lying")).toBe(true);
    expect(canRequest("standing", null, "standing")).toBe(false);
  });

  it("can't unfold the legs without standing up", () => {
    expect(canRequest("lying", "folded", "folding")).toBe(true);
    expect(canRequest("lying", "folded", "folded")).toBe(false);
  });
});

describe("the state in words", () => {
  it("names the stage, but nothing twice", () => {
    expect(stateText(aDriveFrame({ state: "rising", activity: "push up" }))).toBe("rising: push up");
    expect(stateText(aDriveFrame({ state: "lying", activity: "lying" }))).toBe("lying");
  });

  it("names the guard's state in a fault", () => {
    expect(stateText(aDriveFrame({ state: "fault", guard: "holding" }))).toBe("fault (guard: holding)");
  });
});

describe("the heading in words", () => {
  it("names the side", () => {
    expect([12.4, -90, 0.2, -0.2].map(headingText)).toEqual(["12° left", "90° right", "0°", "0°"]);
  });
});

describe("the motion in words", () => {
  it("has the speed and the heading", () => {
    expect(motionText(84.6, -12.4)).toBe("85 mm/s, heading 12° right");
    expect(motionText(0, 0)).toBe("0 mm/s, heading 0°");
  });
});
