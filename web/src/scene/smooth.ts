/** Points that are drawn between two neighbours. */
const PARTS = 4;

/**
 * A smooth curve through points, x, y, z of each: cubic Catmull-Rom segments, cut off at the heights of their ends, so
 * that no foot seems to go into the ground.
 */
export function smoothed(points: Float32Array, out: Float32Array): Float32Array {
  const last = points.length / 3 - 1;
  for (let i = 0; i < last; i++) {
    for (let part = 0; part < PARTS; part++) {
      for (let axis = 0; axis < 3; axis++) {
        const [a, b, c, d] = [i - 1, i, i + 1, i + 2].map(
          (k) => points[Math.min(last, Math.max(0, k)) * 3 + axis] ?? 0,
        ) as [number, number, number, number];
        const value = cubic(a, b, c, d, part / PARTS);
        out[(i * PARTS + part) * 3 + axis] =
          axis === 2 ? Math.min(Math.max(b, c), Math.max(Math.min(b, c), value)) : value;
      }
    }
  }
  out.set(points.subarray(last * 3), last * PARTS * 3);
  return out;
}

/** Room for the smoothed curve through a number of points. */
export function roomFor(count: number): Float32Array {
  return new Float32Array(((count - 1) * PARTS + 1) * 3);
}

function cubic(a: number, b: number, c: number, d: number, t: number): number {
  return b + (t / 2) * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}
