"""Swing trajectory of a foot from one foothold to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tarsus.arrays import Array, as_array, namespace, stack_last

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["horizontal_profile", "swing_position", "vertical_profile"]


def horizontal_profile(phase: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
    """Return the fraction ``(...)`` of the horizontal distance at a swing phase: ``10 s^3 - 15 s^4 + 6 s^5``."""
    return phase * phase * phase * (10 - 15 * phase + 6 * phase * phase)


def vertical_profile(phase: Float[Array, "*batch"]) -> Float[Array, "*batch"]:
    """Return the fraction ``(...)`` of the swing height at a swing phase: ``64 s^3 (1 - s)^3``, 1 at mid-swing."""
    return (4 * phase * (1 - phase)) ** 3


def swing_position(
    start: Float[Array, "*#batch 3"],
    end: Float[Array, "*#batch 3"],
    phase: Float[Array, "*#batch"],
    swing_height: Float[Array, "*#batch"],
) -> Float[Array, "*batch 3"]:
    """Return the position of a swinging foot in the ground frame.

    Horizontally, the quintic ``10 s^3 - 15 s^4 + 6 s^5``, with zero velocity and acceleration at both ends, so that the
    foot does not scuff at lift-off and touchdown. Vertically, ``64 s^3 (1 - s)^3``, with the same property.

    Parameters
    ----------
    start, end : array, shape (..., 3)
        Footholds in G [m].
    phase : array, shape (...)
        Phase of the swing, 0 to 1.
    swing_height : array, shape (...)
        Greatest height above the line between the footholds [m].

    Returns
    -------
    array, shape (..., 3)
        Feet in G [m].
    """
    xp = namespace(start, end, phase, swing_height)
    start, end, phase = as_array(xp, start), as_array(xp, end), as_array(xp, phase)
    along, up = horizontal_profile(phase), as_array(xp, swing_height) * vertical_profile(phase)
    parts = [start[..., i] + (end[..., i] - start[..., i]) * along for i in range(3)]
    return stack_last(xp, (parts[0], parts[1], parts[2] + up))
