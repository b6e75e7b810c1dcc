/** Content of the scene at one time, in the ground frame: x forward, y left, z up; mm. */

export type Vec3 = readonly [number, number, number];
/** x, y, z, w, the order of three.js. */
export type Quaternion = readonly [number, number, number, number];

/** Points of a leg: coxa axis, femur axis, knee, foot. */
export const POINTS = 4;

/** Why the request for a leg is not met. */
export interface LegTrouble {
  /** Label beside the leg, such as "12 mm too far". */
  short: string;
  /** The whole explanation, with numbers. */
  text: string;
  /** Target position of a foot that is out of reach [mm]. */
  goal: Vec3 | null;
}

/** Speed above which a foot counts as sliding [mm/s]: friction in the physics engine creeps more slowly. */
export const SLIDING = 15;

/** Where a robot is. */
export interface Placed {
  /** Legs x 4 points x 3 coordinates [mm]. */
  points: Float32Array;
  position: Vec3;
  rotation: Quaternion;
}

/** What only physics tells. */
export interface Physical {
  /** Speed of each foot's contact point over the ground [mm/s]. */
  slip: Float32Array;
  /** Legs x (coxa, femur, tibia): whether the servo is at its maximum torque. */
  saturated: readonly boolean[];
  /** Angle between the body and the planned one [deg]. */
  tilt: number;
  fallen: boolean;
}

/** A leg, or one of its joints, that a question is about; none where it is about all. */
export interface Highlight {
  leg: number | null;
  joint: number | null;
}

export interface Frame extends Placed {
  /** Of a robot whose servos are brought up, on a box; null in all other cases. */
  highlight: Highlight | null;
  /** The robot as planned or commanded, where this frame is of physics. */
  ghost: Placed | null;
  physical: Physical | null;
  contacts: readonly boolean[];
  /** Points of the legs, other than feet, that touch the ground [mm]. */
  touching: readonly Vec3[];
  /** Corners of the support polygon (x, y) [mm]; null: that of the feet in contact. */
  support: readonly (readonly [number, number])[] | null;
  /** Centre of mass [mm]; only its projection onto the ground is shown. */
  com: Vec3 | null;
  /** Distance of the projected centre of mass from the support polygon's edge [mm], negative outside. */
  margin: number | null;
  /** State of a robot that is driven; null in the other views. */
  state: string | null;
  /** Speed [mm/s] and heading [deg, positive to the left] of a robot that is driven; null in the other views. */
  motion: { speed: number; heading: number } | null;
  /** Whether the body of a robot that is driven rests on the ground: then it has no support polygon. */
  belly: boolean;
  /** Number of reasons why the command to a robot that is driven is not met in full. */
  limitations: number;
  trouble: readonly (LegTrouble | null)[];
  /** Ground on foot: legs x 3 [N]. */
  forces: Float32Array | null;
  /** Legs x (coxa, femur, tibia) [N m]. */
  torques: Float32Array | null;
}

/** Dimensions of the robot. */
export interface Shape {
  names: readonly string[];
  /** Two letters a leg, such as LF. */
  short: readonly string[];
  /** Coxa axes in the body frame [mm]. */
  mounts: readonly Vec3[];
  /** Box of the body [mm], or null where the robot gives none. */
  size: Vec3 | null;
  footRadius: readonly number[];
  /** Length of the longest leg [mm]: the scale of what is drawn. */
  reach: number;
  /** Legs x (coxa, femur, tibia): stall torque [N m]. */
  stall: readonly (number | null)[];
}

/** Coordinates of one point of one leg. */
export function pointOf(frame: Placed, leg: number, point: number): Vec3 {
  const at = (leg * POINTS + point) * 3;
  const { points } = frame;
  return [points[at] ?? 0, points[at + 1] ?? 0, points[at + 2] ?? 0];
}

export function footOf(frame: Placed, leg: number): Vec3 {
  return pointOf(frame, leg, POINTS - 1);
}

/** Quaternion of Rz(yaw) Ry(pitch) Rx(roll), angles in degrees. */
export function quaternionOf(roll: number, pitch: number, yaw: number): Quaternion {
  const half = Math.PI / 360;
  const [sr, cr] = [Math.sin(roll * half), Math.cos(roll * half)];
  const [sp, cp] = [Math.sin(pitch * half), Math.cos(pitch * half)];
  const [sy, cy] = [Math.sin(yaw * half), Math.cos(yaw * half)];
  return [
    sr * cp * cy - cr * sp * sy,
    cr * sp * cy + sr * cp * sy,
    cr * cp * sy - sr * sp * cy,
    cr * cp * cy + sr * sp * sy,
  ];
}

/** A vector rotated by a quaternion. */
export function turn([x, y, z, w]: Quaternion, [vx, vy, vz]: Vec3): Vec3 {
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/** Interpolate between two rotations along the shorter path, at fraction t. */
export function blendRotation(a: Quaternion, b: Quaternion, t: number): Quaternion {
  const sign = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
  const q = [0, 1, 2, 3].map((i) => (a[i] ?? 0) * (1 - t) + sign * t * (b[i] ?? 0));
  const length = Math.hypot(...q) || 1;
  return [(q[0] ?? 0) / length, (q[1] ?? 0) / length, (q[2] ?? 0) / length, (q[3] ?? 0) / length];
}

function blendNumbers(a: Float32Array, b: Float32Array, t: number): Float32Array {
  return b.map((value, i) => (a[i] ?? value) * (1 - t) + value * t);
}

function blendVec(a: Vec3, b: Vec3, t: number): Vec3 {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}

function blendPlaced(a: Placed, b: Placed, t: number): Placed {
  return {
    points: blendNumbers(a.points, b.points, t),
    position: blendVec(a.position, b.position, t),
    rotation: blendRotation(a.rotation, b.rotation, t),
  };
}

/**
 * Interpolate between two frames: positions and forces linearly, everything discrete from the second one.
 * Between neighbouring samples the lengths of the links change by less than a pixel.
 */
export function blend(a: Frame, b: Frame, t: number): Frame {
  if (t >= 1 || a.points.length !== b.points.length) return b;
  return {
    ...b,
    ...blendPlaced(a, b, t),
    ghost: a.ghost && b.ghost ? blendPlaced(a.ghost, b.ghost, t) : b.ghost,
    com: a.com && b.com ? blendVec(a.com, b.com, t) : b.com,
    margin: a.margin !== null && b.margin !== null ? a.margin + (b.margin - a.margin) * t : b.margin,
    forces: a.forces && b.forces ? blendNumbers(a.forces, b.forces, t) : b.forces,
    torques: a.torques && b.torques ? blendNumbers(a.torques, b.torques, t) : b.torques,
  };
}

/** Greatest difference between the coordinates of two frames [mm]. */
export function distance(a: Frame, b: Frame): number {
  if (a.points.length !== b.points.length) return Infinity;
  return a.points.reduce((most, value, i) => Math.max(most, Math.abs(value - (b.points[i] ?? 0))), 0);
}
