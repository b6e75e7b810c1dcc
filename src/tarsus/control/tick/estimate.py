"""Estimate: what valid readings tell of the ground and of the robot's attitude."""

from __future__ import annotations

from tarsus.control.pose.attitude import CommandedAttitude
from tarsus.control.readings import SensorReadings
from tarsus.control.terrain.early_contact import stop_on_contact
from tarsus.control.tick.components import WalkComponents
from tarsus.control.tick.state import TickState
from tarsus.control.walk.ground_pose import foot_positions

__all__ = ["estimated"]


def estimated(walk: WalkComponents, tick: TickState, readings: SensorReadings | None, dt: float) -> TickState:
    """Return the state after readings: feet that touch ground early stop on it.

    Parameters
    ----------
    walk : WalkComponents
        The components; the terrain adaptation takes in the readings.
    tick : TickState
        The state.
    readings : SensorReadings or None
        What is measured.
    dt : float
        Length of the tick [s].
    """
    terrain, transitions = walk.terrain, walk.transitions
    if readings is None and not terrain.has_feedback:
        return tick
    state, body = tick.gait, transitions.scheduler.requested.body
    height = float(state.posture.value[2]) - transitions.current.parameters.correction[2]
    terrain.sense(
        readings,
        dt,
        state,
        feet=foot_positions(state),
        contacts=walk.standing_feet(state),
        angles=walk.time_scaling.angles,
        commanded=CommandedAttitude(body[3], body[4], state.yaw + body[5], height),
    )
    met = terrain.early_contacts(state)
    if not met.any():
        return tick
    swing_rate = transitions.timing.frequency / state.swings(transitions.timing.gait.duty_factor)
    stopped = stop_on_contact(walk.robot, state, met, acceleration=walk.joint_acceleration, swing_rate=swing_rate)
    return tick._replace(gait=stopped)
