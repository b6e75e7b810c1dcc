"""Estimate: what readings tell about the ground; feet that meet it land, or rise over an obstacle."""

from __future__ import annotations

from tarsus.control.readings import SensorReadings
from tarsus.control.tick.components import WalkComponents
from tarsus.control.walk_state import TickState

__all__ = ["estimated"]


def estimated(walk: WalkComponents, tick: TickState, readings: SensorReadings | None, dt: float) -> TickState:
    """Return the state after the readings of a tick; it is unchanged for a walk that has never had any.

    Parameters
    ----------
    walk, tick : WalkComponents, TickState
        The components; the state.
    readings, dt : SensorReadings or None, float
        The readings, or None without any; length of the tick [s].
    """
    if readings is None and not tick.gait.felt:
        return tick
    timing, angles = walk.transitions.timing, walk.time_scaling.angles
    state = walk.ground.sense(readings, dt, tick.gait, timing=timing, angles=angles.tolist())
    if not state.felt:
        # Without felt ground nothing is compensated: the guard checks these feet, and would find that they drag.
        return tick
    ground, deflection = walk.ground, walk.solver.deflection
    # Contacts tell which feet bear load only where forces are not measured.
    down = () if ground.body.measured.forces else state.down.tolist()
    bears = [on and ground.contacts.touches(leg) for leg, on in enumerate(down)]
    deflection.step(ground.body.measured, angles, dt, slope=abs(ground.body.stance.uphill), bears=bears)
    ground.body.lowered = deflection.lowered
    walk.transitions.footholds.feet_landed(tick.gait.down, state.down)
    return tick if state is tick.gait else tick._replace(gait=state)
