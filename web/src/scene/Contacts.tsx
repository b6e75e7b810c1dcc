import { useEffect, useMemo, useRef } from "react";
import { DynamicDrawUsage, InstancedMesh, MeshBasicMaterial, Object3D, RingGeometry } from "three";

import { footOf, type Frame, type Shape, type Vec3 } from "./frame";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

/** Maximum number of contact points. */
const MOST = 64;

/** A ring around every contact point on the ground. */
export function Contacts({ shape, palette }: { shape: Shape; palette: Palette }) {
  const rings = useMemo(() => {
    const radius = Math.max(8, shape.reach * 0.045);
    const geometry = new RingGeometry(radius * 0.72, radius, 32);
    const made = new InstancedMesh(geometry, new MeshBasicMaterial({ color: palette.support }), MOST);
    made.instanceMatrix.setUsage(DynamicDrawUsage);
    made.frustumCulled = false;
    made.renderOrder = 2;
    return made;
  }, [shape.reach, palette.support]);
  const place = useRef(new Object3D());
  useEffect(
    () => () => {
      rings.geometry.dispose();
      rings.dispose();
    },
    [rings],
  );

  useStage((frame) => {
    const points = contactPointsOf(frame).slice(0, MOST);
    points.forEach(([x, y], i) => {
      place.current.position.set(x, y, 0.9);
      place.current.updateMatrix();
      rings.setMatrixAt(i, place.current.matrix);
    });
    rings.count = points.length;
    rings.instanceMatrix.needsUpdate = true;
  });
  return <primitive object={rings} />;
}

function contactPointsOf(frame: Frame): Vec3[] {
  const feet = frame.contacts.flatMap((down, leg) => (down ? [footOf(frame, leg)] : []));
  return [...feet, ...frame.touching];
}
