import { useMemo, useRef } from "react";
import { BufferAttribute, BufferGeometry, type Group, type Mesh, type MeshBasicMaterial } from "three";

import { setLine, useLine } from "./lines";
import type { Palette } from "./palette";
import { footOf, type Frame, type Shape } from "./frame";
import { convexHull, nearestOnEdge, type Point2 } from "./polygon";
import { useStage } from "./useStage";

/** Height above the ground at which flat objects are drawn, to avoid z-fighting [mm]. */
const OVER = 0.6;
const MOST = 16;

/** Support polygon, projected centre of mass, and the shortest line from it to the edge of the polygon. */
export function Support({ palette, shape }: { palette: Palette; shape: Shape }) {
  const edge = useLine({ colour: palette.support, width: 2.5 });
  const badEdge = useLine({ colour: palette.unstable, width: 2.5 });
  const plumb = useLine({ colour: palette.mark, width: 2 });
  const reach = useLine({ colour: palette.mark, width: 3 });
  const fill = useRef<Mesh>(null);
  const dot = useRef<Group>(null);
  const geometry = useMemo(() => {
    const made = new BufferGeometry();
    made.setAttribute("position", new BufferAttribute(new Float32Array(MOST * 9), 3));
    return made;
  }, []);

  useStage((frame) => {
    const hull = supportOf(frame);
    const bad = frame.margin !== null && frame.margin < 0;
    const ring = hull.length > 1 ? [...hull, hull[0] ?? ([0, 0] as const)] : [];
    const over = OVER + groundOf(frame, shape);
    const flat = ring.flatMap(([x, y]) => [x, y, over]);
    setLine(edge, bad ? [] : flat);
    setLine(badEdge, bad ? flat : []);
    fillFan(geometry, hull, over - 0.3 * OVER);
    const material = fill.current?.material as MeshBasicMaterial | undefined;
    material?.color.set(bad ? palette.unstable : palette.support);
    const { com } = frame;
    if (dot.current) dot.current.visible = com !== null;
    if (!com) {
      setLine(plumb, []);
      setLine(reach, []);
      return;
    }
    dot.current?.position.set(com[0], com[1], over + 0.4);
    setLine(plumb, [...com, com[0], com[1], over]);
    const near = hull.length > 1 ? nearestOnEdge(hull, [com[0], com[1]]) : null;
    setLine(reach, near ? [com[0], com[1], over + 0.6, near[0], near[1], over + 0.6] : []);
  });

  return (
    <group>
      <mesh ref={fill} geometry={geometry} frustumCulled={false} renderOrder={0}>
        <meshBasicMaterial transparent opacity={0.16} depthWrite={false} side={2} />
      </mesh>
      <primitive object={edge} />
      <primitive object={badEdge} />
      <primitive object={plumb} />
      <primitive object={reach} />
      <group ref={dot}>
        <mesh renderOrder={2}>
          <circleGeometry args={[6, 24]} />
          <meshBasicMaterial color={palette.mark} />
        </mesh>
      </group>
    </group>
  );
}

function supportOf(frame: Frame): Point2[] {
  if (frame.support) return frame.support.slice(0, MOST);
  const feet = frame.contacts.flatMap((down, leg): Point2[] => {
    const foot = footOf(frame, leg);
    return down ? [[foot[0], foot[1]]] : [];
  });
  return convexHull(feet).slice(0, MOST);
}

/** Height at which the polygon is drawn [mm]: in physics that of the highest foot on the ground, to be seen. */
function groundOf(frame: Frame, shape: Shape): number {
  if (!frame.physical) return 0;
  const heights = frame.contacts.flatMap((down, leg) =>
    down ? [footOf(frame, leg)[2] - (shape.footRadius[leg] ?? 0)] : [],
  );
  return heights.length > 0 ? Math.max(...heights) : 0;
}

/** Write a triangle fan into the existing buffer, so that frames allocate nothing. */
function fillFan(geometry: BufferGeometry, hull: readonly Point2[], height: number) {
  const position = geometry.getAttribute("position");
  const corners = hull.slice(2).flatMap((_, i) => [hull[0], hull[i + 1], hull[i + 2]]);
  corners.forEach((corner, i) => position.setXYZ(i, corner?.[0] ?? 0, corner?.[1] ?? 0, height));
  position.needsUpdate = true;
  geometry.setDrawRange(0, corners.length);
}
