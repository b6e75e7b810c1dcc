import type { Vec3 } from "./frame";

export type CameraName = "free" | "follow" | "top" | "side" | "front";

export const CAMERAS: readonly { name: CameraName; label: string; hint: string }[] = [
  { name: "free", label: "Free", hint: "Turn the picture freely" },
  { name: "follow", label: "Follow", hint: "Stay with the robot as it walks" },
  { name: "top", label: "Top", hint: "From above, forward is up" },
  { name: "side", label: "Side", hint: "From the robot's right" },
  { name: "front", label: "Front", hint: "The robot comes towards you" },
];

/** Where a camera looks from, seen from what it looks at: a direction of length one. */
export function directionOf(camera: CameraName): Vec3 {
  switch (camera) {
    case "top":
      // Not quite upright: there, left and right are undefined to the orbit controls.
      return [-0.001, 0, 1];
    case "side":
      return [0, -0.985, 0.17];
    case "front":
      return [0.985, 0, 0.17];
    default:
      return [-0.62, -0.5, 0.6];
  }
}

/** How far to stand off so that a sphere of the given radius fills the picture, whatever its shape. */
export function distanceFor(radius: number, fovDegrees: number, aspect: number): number {
  const half = (fovDegrees * Math.PI) / 360;
  const narrow = aspect < 1 ? Math.atan(Math.tan(half) * aspect) : half;
  return radius / Math.sin(narrow);
}

/** Where a camera stands, and what it looks at [mm]. */
export interface Place {
  eye: Vec3;
  target: Vec3;
}

/** Whether a place looks from where a camera's name says. The free one may look from anywhere. */
export function isFrom(camera: CameraName, { eye, target }: Place): boolean {
  if (camera === "free" || camera === "follow") return true;
  const look = [eye[0] - target[0], eye[1] - target[1], eye[2] - target[2]] as const;
  const wanted = directionOf(camera);
  const dot = look[0] * wanted[0] + look[1] * wanted[1] + look[2] * wanted[2];
  return dot > 0.999 * Math.hypot(...look) * Math.hypot(...wanted);
}

/** Where to stand and where to look for a camera. */
export function placeCamera(
  camera: CameraName,
  target: Vec3,
  radius: number,
  fovDegrees: number,
  aspect: number,
): Place {
  const far = distanceFor(radius, fovDegrees, aspect);
  const [dx, dy, dz] = directionOf(camera);
  const length = Math.hypot(dx, dy, dz);
  return {
    eye: [target[0] + (dx / length) * far, target[1] + (dy / length) * far, target[2] + (dz / length) * far],
    target,
  };
}
