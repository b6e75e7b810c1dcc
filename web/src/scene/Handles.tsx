import { useThree, type ThreeEvent } from "@react-three/fiber";
import { useEffect, useRef, useState } from "react";
import { Vector3, type Mesh, type Plane } from "three";

import { dragPlane, intersection } from "./dragging";
import { footOf, type Frame, type Shape, type Vec3 } from "./frame";
import type { Palette } from "./palette";
import { stage } from "./stage";
import { useStage } from "./useStage";

/** Index of the leg whose foot is dragged, or the body. */
export type Grip = number | "body";

export interface DragEvent {
  grip: Grip;
  /** Position at the start of the drag, and now [mm]. */
  from: Vec3;
  to: Vec3;
  /** Whether the drag has ended. */
  done: boolean;
}

interface Props {
  shape: Shape;
  palette: Palette;
  body: boolean;
  onDrag: (event: DragEvent) => void;
}

/** Handles to drag feet and body by mouse or finger. The panel offers the same by keyboard. */
export function Handles({ shape, palette, body, onDrag }: Props) {
  const grips: Grip[] = [...shape.names.map((_, leg) => leg), ...(body ? (["body"] as const) : [])];
  return (
    <group name="handles">
      {grips.map((grip) => (
        <Handle key={grip} grip={grip} shape={shape} palette={palette} onDrag={onDrag} />
      ))}
    </group>
  );
}

function placeOf(frame: Frame, grip: Grip): Vec3 {
  return grip === "body" ? frame.position : footOf(frame, grip);
}

/** Factor by which handles are larger for a finger than for a mouse. */
const FINGER = 1.8;

interface HandleProps extends Omit<Props, "body"> {
  grip: Grip;
}

function Handle({ grip, shape, palette, onDrag }: HandleProps) {
  const mesh = useRef<Mesh>(null);
  const drag = useRef<{ plane: Plane; from: Vec3; offset: Vec3 } | null>(null);
  const [hot, setHot] = useState(false);
  const controls = useThree((state) => state.controls) as { enabled: boolean } | null;
  const invalidate = useThree((state) => state.invalidate);
  const coarse = window.matchMedia("(pointer: coarse)").matches ? FINGER : 1;
  const radius = coarse * (grip === "body" ? shape.reach * 0.12 : Math.max(shape.reach * 0.055, 16));

  useStage((frame) => mesh.current?.position.set(...placeOf(frame, grip)));

  useEffect(
    () => () => {
      document.body.style.cursor = "";
    },
    [],
  );
  const heat = (on: boolean) => {
    setHot(on);
    document.body.style.cursor = on ? "grab" : "";
    invalidate();
  };
  const grab = (event: ThreeEvent<PointerEvent>) => {
    if (!stage.current || event.button !== 0) return;
    event.stopPropagation();
    const from = placeOf(stage.current, grip);
    const look = event.camera.getWorldDirection(new Vector3());
    const plane = dragPlane(from, [look.x, look.y, look.z], event.shiftKey);
    const hit = intersection(event.ray, plane) ?? from;
    drag.current = { plane, from, offset: [from[0] - hit[0], from[1] - hit[1], from[2] - hit[2]] };
    (event.target as Element).setPointerCapture(event.pointerId);
    if (controls) controls.enabled = false;
    heat(true);
  };
  const move = (event: ThreeEvent<PointerEvent>, done: boolean) => {
    if (!drag.current) return;
    event.stopPropagation();
    const { plane, from, offset } = drag.current;
    const hit = intersection(event.ray, plane);
    if (hit) onDrag({ grip, from, to: [hit[0] + offset[0], hit[1] + offset[1], hit[2] + offset[2]], done });
    if (!done) return;
    drag.current = null;
    (event.target as Element).releasePointerCapture(event.pointerId);
    if (controls) controls.enabled = true;
    heat(false);
  };

  return (
    <mesh
      ref={mesh}
      name={`grip ${grip}`}
      renderOrder={6}
      onPointerOver={() => heat(true)}
      onPointerOut={() => !drag.current && heat(false)}
      onPointerDown={grab}
      onPointerMove={(event) => move(event, false)}
      onPointerUp={(event) => move(event, true)}
    >
      <sphereGeometry args={[radius, 20, 14]} />
      <meshBasicMaterial
        color={palette.workspace}
        transparent
        opacity={hot ? 0.45 : 0.14}
        depthWrite={false}
      />
    </mesh>
  );
}
