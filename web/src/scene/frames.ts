import type {
  BringUpMessage,
  DriveFrame,
  FrameMachine,
  FramePhysics,
  LoadsMessage,
  PoseMessage,
  RobotMessage,
  SimulatedMessage,
  WalkMessage,
} from "../protocol";
import { POINTS, quaternionOf, type Frame, type LegTrouble, type Placed, type Vec3 } from "./frame";
import { legPoints, rotationOf, triple } from "./kinematics";

const REACH_TEXTS: Record<string, string> = {
  TOO_FAR: "too far",
  TOO_NEAR: "too near",
  COXA_LIMIT: "coxa at its limit",
  FEMUR_LIMIT: "femur at its limit",
  TIBIA_LIMIT: "tibia at its limit",
  BELOW_GROUND: "below ground",
};
/** Names of the codes of Reach in a walk. */
const CODES = ["OK", "TOO_FAR", "TOO_NEAR", "COXA_LIMIT", "FEMUR_LIMIT", "TIBIA_LIMIT", "BELOW_GROUND"];

export function contactsOf(text: string): boolean[] {
  return Array.from(text, (mark) => mark === "1");
}

/** The robot standing or at rest. */
export function frameOfPose(robot: RobotMessage, pose: PoseMessage): Frame {
  const position = triple(pose.position_mm, 0);
  const rotation = rotationOf(pose.rpy_deg);
  const points = legPoints(robot, pose.angles_deg, position, rotation);
  return {
    points,
    position,
    rotation,
    contacts: contactsOf(pose.contacts),
    // Every fourth point is a foot, which `contacts` shows.
    touching: contactsOf(pose.points_down).flatMap((down, i) =>
      down && i % POINTS !== 3 ? [triple(points, i)] : [],
    ),
    support: Array.from({ length: pose.support_mm.length / 2 }, (_, i) => [
      pose.support_mm[i * 2] ?? 0,
      pose.support_mm[i * 2 + 1] ?? 0,
    ]),
    com: triple(pose.com_mm, 0),
    margin: pose.margin_mm,
    state: null,
    motion: null,
    belly: false,
    limitations: 0,
    ...AS_PLANNED,
    trouble: troubles(robot, pose),
    forces: pose.forces_n ? new Float32Array(pose.forces_n) : null,
    torques: pose.torques_nm ? new Float32Array(pose.torques_nm) : null,
  };
}

function troubles(robot: RobotMessage, pose: PoseMessage): (LegTrouble | null)[] {
  return robot.leg_names.map((_, leg) => {
    const problem = pose.legs.find((one) => one.leg === leg);
    if (problem) {
      const miss = `${problem.miss_mm.toFixed(problem.miss_mm < 10 ? 1 : 0)} mm`;
      return {
        short: `${REACH_TEXTS[problem.reach] ?? problem.reach}: ${miss}`,
        text: problem.text,
        goal: triple(pose.feet_mm, leg),
      };
    }
    const broken = pose.limits.find((one) => one.leg === leg);
    if (!broken) return null;
    const past = Math.max(broken.low_deg - broken.angle_deg, broken.angle_deg - broken.high_deg);
    return { short: `${broken.joint} ${past.toFixed(1)}° past its limit`, text: broken.text, goal: null };
  });
}

/** What a planned walk and one in physics have in common. */
export type Samples = Pick<
  WalkMessage,
  "rate_hz" | "count" | "position_mm" | "rpy_deg" | "angles_deg" | "contacts" | "margin_mm" | "com_mm"
> & { reach?: string[] | null };

/** A walk at a time [s], interpolated between its samples; with loads also forces and torques. */
export function frameOfWalk(
  robot: RobotMessage,
  walk: Samples,
  loads: LoadsMessage | null,
  time: number,
): Frame {
  const at = Math.min(walk.count - 1, Math.max(0, time * walk.rate_hz));
  const i = Math.floor(at);
  const k = Math.min(walk.count - 1, i + 1);
  const t = at - i;
  const mix = (list: readonly number[], width: number) => between(list, width, i, k, t);
  const position = triple(mix(walk.position_mm, 3), 0);
  const rotation = quaternionOf(...triple(mix(walk.rpy_deg, 3), 0));
  const legs = robot.leg_names.length;
  const com = mix(walk.com_mm, 2);
  const [m, n] = [walk.margin_mm[i] ?? null, walk.margin_mm[k] ?? null];
  return {
    points: legPoints(robot, mix(walk.angles_deg, legs * 3), position, rotation),
    position,
    rotation,
    contacts: contactsOf(walk.contacts[i] ?? ""),
    touching: [],
    support: null,
    com: [com[0] ?? 0, com[1] ?? 0, position[2]],
    margin: m !== null && n !== null ? m + (n - m) * t : m,
    state: null,
    motion: null,
    belly: false,
    limitations: 0,
    ...AS_PLANNED,
    trouble: codeTroubles(walk.reach?.[i], legs),
    forces: loads ? mix(loads.forces_n, legs * 3) : null,
    torques: loads ? mix(loads.torques_nm, legs * 3) : null,
  };
}

/**
 * The stability margin in physics; null where it is negative: for a moment too few feet may bear the robot, which does
 * not fall by that. Whether it does is not a matter of statics then.
 */
function physicalMargin(margin: number | null): number | null {
  return margin !== null && margin >= 0 ? margin : null;
}

