import type { DriveFrame, FrameMachine } from "../protocol";

/** A frame of driving for tests: a standing robot, with the given fields changed. */
export function aDriveFrame(changes: Partial<DriveFrame> = {}): DriveFrame {
  return {
    id: 1,
    type: "frame",
    time_s: 1,
    state: "standing",
    activity: "standing",
    guard: "passing",
    gait: "tripod",
    position_mm: [0, 0, 110],
    rpy_deg: [0, 0, 0],
    heading_deg: 0,
    angles_deg: Array.from({ length: 18 }, () => 0),
    contacts: "111111",
    belly: false,
    margin_mm: 50,
    com_mm: [0, 0],
    twist: [0, 0, 0],
    limitations: [],
    intervention_count: 0,
    interventions: [],
    physics: null,
    machine: null,
    ...changes,
  };
}

/** What the servos of a robot that runs measure, for tests. */
export function aFrameMachine(changes: Partial<FrameMachine> = {}): FrameMachine {
  return {
    angles_deg: Array.from({ length: 18 }, () => 0),
    behind_deg: 1.5,
    behind_joint: "LF femur",
    voltage_v: 7.4,
    temperature_c: 40,
    temperature_joint: "LF tibia",
    rate_hz: 100,
    missed: 0,
    stopped: false,
    problems: [],
    ...changes,
  };
}
