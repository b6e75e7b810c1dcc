import type { WalkOptions } from "../../protocol";

export type Path = WalkOptions["path"];
export type PathKind = Path["way"];

/** Props of the inputs of a kind of path. */
export interface PathProps<W extends PathKind> {
  path: Extract<Path, { way: W }>;
  set: (path: Path, commit?: boolean) => void;
}

/** Default path of each kind. */
export function pathOf(way: PathKind): Path {
  switch (way) {
    case "straight":
      return { way, distance_mm: 500, heading_deg: 0 };
    case "curve":
      return { way, angle_deg: 60, centre_mm: [0, 500] };
    case "twist":
      return { way, velocity_mm_s: [60, 0], turn_deg_s: 12, duration_s: 8 };
  }
}
