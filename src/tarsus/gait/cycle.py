"""One cycle of steady walking, between start and stop."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tarsus.arrays import Array, as_array, namespace, stack_last
from tarsus.gait.gait import Gait
from tarsus.gait.path import exponential_map, ground_to_heading, heading_to_ground
from tarsus.gait.swing import swing_position
from tarsus.kinematics.pose import Pose

if TYPE_CHECKING:
    from jaxtyping import Bool, Float

__all__ = ["cycle_feet", "tilted_body"]


def cycle_feet(
    gait: Gait,
    rest: Float[Array, "*#batch legs 3"],
    twist: Sequence[float] | Float[Array, "*#batch 3"],
    *,
    swing_height: Float[Array, "*#batch"],
    phases: Float[Array, "m"],
) -> tuple[Float[Array, "*batch m legs 3"], Bool[Array, "m legs"]]:
    """Return the feet over one cycle of steady walking, in the body's heading frame on the ground.

    In stance a foot moves from half a stroke ahead of its rest foothold to half a stroke behind, on a straight line or
    an arc (source 001); in swing it moves from foothold to foothold over the ground while the body moves.

    Parameters
    ----------
    gait : Gait
        Duty factor and offsets.
    rest : array, shape (..., legs, 3)
        Rest footholds in the heading frame, at the ground's height [m].
    twist : array, shape (..., 3)
        Displacement of the body in one stance time: forward [m], left [m], yaw [rad].
    swing_height : array, shape (...)
        Swing height [m].
    phases : array, shape (m,)
        Phases of the cycle, in cycles.

    Returns
    -------
    feet : array, shape (..., m, legs, 3)
        Feet in the heading frame [m].
    contacts : array of bool, shape (m, legs)
        Whether each foot is on the ground.
    """
    xp = namespace(rest, twist, phases, swing_height)
    rest, twist, phases = as_array(xp, rest), as_array(xp, twist), as_array(xp, phases)
    _, phase, contacts = gait.phase(phases)
    displacement = [twist[..., i, None, None] for i in range(3)]
    # Relative to the body at mid-stance the foothold is `rest`; the next one is a cycle ahead.
    since_mid_stance = phase / gait.duty_factor - 0.5
    body = exponential_map(displacement, since_mid_stance)
    ahead = exponential_map(displacement, xp.full_like(phase[:1, :1], 1 / gait.duty_factor))
    footholds = rest[..., None, :, :]
    swing_phase = xp.where(contacts, xp.zeros_like(phase), (phase - gait.duty_factor) / (1 - gait.duty_factor))
    landing = heading_to_ground(ahead, footholds[..., None, :])[..., 0, :]
    height = as_array(xp, swing_height)[..., None, None] + xp.zeros_like(swing_phase)
    on_ground = swing_position(footholds + xp.zeros_like(landing), landing, swing_phase, height)
    return ground_to_heading(body, on_ground[..., None, :])[..., 0, :], contacts


def tilted_body(
    planar_pose: Float[Array, "*#batch 3"], *, body_height: Float[Array, "*#batch"], body_tilt: Sequence[float]
) -> Pose:
    """Return the body's poses at planar poses, with its tilt and height (source 001's A, B and G).

    Parameters
    ----------
    planar_pose : array, shape (..., 3)
        x [m], y [m] and yaw [rad] of the heading frame in G.
    body_height : array, shape (...)
        Height of the body's origin [m].
    body_tilt : sequence of float
        Roll and pitch relative to the heading frame [rad].

    Returns
    -------
    Pose
        Pose of B in G, with batch axes ``(...)``.
    """
    xp = namespace(planar_pose, body_height)
    x, y, yaw = planar_pose[..., 0], planar_pose[..., 1], planar_pose[..., 2]
    zero = xp.zeros_like(x)
    return Pose.from_rpy(body_tilt[0] + zero, body_tilt[1] + zero, yaw, stack_last(xp, (x, y, body_height + zero)))
