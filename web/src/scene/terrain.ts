import type { TerrainField, TerrainMessage } from "../protocol";

/** Length of a square of the grid on the ground [mm]. */
const GRID = 100;

/** Triangles with the coordinates of the grid that is drawn on them. */
export interface Surface {
  /** Triangles x 3 x (x, y, z) [mm]. */
  positions: Float32Array;
  /** Triangles x 3 x (u, v), a unit for each square of the grid. */
  uvs: Float32Array;
}

// Corners of a box by which of its ends they have, as two triangles a face, counter-clockwise from outside. The bottom
// is never seen.
const FACES: readonly (readonly [number, number, number])[][] = [
  [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
  [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
  [[1, 1, 0], [0, 1, 0], [0, 1, 1], [1, 1, 1]],
  [[0, 1, 0], [0, 0, 0], [0, 0, 1], [0, 1, 1]],
  [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
]; // prettier-ignore

/** The whole surface of a terrain, but for the level ground without end. */
export function surfaceOf(terrain: TerrainMessage): Surface {
  const positions = new Float32Array([
    ...boxes(terrain.boxes_mm),
    ...terrain.triangles_mm,
    ...(terrain.field ? cells(terrain.field) : []),
  ]);
  return { positions, uvs: gridOf(positions) };
}

function boxes(bounds: readonly number[]): number[] {
  const flat: number[] = [];
  for (let at = 0; at < bounds.length; at += 6) {
    for (const face of FACES) {
      const corners = face.map((ends) => ends.map((end, axis) => bounds[at + 3 * end + axis] ?? 0));
      for (const i of [0, 1, 2, 0, 2, 3]) flat.push(...(corners[i] ?? []));
    }
  }
  return flat;
}

/** The cells of a height field as triangles, with the edge of the physics engine between them. */
function cells({ rows, columns, corners_mm, heights_mm }: TerrainField): number[] {
  const [x0 = 0, y0 = 0, x1 = 0, y1 = 0] = corners_mm;
  const flat: number[] = [];
  const push = (row: number, column: number) =>
    flat.push(
      x0 + ((x1 - x0) * column) / (columns - 1),
      y0 + ((y1 - y0) * row) / (rows - 1),
      heights_mm[row * columns + column] ?? 0,
    );
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      push(row, column);
      push(row, column + 1);
      push(row + 1, column + 1);
      push(row, column);
      push(row + 1, column + 1);
      push(row + 1, column);
    }
  }
  return flat;
}

/** Coordinates of the grid: x and y on the ground, the height and the other axis on walls. */
function gridOf(positions: Float32Array): Float32Array {
  const uvs = new Float32Array((positions.length / 3) * 2);
  const at = (corner: number, axis: number) => positions[corner * 3 + axis] ?? 0;
  for (let first = 0; first * 3 < positions.length; first += 3) {
    const side = (axis: number, corner: number) => at(first + corner, axis) - at(first, axis);
    const normal = [0, 1, 2].map((axis) => {
      const [p, q] = [(axis + 1) % 3, (axis + 2) % 3];
      return Math.abs(side(p, 1) * side(q, 2) - side(q, 1) * side(p, 2));
    });
    const steepest = normal.indexOf(Math.max(...normal));
    const [u, v] = steepest === 2 ? [0, 1] : steepest === 1 ? [0, 2] : [1, 2];
    for (let corner = first; corner < first + 3; corner++) {
      uvs[corner * 2] = at(corner, u) / GRID;
      uvs[corner * 2 + 1] = at(corner, v) / GRID;
    }
  }
  return uvs;
}
