import { useEffect, useMemo } from "react";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import type { InterleavedBufferAttribute } from "three";

export interface LineLook {
  colour: string;
  /** Width [pixels]. */
  width: number;
  opacity?: number;
  /** Whether it is drawn over everything else. */
  onTop?: boolean;
}

/** A line with a width: WebGL's own lines are one pixel wide. */
export function makeLine(look: LineLook): Line2 {
  const material = new LineMaterial({
    color: look.colour,
    linewidth: look.width,
    transparent: true,
    opacity: look.opacity ?? 1,
    depthTest: !look.onTop,
  });
  const line = new Line2(new LineGeometry(), material);
  line.frustumCulled = false;
  line.visible = false;
  line.renderOrder = look.onTop ? 5 : 1;
  return line;
}

/**
 * Set the points of a line (x, y, z of each). An unchanged number of points is written in place; another number needs
 * a new geometry, as the buffers can't grow.
 */
export function setLine(line: Line2, flat: ArrayLike<number>): void {
  const count = flat.length / 3;
  line.visible = count > 1;
  if (count < 2) return;
  const start = line.geometry.getAttribute("instanceStart") as InterleavedBufferAttribute | undefined;
  if (start?.data.array.length !== (count - 1) * 6) {
    line.geometry.dispose();
    line.geometry = new LineGeometry();
    line.geometry.setPositions(Array.from(flat));
    return;
  }
  const { array } = start.data;
  for (let i = 0; i < count - 1; i++) {
    for (let k = 0; k < 6; k++) array[i * 6 + k] = flat[i * 3 + k] ?? 0;
  }
  start.data.needsUpdate = true;
}

/** A line for the lifetime of the component. */
export function useLine({ colour, width, opacity = 1, onTop = false }: LineLook): Line2 {
  const line = useMemo(() => makeLine({ colour, width, opacity, onTop }), [colour, width, opacity, onTop]);
  useEffect(
    () => () => {
      line.geometry.dispose();
      line.material.dispose();
    },
    [line],
  );
  return line;
}
