import type { RobotMessage } from "../protocol";

/** A robot for tests: six legs of 68, 98 and 181 mm on a circle of 86 mm. */
export function aRobot(): RobotMessage {
  const legs = ["LF", "LM", "LR", "RR", "RM", "RF"];
  const each = <T>(make: (leg: number) => readonly T[]) => legs.flatMap((_, leg) => make(leg));
  const mounts = [
    [74.478, 43],
    [0, 86],
    [-74.478, 43],
    [-74.478, -43],
    [0, -86],
    [74.478, -43],
  ];
  return {
    id: 1,
    type: "robot",
    name: "test",
    preset: null,
    leg_names: legs,
    leg_codes: legs,
    mount_mm: each((leg) => [...(mounts[leg] ?? []), 0]),
    mount_yaw_deg: [30, 90, 150, -150, -90, -30],
    coxa_mm: each(() => [68]),
    femur_mm: each(() => [98]),
    tibia_mm: each(() => [181]),
    femur_axis_offset_mm: each(() => [0, 0]),
    limits_deg: each(() => [-60, 60, -80, 100, -160, 10]),
    foot_radius_mm: each(() => [8]),
    body_size_mm: null,
    mass_kg: 3,
    servos: each(() => ["A", "A", "A"]),
    stall_torque_nm: each(() => [2, 2, 2]),
    body_height_mm: 110,
    swing_height_mm: 30,
    gait: "tripod",
    gaits: ["tripod"],
    stance_mm: null,
    stance_angles_deg: null,
    longest_stroke_mm: 100,
    document: { name: "test", legs: legs.map((name) => ({ name, position_mm: [0, 0, 0], yaw_deg: 0 })) },
    dimensions: [],
    missing: [],
    problems: [],
  };
}
