import type { RobotMessage } from "../protocol";
import { POINTS, quaternionOf, turn, type Quaternion, type Shape, type Vec3 } from "./frame";

const DEGREE = Math.PI / 180;

/**
 * Points of all legs in the ground frame [mm], as the comment of RobotMessage gives them: legs x 4 points x 3.
 *
 * `angles` are legs x (coxa, femur, tibia) [deg].
 */
export function legPoints(
  robot: RobotMessage,
  angles: ArrayLike<number>,
  position: Vec3,
  rotation: Quaternion,
): Float32Array {
  const legs = robot.leg_names.length;
  const points = new Float32Array(legs * POINTS * 3);
  for (let leg = 0; leg < legs; leg++) {
    pointsInBody(robot, angles, leg).forEach((point, i) => {
      const [x, y, z] = turn(rotation, point);
      points.set([position[0] + x, position[1] + y, position[2] + z], (leg * POINTS + i) * 3);
    });
  }
  return points;
}

/** Coxa axis, femur axis, knee and foot of one leg in the body frame [mm]. */
export function pointsInBody(
  robot: RobotMessage,
  angles: ArrayLike<number>,
  leg: number,
): [Vec3, Vec3, Vec3, Vec3] {
  const number = (list: ArrayLike<number>, i: number) => list[i] ?? 0;
  const [c, f, t] = [0, 1, 2].map((joint) => number(angles, leg * 3 + joint) * DEGREE) as [
    number,
    number,
    number,
  ];
  const direction = number(robot.mount_yaw_deg, leg) * DEGREE + c;
  const [outX, outY] = [Math.cos(direction), Math.sin(direction)];
  const sideways = number(robot.femur_axis_offset_mm, leg * 2);
  const step = (from: Vec3, out: number, left: number, up: number): Vec3 => [
    from[0] + out * outX - left * outY,
    from[1] + out * outY + left * outX,
    from[2] + up,
  ];
  const [coxa, femur, tibia] = [robot.coxa_mm, robot.femur_mm, robot.tibia_mm].map((list) =>
    number(list, leg),
  ) as [number, number, number];
  const mount: Vec3 = [
    number(robot.mount_mm, leg * 3),
    number(robot.mount_mm, leg * 3 + 1),
    number(robot.mount_mm, leg * 3 + 2),
  ];
  const axis = step(mount, coxa, sideways, number(robot.femur_axis_offset_mm, leg * 2 + 1));
  const knee = step(axis, femur * Math.cos(f), 0, femur * Math.sin(f));
  const foot = step(knee, tibia * Math.cos(f + t), 0, tibia * Math.sin(f + t));
  return [mount, axis, knee, foot];
}

/** Dimensions that the scene needs. */
export function shapeOf(robot: RobotMessage): Shape {
  const legs = robot.leg_names.map((_, leg) => leg);
  const size = robot.body_size_mm;
  return {
    names: robot.leg_names,
    short: robot.leg_codes,
    mounts: legs.map((leg) => triple(robot.mount_mm, leg)),
    size: size ? triple(size, 0) : null,
    footRadius: robot.foot_radius_mm,
    reach: Math.max(
      ...legs.map(
        (leg) => (robot.coxa_mm[leg] ?? 0) + (robot.femur_mm[leg] ?? 0) + (robot.tibia_mm[leg] ?? 0),
      ),
    ),
    stall: robot.stall_torque_nm,
  };
}

/** The i-th triple of a flat list. */
export function triple(list: ArrayLike<number>, i: number): Vec3 {
  return [list[i * 3] ?? 0, list[i * 3 + 1] ?? 0, list[i * 3 + 2] ?? 0];
}

/** Rotation from the i-th roll, pitch and yaw of a flat list [deg]. */
export function rotationOf(rpy: ArrayLike<number>, i = 0): Quaternion {
  return quaternionOf(...triple(rpy, i));
}
