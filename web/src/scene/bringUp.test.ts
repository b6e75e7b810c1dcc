import { describe, expect, it } from "vitest";

import type { BringUpMessage } from "../protocol";
import { aRobot } from "../testing/robot";
import { frameOfBringUp } from "./frames";
import { footOf } from "./frame";

function aBringUp(changes: Partial<BringUpMessage> = {}): BringUpMessage {
  return {
    id: 1,
    type: "bring_up",
    state: "asking",
    file: "test.calibration.toml",
    said: [],
    question: { number: 3, title: "Zeros", text: "Hold it", choices: [], leg: 2, joint: 1 },
    known: 4,
    joints: 18,
    angles_deg: Array.from({ length: 18 }, (_, i) => [0, 0, -90][i % 3] ?? 0),
    emulated: true,
    problem: null,
    ...changes,
  };
}

describe("a robot whose servos are brought up", () => {
  it("stands on a box, feet in the air, in the angles of its servos", () => {
    const frame = frameOfBringUp(aRobot(), aBringUp());
    for (let leg = 0; leg < 6; leg++) expect(footOf(frame, leg)[2]).toBeCloseTo(110 + 90 - 181, 3);
    expect(frame.contacts).toEqual([false, false, false, false, false, false]);
    expect(frame.margin).toBeNull();
  });

  it("marks the leg and the joint of the question", () => {
    expect(frameOfBringUp(aRobot(), aBringUp()).highlight).toEqual({ leg: 2, joint: 1 });
    const none = { leg: null, joint: null };
    expect(frameOfBringUp(aRobot(), aBringUp({ question: null })).highlight).toEqual(none);
  });
});
