import { RoundedBox } from "@react-three/drei";
import { useEffect, useMemo, useRef } from "react";
import { ExtrudeGeometry, Shape as Outline, type Group } from "three";

import type { Palette } from "./palette";
import type { Shape, Vec3 } from "./frame";
import { convexHull } from "./polygon";
import { useStage } from "./useStage";

interface Props {
  shape: Shape;
  thick: number;
  palette: Palette;
}

/** The body: its box, the plate with the coxa axes, and a marker at the front. */
export function BodyModel({ shape, thick, palette }: Props) {
  const group = useRef<Group>(null);
  useStage((frame) => {
    group.current?.position.set(...frame.position);
    group.current?.quaternion.set(...frame.rotation);
  });
  const deck = useMemo(() => deckOf(shape.mounts, thick), [shape.mounts, thick]);
  useEffect(() => () => deck?.dispose(), [deck]);
  const size = shape.size;
  const front = Math.max(size ? size[0] / 2 : 0, ...shape.mounts.map((mount) => mount[0]));
  const top = Math.max(size ? size[2] / 2 : 0, thick * 1.3);
  return (
    <group ref={group} name="body">
      {deck && (
        <mesh geometry={deck} castShadow>
          <meshStandardMaterial color={palette.deck} roughness={0.6} metalness={0.1} />
        </mesh>
      )}
      {size && (
        <RoundedBox
          args={[size[0], size[1], size[2]]}
          radius={Math.min(...size) * 0.18}
          smoothness={3}
          castShadow
        >
          <meshStandardMaterial color={palette.body} roughness={0.6} metalness={0.1} />
        </RoundedBox>
      )}
      {/* An arrowhead on the top shows the forward direction. */}
      <mesh position={[front * 0.55, 0, top + 1]} rotation={[0, 0, -Math.PI / 2]} scale={[1, 1.3, 0.12]}>
        <coneGeometry args={[thick * 1.6, thick * 3, 3]} />
        <meshBasicMaterial color={palette.mark} />
      </mesh>
    </group>
  );
}

function deckOf(mounts: readonly Vec3[], thick: number): ExtrudeGeometry | null {
  const hull = convexHull(mounts.map(([x, y]) => [x, y] as const));
  if (hull.length < 3) return null;
  const outline = new Outline();
  hull.forEach(([x, y], i) => (i === 0 ? outline.moveTo(x, y) : outline.lineTo(x, y)));
  const height = thick * 0.9;
  const geometry = new ExtrudeGeometry(outline, {
    depth: height,
    bevelEnabled: true,
    bevelSize: thick * 1.7,
    bevelThickness: thick * 0.3,
    bevelSegments: 3,
  });
  const level = mounts.reduce((sum, mount) => sum + mount[2], 0) / mounts.length;
  geometry.translate(0, 0, level - height / 2);
  return geometry;
}
