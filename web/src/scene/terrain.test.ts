import { expect, it } from "vitest";

import type { TerrainMessage } from "../protocol";
import { surfaceOf } from "./terrain";

function aTerrain(changes: Partial<TerrainMessage>): TerrainMessage {
  return {
    id: 1,
    type: "terrain",
    kind: "flat",
    friction: 0.8,
    level: false,
    boxes_mm: [],
    triangles_mm: [],
    field: null,
    ...changes,
  };
}

/** Volume below a closed surface's upper faces, from the triangles' own areas and heights. */
function volumeUnder(positions: Float32Array): number {
  let volume = 0;
  for (let i = 0; i < positions.length; i += 9) {
    const at = (k: number) => positions[i + k] ?? 0;
    const area = ((at(3) - at(0)) * (at(7) - at(1)) - (at(6) - at(0)) * (at(4) - at(1))) / 2;
    volume += (area * (at(2) + at(5) + at(8))) / 3;
  }
  return volume;
}

it("draws the faces of a box that can be seen, outward", () => {
  const { positions, uvs } = surfaceOf(aTerrain({ boxes_mm: [0, 0, 0, 300, 200, 50] }));
  expect(positions.length).toBe(5 * 2 * 9);
  expect(uvs.length).toBe(5 * 2 * 6);
  expect(volumeUnder(positions)).toBeCloseTo(300 * 200 * 50);
  expect(Math.max(...uvs)).toBe(3);
});

it("divides the cells of a height field as the physics engine does", () => {
  const field = { rows: 2, columns: 2, corners_mm: [0, 0, 10, 10], heights_mm: [0, 0, 0, 6] };
  const { positions } = surfaceOf(aTerrain({ field }));
  expect(Array.from(positions)).toEqual([0, 0, 0, 10, 0, 0, 10, 10, 6, 0, 0, 0, 10, 10, 6, 0, 10, 0]);
  expect(volumeUnder(positions)).toBeCloseTo(200);
});
