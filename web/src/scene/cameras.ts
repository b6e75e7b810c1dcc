import type { Vec3 } from "./frame";

export type CameraName = "free" | "follow" | "top" | "side" | "front";

export const CAMERAS: readonly { name: CameraName; label: string; hint: string }[] = [
  { name: "free", label: "Free", hint: "Move the camera freely" },
  { name: "follow", label: "Follow", hint: "Follow the robot" },
  { name: "top", label: "Top", hint: "From above, forward up" },
  { name: "side", label: "Side", hint: "From the right side" },
  { name: "front", label: "Front", hint: "From the front" },
];

/** Unit vector from the target to the camera. */
export function directionOf(camera: CameraName): Vec3 {
  switch (camera) {
    case "top":
      // Not exactly vertical, where the azimuth of the orbit controls is undefined.
      return [-0.001, 0, 1];
    case "side":
      return [0, -0.985, 0.17];
    case "front":
      return [0.985, 0, 0.17];
    default:
      return [-0.62, -0.5, 0.6];
  }
}

/** Distance at which a sphere of the given radius fills the view, for any aspect ratio. */
export function distanceFor(radius: number, fovDegrees: number, aspect: number): number {
  const half = (fovDegrees * Math.PI) / 360;
  const narrow = aspect < 1 ? Math.atan(Math.tan(half) * aspect) : half;
  return radius / Math.sin(narrow);
}

/** Position of the camera and its target [mm]. */
export interface Place {
  eye: Vec3;
  target: Vec3;
}

/** Whether a position has the direction of a named camera. The free one may have any. */
export function isFrom(camera: CameraName, { eye, target }: Place): boolean {
  if (camera === "free" || camera === "follow") return true;
  const look = [eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]] as const;
  const named = directionOf(camera);
  const dot = look[0] * named[0] + look[1] * named[1] + look[2] * named[2];
  return dot > 0.999 * Math.hypot(...look) * Math.hypot(...named);
}

/** Position and target of a named camera. */
export function placeCamera(
  camera: CameraName,
  target: Vec3,
  radius: number,
  fovDegrees: number,
  aspect: number,
): Place {
  const distance = distanceFor(radius, fovDegrees, aspect);
  const [dx, dy, dz] = directionOf(camera);
  const length = Math.hypot(dx, dy, dz);
  return {
    eye: [
      target[0] + (dx / length) * distance,
      target[1] + (dy / length) * distance,
      target[2] + (dz / length) * distance,
    ],
    target,
  };
}
