import { describe, expect, it } from "vitest";

import { aDriveFrame, aFrameMachine } from "../testing/drive";
import { aRobot } from "../testing/robot";
import { aFramePhysics, aSimulatedWalk } from "../testing/simulated";
import { aWalk } from "../testing/walk";
import { blend } from "./frame";
import { frameOfDrive, frameOfSimulated, frameOfWalk } from "./frames";

describe("a walk in physics", () => {
  it("has the plan as its ghost", () => {
    const [walk, simulated] = [aWalk(), aSimulatedWalk()];
    const frame = frameOfSimulated(aRobot(), simulated, walk, 0.1);
    expect(frame.position).toEqual([10, 0, 108]);
    expect(frame.ghost?.position).toEqual([10, 0, 110]);
    expect(frame.ghost?.points).toEqual(frameOfWalk(aRobot(), walk, null, 0.1).points);
    expect(frame.forces?.slice(0, 3)).toEqual(new Float32Array([0, 0, 5]));
    expect(frame.physical).toMatchObject({ tilt: 1, fallen: false });
  });

  it("has no negative stability margin: too few feet bear the robot for a moment only", () => {
    const simulated = { ...aSimulatedWalk(), margin_mm: [-20, -20, 30] };
    expect(frameOfSimulated(aRobot(), simulated, aWalk(), 0).margin).toBeNull();
    expect(frameOfSimulated(aRobot(), simulated, aWalk(), 0.2).margin).toBe(30);
  });

  it("tells of slip, full torque and the fall at their time", () => {
    const { physical } = frameOfSimulated(aRobot(), aSimulatedWalk(), aWalk(), 0.2);
    expect(physical?.slip[0]).toBe(40);
    expect(physical?.saturated.indexOf(true)).toBe(0);
    expect(physical?.fallen).toBe(true);
    expect(frameOfWalk(aRobot(), aWalk(), null, 0.2).physical).toBeNull();
  });
});

describe("a driven robot in physics", () => {
  const drive = aDriveFrame({ physics: aFramePhysics() });

  it("is shown where it is, with the commanded one over the same place", () => {
    const frame = frameOfDrive(aRobot(), drive);
    expect(frame.position).toEqual([100, 0, 105]);
    expect(frame.contacts).toEqual([true, false, true, false, true, false]);
    expect(frame.ghost?.position).toEqual(frame.position);
    expect(frame.ghost?.points).not.toEqual(frame.points);
    expect(frame.physical).toMatchObject({ tilt: 3, fallen: false });
    expect(frameOfDrive(aRobot(), aDriveFrame()).ghost).toBeNull();
  });

  it("takes the angles of the servos, as far as they are measured, and the commanded ones as the ghost", () => {
    const measured = Array.from({ length: 18 }, (_, i) => (i === 0 ? null : 2));
    const frame = frameOfDrive(aRobot(), aDriveFrame({ machine: aFrameMachine({ angles_deg: measured }) }));
    const asAsked = frameOfDrive(aRobot(), aDriveFrame());
    const moved = aDriveFrame({ angles_deg: measured.map((angle) => angle ?? 0) });
    expect(frame.points).toEqual(frameOfDrive(aRobot(), moved).points);
    expect(frame.ghost?.points).toEqual(asAsked.points);
    expect(frame.ghost?.position).toEqual(frame.position);
  });

  it("takes its ghost along between frames", () => {
    const next = {
      ...drive,
      physics: aFramePhysics({ position_mm: [110, 0, 105], fallen: true }),
    };
    const between = blend(frameOfDrive(aRobot(), drive), frameOfDrive(aRobot(), next), 0.5);
    expect(between.ghost?.position[0]).toBe(105);
    expect(between.physical?.fallen).toBe(true);
  });
});
