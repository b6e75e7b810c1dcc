import { Billboard } from "@react-three/drei";
import { useRef } from "react";
import type { Group, Mesh, MeshBasicMaterial } from "three";

import { pointOf, type Shape } from "./frame";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

interface Props {
  shape: Shape;
  palette: Palette;
}

/** Fraction of the stall torque above which a servo overheats in continuous use, and above which it stalls. */
export const LASTING = 0.5;

/** A bar at each joint: torque as a fraction of the stall torque, which is the length of the frame. */
export function TorqueBars({ shape, palette }: Props) {
  return (
    <group name="torque-bars">
      {shape.names.flatMap((name, leg) =>
        [0, 1, 2].map((joint) => (
          <Bar key={`${name} ${joint}`} leg={leg} joint={joint} shape={shape} palette={palette} />
        )),
      )}
    </group>
  );
}

function Bar({ leg, joint, shape, palette }: Props & { leg: number; joint: number }) {
  const group = useRef<Group>(null);
  const bar = useRef<Mesh>(null);
  const [width, height] = [shape.reach * 0.032, shape.reach * 0.15];
  const stall = shape.stall[leg * 3 + joint] ?? null;

  useStage((frame) => {
    if (!group.current || !bar.current) return;
    const torque = frame.torques?.[leg * 3 + joint];
    group.current.visible = torque !== undefined && stall !== null;
    if (torque === undefined || stall === null) return;
    const [x, y, z] = pointOf(frame, leg, joint);
    group.current.position.set(x, y, z + shape.reach * 0.13);
    const fraction = Math.min(1, Math.abs(torque) / stall);
    bar.current.scale.set(1, Math.max(fraction, 0.01) * height, 1);
    bar.current.position.set(0, (fraction * height - height) / 2, 0.3);
    const colour = fraction >= 1 ? palette.trouble : fraction > LASTING ? palette.mark : palette.support;
    (bar.current.material as MeshBasicMaterial).color.set(colour);
  });

  return (
    <group ref={group}>
      <Billboard>
        <mesh renderOrder={7}>
          <planeGeometry args={[width + 5, height + 5]} />
          <meshBasicMaterial color={palette.joint} depthTest={false} transparent />
        </mesh>
        <mesh renderOrder={8}>
          <planeGeometry args={[width, height]} />
          <meshBasicMaterial color={palette.background} depthTest={false} transparent />
        </mesh>
        <mesh ref={bar} renderOrder={9}>
          <planeGeometry args={[width, 1]} />
          <meshBasicMaterial depthTest={false} transparent />
        </mesh>
      </Billboard>
    </group>
  );
}
