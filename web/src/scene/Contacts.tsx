import { useEffect, useMemo, useRef } from "react";
import { Color, DynamicDrawUsage, InstancedMesh, MeshBasicMaterial, Object3D, RingGeometry } from "three";

import { footOf, SLIDING, type Frame, type Shape, type Vec3 } from "./frame";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

/** Maximum number of contact points. */
const MOST = 64;

/** Height of the rings above the ground [mm]. */
const OVER = 0.9;

/** A ring around every contact point on the ground; in physics in another colour below a foot that slides. */
export function Contacts({ shape, palette }: { shape: Shape; palette: Palette }) {
  const rings = useMemo(() => {
    const radius = Math.max(8, shape.reach * 0.045);
    const geometry = new RingGeometry(radius * 0.72, radius, 32);
    const made = new InstancedMesh(geometry, new MeshBasicMaterial(), MOST);
    made.instanceMatrix.setUsage(DynamicDrawUsage);
    made.frustumCulled = false;
    made.renderOrder = 2;
    return made;
  }, [shape.reach]);
  const place = useRef(new Object3D());
  const colour = useRef(new Color());
  useEffect(
    () => () => {
      rings.geometry.dispose();
      rings.dispose();
    },
    [rings],
  );

  useStage((frame) => {
    const points = contactPointsOf(frame, shape).slice(0, MOST);
    points.forEach(({ at, slides }, i) => {
      place.current.position.set(...at);
      place.current.updateMatrix();
      rings.setMatrixAt(i, place.current.matrix);
      rings.setColorAt(i, colour.current.set(slides ? palette.trouble : palette.support));
    });
    rings.count = points.length;
    rings.instanceMatrix.needsUpdate = true;
    if (rings.instanceColor) rings.instanceColor.needsUpdate = true;
  });
  return <primitive object={rings} />;
}

interface Contact {
  at: Vec3;
  slides: boolean;
}

function contactPointsOf(frame: Frame, shape: Shape): Contact[] {
  const feet = frame.contacts.flatMap((down, leg): Contact[] => {
    if (!down) return [];
    const [x, y, z] = footOf(frame, leg);
    // In physics the ground is where the ball of the foot ends; a plan has level ground at height 0.
    const ground = frame.physical ? z - (shape.footRadius[leg] ?? 0) : 0;
    return [{ at: [x, y, ground + OVER], slides: (frame.physical?.slip[leg] ?? 0) > SLIDING }];
  });
  return [...feet, ...frame.touching.map(([x, y]): Contact => ({ at: [x, y, OVER], slides: false }))];
}
