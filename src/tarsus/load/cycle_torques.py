"""Joint torques over one steady gait cycle, for a batch of designs.

Steady walking with a level body on level ground is planar statics: every force is vertical, so that a joint torque is
a force times a radial distance in the leg's plane, and the coxa torques are zero. This takes a fraction of the time of
`joint_torques`, which handles arbitrary poses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, as_floats, broadcast_shapes, is_traced, namespace, require_finite, stack_last
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.walk_setup import require_number
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.stance import default_body_height, default_stance, default_swing_height
from tarsus.kinematics.underside import FLOOR_TOLERANCE, floor_depth
from tarsus.load.cycle_sweep import CyclePhases, CycleSweep
from tarsus.load.payload import Payload, as_payload
from tarsus.representation import Rows, represented
from tarsus.robot.robot import JOINTS, Robot, require_robot
from tarsus.robot.shape import TAILS

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int, Shaped

__all__ = ["CycleTorques", "cycle_torques"]

_MOST_PHASES = 1_000_000


@represented("ok", "peak", "phases", "angles", "torques", "forces", "balanced")
@dataclass(frozen=True, eq=False, kw_only=True)
class CycleTorques:
    """Steady gait cycles of a batch of designs ``(...)``.

    Attributes
    ----------
    phases : array, shape (phases,)
        Phases of the cycle, in [0, 1).
    contacts : array of bool, shape (phases, legs)
        Which feet are on the ground.
    angles : array, shape (..., phases, legs, 3)
        Joint angles [rad].
    reach : array of int8, shape (..., phases, legs)
        Codes of `Reach`. Out of reach, angles and torques are those of the nearest reachable foot position.
    torques : array, shape (..., phases, legs, 3)
        Joint torques [N m]; 0 for the coxa joints on level ground.
    forces : array, shape (..., phases, legs, 3)
        Ground on foot [N].
    balanced : array of bool, shape (..., phases)
        Whether there is an equilibrium; if not, torques and forces are those at the onset of tipping.
    body_depth : array, shape (...)
        Depth of the body's lowest point below the ground [m]; negative above it.
    """

    phases: Float[np.ndarray, "phases"]
    contacts: Bool[np.ndarray, "phases legs"]
    angles: Float[Array, "*#batch phases legs 3"]
    reach: Int[Array, "*#batch phases legs"]
    torques: Float[Array, "*#batch phases legs 3"]
    forces: Float[Array, "*#batch phases legs 3"]
    balanced: Bool[Array, "*#batch phases"]
    body_depth: Float[Array, "*#batch"]

    def _rows(self) -> Rows:
        """Return the greatest torque of each kind of joint: least, median and greatest of all designs."""
        if is_traced(self.torques):
            return ()
        peak = np.asarray(self.peak).reshape(-1, len(JOINTS))
        levels = {"least": peak.min(0), "median": np.median(peak, axis=0), "greatest": peak.max(0)}
        return [
            {"joint": joint} | {f"{level} peak [N m]": f"{values[i]:.3f}" for level, values in levels.items()}
            for i, joint in enumerate(JOINTS)
        ]

    @cached_property
    def peak(self) -> Float[Array, "*batch 3"]:
        """Largest torque of coxa, femur and tibia over the cycle and all legs ``(..., 3)`` [N m]."""
        xp = namespace(self.torques)
        return xp.max(xp.abs(self.torques), axis=(-3, -2))

    @cached_property
    def ok(self) -> Bool[Array, "*batch"]:
        """Whether the body is above the ground, and all feet are within reach and in equilibrium at every phase."""
        xp = namespace(self.reach, self.balanced)
        feet = xp.all(self.reach == 0, axis=(-2, -1)) & xp.all(self.balanced, axis=-1)
        return feet & (self.body_depth <= FLOOR_TOLERANCE)


def cycle_torques(
    robot: Robot,
    gait: Gait,
    *,
    stroke: Float[Array, "*#batch"],
    heading: float = 0.0,
    body_height: Float[Array, "*#batch"] | None = None,
    swing_height: Float[Array, "*#batch"] | None = None,
    phases: int = 32,
    payload: Payload | float = 0.0,
) -> CycleTorques:
    """Return joint angles, contact forces and torques over one steady straight gait cycle.

    The footholds are those of `default_stance`; body and ground are level. Quasi-static, like `joint_torques`.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs; its masses must be known.
    gait : Gait
        The gait.
    stroke : array, shape (...)
        Distance that the body moves during a stance, greater than 0 [m].
    heading : float
        Direction of walking, counter-clockwise from the front [rad].
    body_height : array, shape (...), optional
        Height of the body's origin over the ground [m]; default: the robot's.
    swing_height : array, shape (...), optional
        Swing height of the feet [m]; default: the robot's.
    phases : int
        Number of evenly spaced phases.
    payload : Payload or float
        Payload on the body; a number is a mass at the body's origin [kg].

    Raises
    ------
    MissingDataError
        If the robot's masses are unknown.
    UnreachableError
        If a leg of a design can't reach the ground at that body height; the message names it.
    InputError
        If a number is not finite or out of range, or the gait is for another number of legs or has a body shift.
    """
    require_robot(robot)
    robot.require_masses()
    gait.require_legs(robot.legs)
    if gait.body_shift:
        raise InputError(
            f"gait {gait.name!r} shifts the body, differently for each design; cycle_torques is for gaits without "
            "a body shift: use joint_loads of a planned walk"
        )
    carried = as_payload(payload)
    if not 1 <= phases <= _MOST_PHASES or phases != int(phases):
        raise InputError(f"phases is {phases}; it must be a whole number from 1 to {_MOST_PHASES}")
    if not math.isfinite(heading):
        raise InputError(f"heading is {heading} rad; it must be finite")
    body_height = default_body_height(robot) if body_height is None else body_height
    swing_height = default_swing_height(robot) if swing_height is None else swing_height
    arrays = {name: getattr(robot, name) for name in TAILS if getattr(robot, name) is not None}
    xp = namespace(stroke, body_height, swing_height, *arrays.values())
    stroke, body_height, swing_height = (
        as_floats(xp, value, name=name)
        for name, value in (("stroke", stroke), ("body_height", body_height), ("swing_height", swing_height))
    )
    _require_stroke(stroke)
    rest = default_stance(robot, body_height, swing_height=swing_height)
    batch = broadcast_shapes(
        "robot, stroke, body height and swing height",
        robot.batch_shape,
        *(v.shape for v in (stroke, body_height, swing_height)),
    )
    cycle = CyclePhases.of(gait, heading, int(phases))
    sweep = CycleSweep(xp, robot, carried, rest, stroke, body_height, swing_height, batch or (1,), cycle)
    return _result(sweep, sweep.by_blocks() if xp is np else sweep.by_angles(), batch)


def _require_stroke(stroke: Float[Array, "*#batch"]) -> None:
    """Refuse strokes that are not finite or not greater than 0, as `plan_walk` does; traced values can't be checked."""
    require_finite("stroke", stroke)
    if is_traced(stroke):
        return
    values = np.asarray(stroke)
    for place in np.argwhere(values <= 0).tolist():
        where = f"[{', '.join(map(str, place))}]" if place else ""
        require_number(f"stroke{where}", values[tuple(place)], zero=False)


def _result(sweep: CycleSweep, rows: tuple[Shaped[Array, "..."], ...], batch: tuple[int, ...]) -> CycleTorques:
    """Return the results with the batch axes first; NumPy arrays are views."""
    xp, cycle, legs, phase_count = sweep.xp, sweep.cycle, sweep.robot.legs, len(sweep.cycle.phases)

    def batch_first(values: Array, *front: int) -> Array:
        axes = tuple(range(len(front), len(front) + len(batch)))
        return xp.permute_dims(xp.reshape(values, (*front, *batch)), (*axes, *reversed(range(len(front)))))

    angles, torques, forces = (batch_first(values, 3, legs, phase_count) for values in rows[:3])
    height, zero = sweep.body_height, xp.zeros_like(sweep.body_height)
    return CycleTorques(
        phases=cycle.phases,
        contacts=cycle.contacts,
        angles=angles,
        reach=batch_first(rows[3], legs, phase_count),
        torques=torques,
        forces=forces,
        balanced=batch_first(rows[4], phase_count),
        body_depth=floor_depth(sweep.robot, Pose(position=stack_last(xp, (zero, zero, height)))),
    )
