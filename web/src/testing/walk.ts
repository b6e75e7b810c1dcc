import type { WalkMessage } from "../protocol";

/** A walk for tests: three samples, 10 mm and 0.1 s apart. */
export function aWalk(): WalkMessage {
  const samples = [0, 1, 2];
  const least = { mm: 0, at_s: 0 };
  return {
    id: 1,
    type: "walk",
    rate_hz: 10,
    count: 3,
    position_mm: samples.flatMap((i) => [10 * i, 0, 110]),
    rpy_deg: samples.flatMap(() => [0, 0, 0]),
    angles_deg: samples.flatMap((i) => Array.from({ length: 18 }, () => i)),
    contacts: samples.map(() => "111111"),
    reach: null,
    margin_mm: samples.map(() => 50),
    com_mm: samples.flatMap((i) => [10 * i, 0]),
    gait: "tripod",
    duty_factor: 0.5,
    offsets: [0, 0.5, 0, 0.5, 0, 0.5],
    duration_s: 0.2,
    cycle_time_s: 1,
    steps: 1,
    stroke_mm: 20,
    speed_mm_s: 100,
    body_height_mm: 110,
    swing_height_mm: 30,
    longest_stroke_mm: 100,
    end: { x_mm: 20, y_mm: 0, turned_deg: 0 },
    joint_speed: [],
    least_margin: least,
    nearest_feet: least,
    nearest_legs: [],
    possible: true,
    problems: [],
    assumed: [],
  };
}
