import { Plane, Vector3, type Ray } from "three";

import type { Vec3 } from "./frame";

/** Sine of the camera's elevation above which objects are dragged horizontally. */
const STEEP = 0.45;

/**
 * The plane in which an object is dragged: horizontal if the camera looks from above, vertical and facing the camera
 * if it looks from the side. Shift selects the other one.
 */
export function dragPlane(at: Vec3, look: Vec3, other: boolean): Plane {
  const level = Math.abs(look[2]) > STEEP !== other;
  const facing = new Vector3(look[0], look[1], 0);
  const normal = level || facing.lengthSq() < 1e-6 ? new Vector3(0, 0, 1) : facing.normalize();
  return new Plane().setFromNormalAndCoplanarPoint(normal, new Vector3(...at));
}

/** Intersection of a ray and a plane, or null if there is none. */
export function intersection(ray: Ray, plane: Plane): Vec3 | null {
  const point = ray.intersectPlane(plane, new Vector3());
  return point ? [point.x, point.y, point.z] : null;
}
