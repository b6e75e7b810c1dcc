import { OrbitControls } from "@react-three/drei";
import { useFrame, useThree } from "@react-three/fiber";
import { useEffect, useRef } from "react";
import { PerspectiveCamera, Spherical, Vector3 } from "three";
import type { OrbitControls as Controls } from "three-stdlib";

import { isFrom, placeCamera, type CameraName, type Place } from "./cameras";
import type { Vec3 } from "./frame";
import { prefersStillness, stage } from "./stage";
import { onSteer, type Turn } from "./steer";

/** Time a camera takes to fly to its place [s]. */
const FLIGHT = 0.35;
/** How far down one may look along the floor [rad from the upright]. */
const LOWEST = Math.PI * 0.497;

export interface View {
  target: Vec3;
  radius: number;
}

interface Props {
  camera: CameraName;
  /** What should be seen; a new object makes the camera fly there, unless a hand has put it elsewhere. */
  view: View;
  /** Where a hand has put the camera. */
  place: Place | null;
  /** It has come to rest by hand; `turned` tells whether it still looks from where its name says. */
  onRest: (place: Place, turned: boolean) => void;
}

/** The camera: flies to where its name says, follows the robot if asked, and turns by hand in between. */
export function CameraRig({ camera, view, place, onRest }: Props) {
  const controls = useRef<Controls>(null);
  const eyeNow = useThree((state) => state.camera);
  const invalidate = useThree((state) => state.invalidate);
  const flight = useRef<Flight | null>(null);
  const grabbed = useRef<{ eye: Vector3; flight: Flight | null } | null>(null);
  const seen = useRef<Vector3 | null>(null);
  const begun = useRef(false);
  const [eyeKey, targetKey] = [place?.eye.join(), place?.target.join()];

  useEffect(() => {
    if (!(eyeNow instanceof PerspectiveCamera)) return;
    const goal = place ?? placeCamera(camera, view.target, view.radius, eyeNow.fov, eyeNow.aspect);
    const eye = new Vector3(...goal.eye);
    const still = !begun.current || prefersStillness();
    begun.current = true;
    // A hand that has just put it here must not be led back by a rounded number.
    if (place && eye.distanceTo(eyeNow.position) < 2) return;
    flight.current = { eye, target: new Vector3(...goal.target), lasts: still ? 0 : FLIGHT, from: null };
    seen.current = null;
    invalidate();
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [camera, view, eyeKey, targetKey, eyeNow, invalidate]);

  const rest = () => {
    const orbit = controls.current;
    if (!orbit) return;
    const now = { eye: rounded(eyeNow.position), target: rounded(orbit.target) };
    onRest(now, !isFrom(camera, now));
  };
  const latestRest = useRef(rest);
  useEffect(() => {
    latestRest.current = rest;
  });

  useEffect(
    () =>
      onSteer((turn) => {
        const orbit = controls.current;
        if (!orbit) return;
        flight.current = null;
        turnBy(turn, eyeNow.position, orbit.target);
        orbit.update();
        latestRest.current();
        invalidate();
      }),
    [eyeNow, invalidate],
  );

  useFrame(() => {
    const orbit = controls.current;
    if (!orbit) return;
    if (flight.current) {
      if (fly(flight.current, eyeNow.position, orbit.target)) flight.current = null;
      orbit.update();
      invalidate();
    } else if (camera === "follow") {
      follow(orbit, eyeNow.position, seen);
    }
  });

  return (
    <OrbitControls
      ref={controls}
      makeDefault
      enableDamping={false}
      minDistance={80}
      maxDistance={6000}
      maxPolarAngle={LOWEST}
      onStart={() => {
        grabbed.current = { eye: eyeNow.position.clone(), flight: flight.current };
        flight.current = null;
      }}
      onEnd={() => {
        // A click that moves nothing must not end a flight.
        if (grabbed.current?.eye.equals(eyeNow.position)) flight.current = grabbed.current.flight;
        else rest();
        invalidate();
      }}
    />
  );
}

/** On the way to a place; `from` is filled in by the first frame, which may come late. */
interface Flight {
  eye: Vector3;
  target: Vector3;
  /** [s] */
  lasts: number;
  from: { eye: Vector3; target: Vector3; at: number } | null;
}

/** Go on with a flight by the clock, however slowly frames come; returns whether it has arrived. */
function fly(flight: Flight, eye: Vector3, target: Vector3): boolean {
  const now = performance.now() / 1000;
  flight.from ??= { eye: eye.clone(), target: target.clone(), at: now };
  const share = flight.lasts > 0 ? Math.min(1, (now - flight.from.at) / flight.lasts) : 1;
  const eased = share * share * (3 - 2 * share);
  eye.lerpVectors(flight.from.eye, flight.eye, eased);
  target.lerpVectors(flight.from.target, flight.target, eased);
  return share === 1;
}

/** Move the eye round what it looks at. */
function turnBy({ round, over, nearer }: Turn, eye: Vector3, target: Vector3) {
  const offset = eye.clone().sub(target);
  // three's spherical angles have y up: z, x, y of ours.
  const angles = new Spherical().setFromCartesianCoords(offset.y, offset.z, offset.x);
  angles.theta += round;
  angles.phi = Math.min(LOWEST, Math.max(0.001, angles.phi + over));
  angles.radius *= nearer;
  offset.setFromSpherical(angles);
  eye.set(offset.z, offset.x, offset.y).add(target);
}

function rounded({ x, y, z }: Vector3): Vec3 {
  return [Math.round(x), Math.round(y), Math.round(z)];
}

/** Move eye and target as the body moves over the floor. */
function follow(orbit: Controls, eye: Vector3, seen: { current: Vector3 | null }) {
  const position = stage.current?.position;
  if (!position) return;
  const now = new Vector3(position[0], position[1], 0);
  const before = seen.current ?? new Vector3(orbit.target.x, orbit.target.y, 0);
  seen.current = now;
  const moved = now.clone().sub(before);
  if (moved.lengthSq() === 0) return;
  eye.add(moved);
  orbit.target.add(moved);
  orbit.update();
}
