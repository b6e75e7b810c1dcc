import type { WalkOptions } from "../../protocol";

export type Path = WalkOptions["path"];
export type Way = Path["way"];

/** What the inputs of a kind of path take. */
export interface PathProps<W extends Way> {
  path: Extract<Path, { way: W }>;
  set: (path: Path, commit?: boolean) => void;
}

/** A path to begin with, of each kind. */
export function pathOf(way: Way): Path {
  switch (way) {
    case "straight":
      return { way, distance_mm: 500, heading_deg: 0 };
    case "curve":
      return { way, angle_deg: 60, centre_mm: [0, 500] };
    case "twist":
      return { way, velocity_mm_s: [60, 0], turn_deg_s: 12, duration_s: 8 };
  }
}
