import { Plane, Vector3, type Ray } from "three";

import type { Vec3 } from "./frame";

/** Steeper than this, a look goes down on the floor: things are then dragged over it [sine of the angle]. */
const STEEP = 0.45;

/**
 * The plane in which a thing is dragged: level if the camera looks down on it, upright and facing the camera if the
 * camera looks from the side. Shift takes the other one.
 */
export function dragPlane(at: Vec3, look: Vec3, other: boolean): Plane {
  const level = Math.abs(look[2]) > STEEP !== other;
  const facing = new Vector3(look[0], look[1], 0);
  const normal = level || facing.lengthSq() < 1e-6 ? new Vector3(0, 0, 1) : facing.normalize();
  return new Plane().setFromNormalAndCoplanarPoint(normal, new Vector3(...at));
}

/** Where a ray meets a plane, or null where it runs along it or away from it. */
export function meet(ray: Ray, plane: Plane): Vec3 | null {
  const point = ray.intersectPlane(plane, new Vector3());
  return point ? [point.x, point.y, point.z] : null;
}
