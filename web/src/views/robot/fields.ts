import type { KeyPath } from "./document";
import { JOINTS } from "../angleText";

/** Form field of a number of the robot file. */
export interface NumberField {
  path: KeyPath;
  label: string;
  unit: string;
  step: number;
  min?: number;
  /** Initial value of a list that is missing in the file. */
  list?: readonly number[];
}

const AXES = ["forward", "left", "up"] as const;

export const LENGTHS: readonly (NumberField & { max: number })[] = [
  { path: ["leg", "coxa_mm"], label: "Coxa", unit: "mm", step: 1, min: 0, max: 150 },
  { path: ["leg", "femur_mm"], label: "Femur", unit: "mm", step: 1, min: 1, max: 250 },
  { path: ["leg", "tibia_mm"], label: "Tibia", unit: "mm", step: 1, min: 1, max: 350 },
];

export const LEG_MORE: readonly NumberField[] = [
  {
    path: ["leg", "femur_axis_offset_mm", 0],
    label: "Femur axis sideways",
    unit: "mm",
    step: 1,
    list: [0, 0],
  },
  { path: ["leg", "femur_axis_offset_mm", 1], label: "Femur axis up", unit: "mm", step: 1, list: [0, 0] },
  { path: ["leg", "foot_radius_mm"], label: "Foot radius", unit: "mm", step: 0.5, min: 0 },
];

export const BODY: readonly NumberField[] = [
  { path: ["body", "mass_kg"], label: "Mass", unit: "kg", step: 0.01, min: 0.000001 },
  ...(["Length", "Width", "Height"] as const).map((label, i) => ({
    path: ["body", "size_mm", i],
    label,
    unit: "mm",
    step: 1,
    min: 0.001,
    list: [100, 100, 40],
  })),
  ...AXES.map((axis, i) => ({
    path: ["body", "com_mm", i],
    label: `Centre of mass ${axis}`,
    unit: "mm",
    step: 1,
    list: [0, 0, 0],
  })),
];

export const MASSES: readonly NumberField[] = JOINTS.flatMap((joint) => [
  { path: ["leg", "mass_kg", joint], label: `Mass of ${joint}`, unit: "kg", step: 0.005, min: 0 },
  {
    path: ["leg", "com_mm", joint],
    label: `${title(joint)}: centre of mass from its joint`,
    unit: "mm",
    step: 1,
  },
]);

export const LIMITS: readonly { joint: string; low: NumberField; high: NumberField }[] = JOINTS.map(
  (joint) => {
    const end = (i: number, word: string): NumberField => ({
      path: ["leg", "limits_deg", joint, i],
      label: `${title(joint)}, ${word}`,
      unit: "°",
      step: 1,
      min: -180,
      list: [-90, 90],
    });
    return { joint, low: end(0, "lowest"), high: end(1, "highest") };
  },
);

export const GAIT: readonly NumberField[] = [
  { path: ["gait", "body_height_mm"], label: "Body height", unit: "mm", step: 1, min: 0.001 },
  { path: ["gait", "swing_height_mm"], label: "Swing height", unit: "mm", step: 1, min: 0.001 },
];

/** Form fields of the entry of one leg. */
export function mountFields(leg: number): readonly NumberField[] {
  return [
    ...AXES.map((axis, i) => ({
      path: ["legs", leg, "position_mm", i],
      label: `Coxa axis ${axis}`,
      unit: "mm",
      step: 1,
      list: [0, 0, 0],
    })),
    { path: ["legs", leg, "yaw_deg"], label: "Yaw (90° is left)", unit: "°", step: 1, min: -360 },
  ];
}

/** Form fields of values that may differ between legs. */
export function ownFields(leg: number): readonly NumberField[] {
  return LENGTHS.map(({ path, label, unit, step, min }) => ({
    path: ["legs", leg, ...path.slice(1)],
    label: `${label} of this leg`,
    unit,
    step,
    min,
  }));
}

function title(word: string): string {
  return word.charAt(0).toUpperCase() + word.slice(1);
}
