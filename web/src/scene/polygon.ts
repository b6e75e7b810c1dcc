/** Plane geometry. */

export type Point2 = readonly [number, number];

/** Convex hull, counter-clockwise (Andrew's monotone chain). Fewer than three points are returned unchanged. */
export function convexHull(points: readonly Point2[]): Point2[] {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  if (sorted.length < 3) return sorted;
  const chain = (ordered: readonly Point2[]) => {
    const hull: Point2[] = [];
    for (const point of ordered) {
      while (hull.length > 1 && turns(hull.at(-2), hull.at(-1), point) <= 0) hull.pop();
      hull.push(point);
    }
    return hull.slice(0, -1);
  };
  return [...chain(sorted), ...chain([...sorted].reverse())];
}

function turns(a: Point2 | undefined, b: Point2 | undefined, c: Point2): number {
  if (!a || !b) return 0;
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** The point on the boundary of a polygon nearest to a point. */
export function nearestOnEdge(polygon: readonly Point2[], point: Point2): Point2 {
  let nearest: Point2 = polygon[0] ?? point;
  let least = Infinity;
  polygon.forEach((a, i) => {
    const b = polygon[(i + 1) % polygon.length] ?? a;
    const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    const along = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / (dx * dx + dy * dy || 1);
    const t = Math.min(1, Math.max(0, along));
    const candidate: Point2 = [a[0] + t * dx, a[1] + t * dy];
    const far = Math.hypot(candidate[0] - point[0], candidate[1] - point[1]);
    if (far < least) [least, nearest] = [far, candidate];
  });
  return nearest;
}
