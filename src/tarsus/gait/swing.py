"""How a foot swings from one foothold to the next."""

from __future__ import annotations

from tarsus.arrays import Array, as_array, namespace, stack_last

__all__ = ["ground_share", "height_share", "swing"]


def ground_share(share: Array) -> Array:
    """Return the share of the way over the ground after a share of the swing: ``10 s^3 - 15 s^4 + 6 s^5``."""
    return share * share * share * (10 - 15 * share + 6 * share * share)


def height_share(share: Array) -> Array:
    """Return the height over the lift after a share of the swing: ``64 s^3 (1 - s)^3``, 1 in the middle."""
    return (4 * share * (1 - share)) ** 3


def swing(start: Array, end: Array, share: Array, swing_height: Array) -> Array:
    """Return where a swinging foot is, in the ground frame.

    Over the ground, the quintic ``10 s^3 - 15 s^4 + 6 s^5``: its velocity and acceleration are 0 at both ends, so that
    the foot leaves and meets the ground without scuffing. Upwards, ``64 s^3 (1 - s)^3``, with the same property.

    Parameters
    ----------
    start, end : array, shape (..., 3)
        Footholds in G [m].
    share : array, shape (...)
        Share of the swing, 0 to 1.
    swing_height : array, shape (...)
        Greatest height above the straight line [m].

    Returns
    -------
    array, shape (..., 3)
        Points in G [m].
    """
    xp = namespace(start, end, share, swing_height)
    start, end, share = as_array(xp, start), as_array(xp, end), as_array(xp, share)
    along, up = ground_share(share), as_array(xp, swing_height) * height_share(share)
    parts = [start[..., i] + (end[..., i] - start[..., i]) * along for i in range(3)]
    return stack_last(xp, (parts[0], parts[1], parts[2] + up))
