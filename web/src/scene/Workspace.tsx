import { useEffect, useMemo, useRef } from "react";
import { BufferAttribute, BufferGeometry, ShapeUtils, Vector2, type Group } from "three";

import { setLine, useLine } from "./lines";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

interface Props {
  /** Outlines in the body frame, x, y, z of all points [mm]. */
  ground: readonly number[];
  plane: readonly number[];
  palette: Palette;
}

/** Workspace of a leg: on the ground, and in the plane of the leg. Both move with the body. */
export function Workspace({ ground, plane, palette }: Props) {
  const group = useRef<Group>(null);
  useStage((frame) => {
    group.current?.position.set(...frame.position);
    group.current?.quaternion.set(...frame.rotation);
  });
  return (
    <group ref={group} name="workspace">
      <Outline flat={ground} palette={palette} opacity={0.2} flatten />
      <Outline flat={plane} palette={palette} opacity={0.1} />
    </group>
  );
}

interface OutlineProps {
  flat: readonly number[];
  palette: Palette;
  opacity: number;
  /** Whether it is on the ground; else it is vertical. */
  flatten?: boolean;
}

function Outline({ flat, palette, opacity, flatten = false }: OutlineProps) {
  const line = useLine({ colour: palette.workspace, width: 2 });
  const closed = useMemo(() => [...flat, ...flat.slice(0, 3)], [flat]);
  useEffect(() => setLine(line, flat.length ? closed : []), [line, closed, flat]);
  const geometry = useMemo(() => filled(flat, flatten), [flat, flatten]);
  useEffect(() => () => geometry.dispose(), [geometry]);
  return (
    <group>
      <mesh geometry={geometry} renderOrder={1}>
        <meshBasicMaterial
          color={palette.workspace}
          transparent
          opacity={opacity}
          depthWrite={false}
          side={2}
        />
      </mesh>
      <primitive object={line} />
    </group>
  );
}

/** Triangulation of an outline in its plane. */
function filled(flat: readonly number[], flatten: boolean): BufferGeometry {
  const geometry = new BufferGeometry();
  const points = Array.from({ length: flat.length / 3 }, (_, i) => flat.slice(i * 3, i * 3 + 3));
  const corners = points.map(([x = 0, y = 0, z = 0]) =>
    flatten ? new Vector2(x, y) : new Vector2(outward(points, x, y), z),
  );
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(flat), 3));
  geometry.setIndex(corners.length > 2 ? ShapeUtils.triangulateShape(corners, []).flat() : []);
  return geometry;
}

/** Horizontal coordinate of a point of a vertical outline. */
function outward(points: readonly (readonly number[])[], x: number, y: number): number {
  const [x0 = 0, y0 = 0] = points[0] ?? [];
  const far = points.reduce<readonly number[]>(
    (best, point) => (span(point, x0, y0) > span(best, x0, y0) ? point : best),
    [x0, y0],
  );
  const length = span(far, x0, y0) || 1;
  return ((x - x0) * ((far[0] ?? 0) - x0) + (y - y0) * ((far[1] ?? 0) - y0)) / length;
}

function span(point: readonly number[], x: number, y: number): number {
  return Math.hypot((point[0] ?? 0) - x, (point[1] ?? 0) - y);
}
