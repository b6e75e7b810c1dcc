import { OrbitControls } from "@react-three/drei";
import { useFrame, useThree } from "@react-three/fiber";
import { useEffect, useRef } from "react";
import { PerspectiveCamera, Spherical, Vector3 } from "three";
import type { OrbitControls as Controls } from "three-stdlib";

import { placeCamera, type CameraName } from "./cameras";
import type { Vec3 } from "./frame";
import { prefersStillness, stage } from "./stage";
import { onSteer } from "./steer";

/** Time a camera takes to fly to its place [s]. */
const FLIGHT = 0.35;

export interface View {
  target: Vec3;
  radius: number;
}

interface Props {
  camera: CameraName;
  /** What should be seen; a new object makes the camera fly there. */
  view: View;
  /** Where to begin instead, from a link. */
  start: { eye: Vec3; target: Vec3 } | null;
  onRest: (eye: Vec3, target: Vec3) => void;
  onTurned: () => void;
}

/** The camera: flies to where its name says, follows the robot if asked, and turns by hand in between. */
export function CameraRig({ camera, view, start, onRest, onTurned }: Props) {
  const controls = useRef<Controls>(null);
  const eyeNow = useThree((state) => state.camera);
  const invalidate = useThree((state) => state.invalidate);
  const flight = useRef<{ eye: Vector3; target: Vector3; left: number } | null>(null);
  const seen = useRef<Vector3 | null>(null);
  const begun = useRef(false);

  useEffect(() => {
    if (!(eyeNow instanceof PerspectiveCamera)) return;
    const place =
      begun.current || !start
        ? placeCamera(camera, view.target, view.radius, eyeNow.fov, eyeNow.aspect)
        : start;
    const still = !begun.current || prefersStillness();
    begun.current = true;
    flight.current = {
      eye: new Vector3(...place.eye),
      target: new Vector3(...place.target),
      left: still ? 0 : FLIGHT,
    };
    seen.current = null;
    invalidate();
    // A link's place counts once, at the start.
    // eslint-disable-next-line react-hooks/exhaustive-deps
  }, [camera, view, eyeNow, invalidate]);

  useEffect(
    () =>
      onSteer(({ round, over, nearer }) => {
        const orbit = controls.current;
        if (!orbit) return;
        flight.current = null;
        const offset = eyeNow.position.clone().sub(orbit.target);
        const angles = new Spherical().setFromCartesianCoords(offset.y, offset.z, offset.x);
        angles.theta += round;
        angles.phi = Math.min(Math.PI * 0.497, Math.max(0.001, angles.phi + over));
        angles.radius *= nearer;
        offset.setFromSpherical(angles);
        eyeNow.position.set(offset.z, offset.x, offset.y).add(orbit.target);
        orbit.update();
        onTurned();
        invalidate();
      }),
    [eyeNow, invalidate, onTurned],
  );

  useFrame((_, dt) => {
    const orbit = controls.current;
    if (!orbit) return;
    if (flight.current) {
      const { eye, target, left } = flight.current;
      const step = Math.min(dt, 0.05);
      const share = left <= step ? 1 : 1 - Math.pow(0.02, step / FLIGHT);
      eyeNow.position.lerp(eye, share);
      orbit.target.lerp(target, share);
      orbit.update();
      flight.current = share === 1 ? null : { eye, target, left: left - step };
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
      maxPolarAngle={Math.PI * 0.497}
      onStart={() => {
        flight.current = null;
        onTurned();
      }}
      onEnd={() => {
        const target = controls.current?.target;
        if (target) onRest(eyeNow.position.toArray(), target.toArray());
      }}
    />
  );
}

/** Move eye and target as the body moves over the floor. */
function follow(orbit: Controls, eye: Vector3, seen: { current: Vector3 | null }) {
  const position = stage.current?.position;
  if (!position) return;
  const before = seen.current;
  seen.current = new Vector3(position[0], position[1], 0);
  if (!before) {
    const jump = new Vector3(position[0] - orbit.target.x, position[1] - orbit.target.y, 0);
    eye.add(jump);
    orbit.target.add(jump);
  } else {
    const moved = seen.current.clone().sub(before);
    eye.add(moved);
    orbit.target.add(moved);
  }
  orbit.update();
}
