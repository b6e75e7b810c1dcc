"""One cycle of steady walking: what repeats between start and stop."""

from __future__ import annotations

from collections.abc import Sequence

from tarsus.arrays import Array, as_array, namespace, stack_last
from tarsus.gait.gait import Gait
from tarsus.gait.path import carry, carry_back, exponential
from tarsus.gait.swing import swing
from tarsus.kinematics.pose import Pose

__all__ = ["cycle_feet", "tilted_body"]


def cycle_feet(
    gait: Gait, rest: Array, twist: Sequence[float] | Array, *, swing_height: Array, phases: Array
) -> tuple[Array, Array]:
    """Return the feet over one cycle of steady walking, in the body's heading frame on the ground.

    In stance a foot goes from half a stroke ahead of its rest foothold to half a stroke behind, on a straight line or
    an arc (source 001); in swing it goes over the ground from foothold to foothold while the body moves on.

    Parameters
    ----------
    gait : Gait
        Duty factor and offsets.
    rest : array, shape (..., legs, 3)
        Rest footholds in the heading frame, at the ground's height [m].
    twist : array, shape (..., 3)
        What the body moves in one stance time: forward [m], left [m], yaw [rad].
    swing_height : array, shape (...)
        Lift of the swinging foot [m].
    phases : array, shape (m,)
        Moments of the cycle, in cycles.

    Returns
    -------
    feet : array, shape (..., m, legs, 3)
        In the heading frame [m].
    contacts : array of bool, shape (m, legs)
        Whether each foot is on the ground.
    """
    xp = namespace(rest, twist, phases, swing_height)
    rest, twist, phases = as_array(xp, rest), as_array(xp, twist), as_array(xp, phases)
    _, phase, contacts = gait.phase(phases)
    displacement = [twist[..., i, None, None] for i in range(3)]
    # Seen from the body's place in the middle of the stance, the foothold is `rest`; the next is a cycle further.
    since_middle = phase / gait.duty_factor - 0.5
    here = exponential(displacement, since_middle)
    ahead = exponential(displacement, xp.full_like(phase, 1 / gait.duty_factor))
    footholds = rest[..., None, :, :]
    share = xp.where(contacts, xp.zeros_like(phase), (phase - gait.duty_factor) / (1 - gait.duty_factor))
    landing = carry(ahead, footholds[..., None, :])[..., 0, :]
    height = as_array(xp, swing_height)[..., None, None] + xp.zeros_like(share)
    on_ground = swing(footholds + xp.zeros_like(landing), landing, share, height)
    return carry_back(here, on_ground[..., None, :])[..., 0, :], contacts


def tilted_body(place: Array, *, body_height: Array, body_tilt: Sequence[float]) -> Pose:
    """Return the body's poses at places on the ground: tilted, at its height (source 001's A, B and G).

    Parameters
    ----------
    place : array, shape (..., 3)
        x [m], y [m] and yaw [rad] of the heading frame in G.
    body_height : array, shape (...)
        Height of the body's origin [m].
    body_tilt : sequence of float
        Roll and pitch against the heading frame [rad].
    """
    xp = namespace(place, body_height)
    x, y, yaw = place[..., 0], place[..., 1], place[..., 2]
    zero = xp.zeros_like(x)
    return Pose.from_rpy(body_tilt[0] + zero, body_tilt[1] + zero, yaw, stack_last(xp, (x, y, body_height + zero)))
