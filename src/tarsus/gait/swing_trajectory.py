"""Swing trajectories: the position over the ground, and the height.

The swing phase goes from 0 at lift-off to 1 at touchdown. Derivatives are with respect to it, and so
independent of the duration of the swing. Positions are complex numbers, x + iy in G.
"""

from __future__ import annotations

from typing import Any

from tarsus.gait.swing import horizontal_profile, vertical_profile

__all__ = ["quintic", "swinging_height"]


def quintic(state: tuple[Any, Any, Any], target: Any, remaining: Any, fraction: Any) -> tuple[Any, Any, Any]:
    """Advance along the quintic that ends at the target, at rest there.

    The target may move during a swing: each step starts a new quintic from the state reached, so that position,
    velocity and acceleration stay continuous.

    Parameters
    ----------
    state : tuple of (complex or array)
        Position of the foot and its first and second derivative with respect to the swing phase [m].
    target : complex or array
        Where the swing ends [m].
    remaining : float or array
        Swing phase that remains, above 0.
    fraction : float or array
        How far to advance, as a fraction of what remains.

    Returns
    -------
    tuple of (complex or array)
        Position and derivatives after that [m].
    """
    position, speed, half = state[0], state[1] * remaining, state[2] * (remaining * remaining / 2)
    # The terms of third to fifth order end at the target without velocity and acceleration.
    way = target - position
    a3 = 10 * way - 6 * speed - 3 * half
    a4 = 8 * speed + 3 * half - 15 * way
    a5 = 6 * way - 3 * speed - half
    x = fraction
    return (
        position + x * (speed + x * (half + x * (a3 + x * (a4 + x * a5)))),
        (speed + x * (2 * half + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))) / remaining,
        (2 * half + x * (6 * a3 + x * (12 * a4 + x * 20 * a5))) / (remaining * remaining),
    )


def swinging_height(phase: float, *, start: float, ground: float, swing_height: float) -> float:
    """Return the height of a foot in an undisturbed swing [m].

    Parameters
    ----------
    phase : float
        Swing phase.
    start, ground : float
        Heights at lift-off and of the ground at the target [m].
    swing_height : float
        Greatest height above the line from the one to the other [m].
    """
    return float(start + (ground - start) * horizontal_profile(phase) + swing_height * vertical_profile(phase))
