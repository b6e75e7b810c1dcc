"""Write the table of ways to compensate for deflection in how-true.md: what each does to walks in physics.

Swinging feet may be lifted by what the body sags, instead of or beside lowering the feet that stand. All 64 walks with
each way take about ten minutes.
"""

from __future__ import annotations

import dataclasses
import itertools
from pathlib import Path
from typing import Any

import numpy as np

from page_tables import write_tables
from statics_true import GAITS, PATHS, ROBOTS, walk
from tarsus.gait.motion import Motion
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.leg import leg_jacobian
from tarsus.load.deflection import TRANSFER_TIME, commands_within_limits, joint_deflections
from tarsus.robot.file import load_robot
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.truth.outcome import Outcome
from tarsus.simulation.truth.traced_plant import play

PAGE = Path(__file__).parent / "how-true.md"
# Share of the deflection of the joints that is added to commands, and of the sag by which swinging feet are lifted.
WAYS = {
    "none": (0.0, 0.0),
    "three quarters of the deflection": (0.75, 0.0),
    "swinging feet lifted by the sag": (0.0, 1.0),
    "swinging feet lifted by half the sag": (0.0, 0.5),
    "half the deflection, lifted by a quarter of the sag": (0.5, 0.25),
    "half the deflection, lifted by half the sag": (0.5, 0.5),
}


def averaged(values: Any, time: Any) -> Any:
    """Return the mean of each column over the time in which a foot takes over its load."""
    steps = np.diff(time)[:, None] * (values[1:] + values[:-1]) / 2
    total = np.concatenate([np.zeros_like(values[:1]), np.cumsum(steps, axis=0)])
    start = np.clip(time - TRANSFER_TIME / 2, time[0], time[-1])
    end = np.clip(time + TRANSFER_TIME / 2, time[0], time[-1])
    return np.stack([(np.interp(end, time, c) - np.interp(start, time, c)) / (end - start) for c in total.T], axis=-1)


def compensated(motion: Motion, share: float, lift: float) -> Motion:
    """Return a motion with a share of the deflection in its commands, and swinging feet lifted by one of the sag."""
    if not share and not lift:
        return motion
    deflection = joint_deflections(motion)
    rise = -(np.asarray(leg_jacobian(motion.robot, motion.angles)) @ deflection[..., None])[..., 2, 0]
    at = motion.feet[:, :, :2] - motion.body.position[:, None, :2]
    sag = np.zeros(motion.contacts.shape)
    for sample, standing in enumerate(motion.contacts):
        plane = np.c_[np.ones(motion.robot.legs), at[sample]]
        found = np.linalg.lstsq(plane[standing], rise[sample, standing], rcond=None)[0]
        sag[sample] = plane @ found - rise[sample] * ~standing
    swinging = averaged((~motion.contacts).astype(float), motion.time)
    feet = np.array(motion.feet)
    feet[..., 2] += lift * swinging * np.maximum(averaged(sag, motion.time), 0.0)
    solved = inverse_kinematics(motion.robot, feet, body=motion.body)
    lifted = np.where((np.asarray(solved.reach) == 0)[..., None], solved.angles, motion.angles)
    offsets = lifted - motion.angles + share * deflection
    return dataclasses.replace(motion, angles=commands_within_limits(motion.robot, motion.angles, offsets))


def measured(motion: Motion) -> list[float]:
    """Return what a walk does: way or turn over the plan, slip [mm], tilt [deg], torques [N m], saturation [%]."""
    trace = play(motion, SimulatedPlant(motion.robot, sensors="blind"))
    outcome, torques = Outcome.of(trace), trace.torques
    turns = np.hypot(*(motion.body.position[-1] - motion.body.position[0])[:2]) < 1e-3
    ratio = outcome.turn_ratio if turns else outcome.way_ratio
    peak, rms = np.abs(torques).max((0, 1)), np.sqrt((torques**2).mean(0)).max(0)
    saturated = 100 * trace.saturated.mean()
    return [ratio, 1000 * float(np.max(outcome.slip)), float(np.degrees(outcome.tilt)), *peak, *rms, saturated]


def row(name: str, values: Any) -> str:
    """Return a row of the table for all walks with a way to compensate."""
    ratio, middle = values[:, 0], np.median(values, axis=0)
    within = (np.abs(ratio - 1) <= 0.02).sum()
    cells = [
        f"{middle[0]:.3f} ({ratio.min():.3f}-{ratio.max():.3f})",
        f"{within} of {len(values)}",
        f"{middle[1]:.0f} mm",
        f"{middle[2]:.1f} deg",
        *(f"{middle[3 + joint]:.2f}, {middle[6 + joint]:.2f}" for joint in range(3)),
        f"{values[:, 9].max():.2f} %",
    ]
    return f"| {name} | {' | '.join(cells)} |\n"


def table() -> str:
    """Return the table over all walks at the default speed."""
    motions = [walk(*each, "default") for each in itertools.product(map(load_robot, ROBOTS), GAITS, PATHS)]
    columns = ("commands", "way", "within 2 %", "slip", "tilt", "coxa", "femur", "tibia", "saturated")
    head = f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}\n"
    rows = (row(name, np.array([measured(compensated(m, *shares)) for m in motions])) for name, shares in WAYS.items())
    return head + "".join(rows)


if __name__ == "__main__":
    write_tables(__doc__, PAGE, lambda _: {"compensations": table()})
