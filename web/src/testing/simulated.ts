import type { FramePhysics, SimulatedMessage } from "../protocol";
import { aWalk } from "./walk";

/** The walk for tests in physics: 2 mm lower, with a foot that slides and a servo at its maximum torque at its end. */
export function aSimulatedWalk(): SimulatedMessage {
  const { rate_hz, count, position_mm, rpy_deg, angles_deg, contacts, margin_mm, com_mm } = aWalk();
  return {
    id: 2,
    type: "simulated",
    rate_hz,
    count,
    position_mm: position_mm.map((value, i) => (i % 3 === 2 ? value - 2 : value)),
    rpy_deg,
    angles_deg,
    contacts,
    margin_mm,
    com_mm,
    forces_n: Array.from({ length: count * 18 }, (_, i) => (i % 3 === 2 ? 5 : 0)),
    slip_mm_s: Array.from({ length: count * 6 }, (_, i) => (i === 12 ? 40 : 0)),
    saturated: ["0", "0", "1"].map((first) => first + "0".repeat(17)),
    tilt_deg: [0, 1, 2],
    ok: false,
    verdict: "failed",
    problems: ["fell at 0.20 s"],
    way_ratio: 0.98,
    turn_ratio: null,
    deviation_mm: 1,
    sag_mm: 2,
    slip_mm: 3,
    joints: [],
    energy_j: 1,
    fell_at_s: 0.2,
    assumed: [],
  };
}

/** A driven robot in physics for tests: 100 mm from where it is commanded to be. */
export function aFramePhysics(changes: Partial<FramePhysics> = {}): FramePhysics {
  return {
    position_mm: [100, 0, 105],
    rpy_deg: [0, 0, 10],
    angles_deg: Array.from({ length: 18 }, () => 1),
    contacts: "101010",
    forces_n: Array.from({ length: 18 }, (_, i) => i),
    slip_mm_s: [0, 0, 0, 0, 0, 20],
    saturated: `1${"0".repeat(17)}`,
    tilt_deg: 3,
    deviation_mm: 100,
    fallen: false,
    problems: [],
    ...changes,
  };
}
