import { fixed } from "../controls/numbers";

export const JOINTS = ["coxa", "femur", "tibia"] as const;

/** The joint angles as tab-separated text for spreadsheets. */
export function angleText(codes: readonly string[], angles: ArrayLike<number>): string {
  const rows = codes.map((code, leg) =>
    [code, ...JOINTS.map((_, i) => fixed(angles[leg * 3 + i] ?? 0, 4))].join("\t"),
  );
  return [["leg", ...JOINTS.map((joint) => `${joint}_deg`)].join("\t"), ...rows].join("\n");
}