/** A walk in physics at a time [s], with the plan as its ghost. */
export function frameOfSimulated(
  robot: RobotMessage,
  simulated: SimulatedMessage,
  walk: WalkMessage,
  time: number,
): Frame {
  const legs = robot.leg_names.length;
  const i = Math.min(simulated.count - 1, Math.max(0, Math.round(time * simulated.rate_hz)));
  const frame = frameOfWalk(robot, simulated, null, time);
  return {
    ...frame,
    margin: physicalMargin(frame.margin),
    ghost: frameOfWalk(robot, walk, null, time),
    forces: new Float32Array(simulated.forces_n.slice(i * legs * 3, (i + 1) * legs * 3)),
    physical: {
      slip: new Float32Array(simulated.slip_mm_s.slice(i * legs, (i + 1) * legs)),
      saturated: contactsOf(simulated.saturated[i] ?? ""),
      tilt: simulated.tilt_deg[i] ?? 0,
      fallen: simulated.fell_at_s !== null && time >= simulated.fell_at_s,
    },
  };
}

/** Interpolate between two rows of a flat list, at fraction t. */
function between(list: readonly number[], width: number, i: number, k: number, t: number): Float32Array {
  const row = new Float32Array(width);
  for (let n = 0; n < width; n++) {
    const from = list[i * width + n] ?? 0;
    row[n] = from + ((list[k * width + n] ?? 0) - from) * t;
  }
  return row;
}

function codeTroubles(codes: string | undefined, legs: number): (LegTrouble | null)[] {
  return Array.from({ length: legs }, (_, leg) => {
    const code = CODES[Number(codes?.[leg] ?? 0)] ?? "OK";
    const words = REACH_TEXTS[code];
    return words ? { short: words, text: words, goal: null } : null;
  });
}

/** What a frame without physics has. */
const AS_PLANNED = { ghost: null, physical: null, highlight: null };

/** Height over the ground of the feet of a robot on a box [mm], in its default stance. */
const BOX = 90;

/** A robot on a box, whose servos are brought up. */
export function frameOfBringUp(robot: RobotMessage, bringUp: BringUpMessage): Frame {
  const position: Vec3 = [0, 0, robot.body_height_mm + BOX];
  const rotation = quaternionOf(0, 0, 0);
  const legs = robot.leg_names.map(() => null);
  const { leg = null, joint = null } = bringUp.question ?? {};
  return {
    ...AS_PLANNED,
    points: legPoints(robot, bringUp.angles_deg, position, rotation),
    position,
    rotation,
    contacts: legs.map(() => false),
    touching: [],
    support: [],
    com: null,
    margin: null,
    state: null,
    motion: null,
    belly: false,
    limitations: 0,
    trouble: legs,
    forces: null,
    torques: null,
    highlight: { leg, joint },
  };
}

/** The robot that is driven, after a tick. */
export function frameOfDrive(robot: RobotMessage, drive: DriveFrame): Frame {
  const shown = drive.physics ?? drive;
  const position = triple(shown.position_mm, 0);
  const rotation = rotationOf(shown.rpy_deg);
  return {
    points: legPoints(robot, shown.angles_deg, position, rotation),
    position,
    rotation,
    contacts: contactsOf(shown.contacts),
    touching: [],
    support: drive.belly ? [] : null,
    com: drive.com_mm && [drive.com_mm[0] ?? 0, drive.com_mm[1] ?? 0, position[2]],
    margin: drive.margin_mm,
    state: drive.state,
    motion: { speed: Math.hypot(drive.twist[0] ?? 0, drive.twist[1] ?? 0), heading: drive.heading_deg },
    belly: drive.belly,
    limitations: drive.limitations.length,
    trouble: robot.leg_names.map(() => null),
    forces: drive.physics && new Float32Array(drive.physics.forces_n),
    torques: null,
    ...(drive.physics ? drivenInPhysics(robot, drive, drive.physics) : AS_PLANNED),
    ...(drive.machine && asMeasured(robot, drive, drive.machine)),
  };
}

/** The joint angles that are measured, with the commanded ones as the ghost; where the body is is not measured. */
function asMeasured(robot: RobotMessage, drive: DriveFrame, machine: FrameMachine): Partial<Frame> {
  const position = triple(drive.position_mm, 0);
  const rotation = rotationOf(drive.rpy_deg);
  const placed = (angles: number[]): Placed => ({
    points: legPoints(robot, angles, position, rotation),
    position,
    rotation,
  });
  const measured = drive.angles_deg.map((angle, i) => machine.angles_deg[i] ?? angle);
  return { ...placed(measured), ghost: placed(drive.angles_deg) };
}

function drivenInPhysics(robot: RobotMessage, drive: DriveFrame, physics: FramePhysics) {
  return {
    margin: physicalMargin(drive.margin_mm),
    highlight: null,
    ghost: commandedAt(robot, drive, physics),
    physical: {
      slip: new Float32Array(physics.slip_mm_s),
      saturated: contactsOf(physics.saturated),
      tilt: physics.tilt_deg,
      fallen: physics.fallen,
    },
  };
}

/** The commanded robot over the place where it is: far from there, nothing could be compared. */
function commandedAt(robot: RobotMessage, drive: DriveFrame, physics: FramePhysics): Placed {
  const position = triple(physics.position_mm, 0);
  const [roll, pitch] = triple(drive.rpy_deg, 0);
  const rotation = quaternionOf(roll, pitch, triple(physics.rpy_deg, 0)[2]);
  return { points: legPoints(robot, drive.angles_deg, position, rotation), position, rotation };
}
