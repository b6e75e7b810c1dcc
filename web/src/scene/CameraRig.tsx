import { OrbitControls } from "@react-three/drei";
import { useFrame, useThree } from "@react-three/fiber";
import { useEffect, useRef } from "react";
import { PerspectiveCamera, Vector3 } from "three";
import type { OrbitControls as Controls } from "three-stdlib";

import { isFrom, placeCamera, type CameraName, type Place } from "./cameras";
import type { Vec3 } from "./frame";
import { TRANSITION_TIME, fly, type CameraTransition } from "./cameraTransition";
import { prefersReducedMotion, stage } from "./stage";
import { onSteer, turnBy, LOWEST } from "./cameraKeys";

export interface View {
  target: Vec3;
  radius: number;
}

interface Props {
  camera: CameraName;
  /** Region to show; a new object moves the camera there, unless the user has moved it. */
  view: View;
  /** Position of the camera as set by the user. */
  place: Place | null;
  /** Called when the user has moved the camera; `turned`: whether its direction is no longer that of its name. */
  onRest: (place: Place, turned: boolean) => void;
}

/** The camera: moves to the position that belongs to its name, follows the robot, and can be moved by the user. */
export function CameraRig({ camera, view, place, onRest }: Props) {
  const controls = useRef<Controls>(null);
  const eyeNow = useThree((state) => state.camera);
  const invalidate = useThree((state) => state.invalidate);
  const transition = useRef<CameraTransition | null>(null);
  const grabbed = useRef<{ eye: Vector3; transition: CameraTransition | null } | null>(null);
  const seen = useRef<Vector3 | null>(null);
  const begun = useRef(false);
  const [eyeKey, targetKey] = [place?.eye.join(), place?.target.join()];

  useEffect(() => {
    if (!(eyeNow instanceof PerspectiveCamera)) return;
    const goal = place ?? placeCamera(camera, view.target, view.radius, eyeNow.fov, eyeNow.aspect);
    const eye = new Vector3(...goal.eye);
    const still = !begun.current || prefersReducedMotion();
    begun.current = true;
    // The rounded position that the server returns must not move the camera again.
    if (place && eye.distanceTo(eyeNow.position) < 2) return;
    transition.current = {
      eye,
      target: new Vector3(...goal.target),
      lasts: still ? 0 : TRANSITION_TIME,
      from: null,
    };
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
        transition.current = null;
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
    if (transition.current) {
      if (fly(transition.current, eyeNow.position, orbit.target)) transition.current = null;
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
        grabbed.current = { eye: eyeNow.position.clone(), transition: transition.current };
        transition.current = null;
      }}
      onEnd={() => {
        // A click without a movement must not interrupt a camera transition.
        if (grabbed.current?.eye.equals(eyeNow.position)) transition.current = grabbed.current.transition;
        else rest();
        invalidate();
      }}
    />
  );
}

function rounded({ x, y, z }: Vector3): Vec3 {
  return [Math.round(x), Math.round(y), Math.round(z)];
}

/** Move eye and target with the body. */
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
