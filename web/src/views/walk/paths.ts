import type { WalkOptions } from "../../protocol";

export type Path = WalkOptions["path"];
export type PathKind = Path["kind"];

/** Props of the inputs of a kind of path. */
export interface PathProps<W extends PathKind> {
  path: Extract<Path, { kind: W }>;
  set: (path: Path, commit?: boolean) => void;
}

/** Default path of each kind. */
export function pathOf(kind: PathKind): Path {
  switch (kind) {
    case "straight":
      return { kind, distance_mm: 500, heading_deg: 0 };
    case "curve":
      return { kind, angle_deg: 60, centre_mm: [0, 500] };
    case "twist":
      return { kind, velocity_mm_s: [60, 0], turn_deg_s: 12, duration_s: 8 };
  }
}
