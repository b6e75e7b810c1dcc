"""Limitations of a stance: which of the commanded parameters it does not meet, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.limitation import Cause, Limitation, LimitationKind
from tarsus.control.transition.stance_transition import WalkParameters
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["UNREACHABLE", "rejection_limitations", "stance_limitations"]

UNREACHABLE = Cause("no leg reaches the ground at this height")

# Differences below this are rounding [m, rad].
_TOLERANCE = 1e-6


def stance_limitations(
    parameters: WalkParameters, posture: Float[np.ndarray, "7"], cause: Cause, *, stance_width: float
) -> tuple[Limitation, ...]:
    """Return a limitation for each commanded parameter that a posture does not meet.

    Parameters
    ----------
    parameters : WalkParameters
        What is commanded.
    posture : array, shape (7,)
        The posture, with the correction of `parameters`.
    cause : Cause
        Why it is not met.
    stance_width : float
        The stance width that is met; of interest only where everything else is met [m].
    """
    gap = np.array([*parameters.corrected_body, parameters.swing_height]) - posture
    gap[2] += parameters.body_height
    found = []
    # The height of the body's origin is commanded twice: a gap that the body pose alone can't make is the height's.
    if _TOLERANCE + abs(parameters.body[2]) < abs(gap[2]):
        asked = parameters.body_height
        found.append(cause.limitation(LimitationKind.BODY_HEIGHT, asked=asked, granted=asked - float(gap[2])))
        gap[2] = 0.0
    if abs(gap[SWING_HEIGHT]) > _TOLERANCE:
        asked = parameters.swing_height
        found.append(cause.limitation(LimitationKind.SWING_HEIGHT, asked=asked, granted=asked - float(gap[-1])))
    found += _body_limitations(parameters, gap[:SWING_HEIGHT], cause)
    width = parameters.stance_width
    if not found and abs(width - stance_width) > _TOLERANCE:
        found.append(cause.limitation(LimitationKind.STANCE_WIDTH, asked=width, granted=stance_width))
    return tuple(found)


def _body_limitations(parameters: WalkParameters, gap: Float[np.ndarray, "legs"], cause: Cause) -> list[Limitation]:
    """Return what of the body pose is missing; where only its correction is, that."""
    missing = [axis for axis in range(SWING_HEIGHT) if abs(gap[axis]) > _TOLERANCE]
    commanded = [axis for axis in missing if parameters.body[axis]]
    if commanded:
        fraction = min(1 - abs(float(gap[axis]) / parameters.body[axis]) for axis in commanded)
        return [cause.limitation(LimitationKind.BODY, asked=1.0, granted=max(fraction, 0.0))]
    if missing:
        reason = f"the shift over the feet that bear load is not met: {cause.reason}"
        return [cause._replace(reason=reason).limitation(LimitationKind.BODY)]
    return []


def rejection_limitations(
    asked: WalkParameters, current: WalkParameters, posture: Float[np.ndarray, "7"] | None, cause: Cause
) -> tuple[Limitation, ...]:
    """Return the limitations of parameters that are rejected as a whole.

    Parameters
    ----------
    asked, current : WalkParameters, WalkParameters
        What is rejected; what is in force.
    posture : array, shape (7,), or None
        The posture that is in force; None where it would have stayed.
    cause : Cause
        Why they are rejected.
    """
    found: list[Limitation] = []
    if asked.gait != current.gait:
        found.append(cause.limitation(LimitationKind.GAIT))
    if asked.excluded != current.excluded:
        found.append(cause.limitation(LimitationKind.FOOT_TARGET, asked=1.0, granted=0.0))
    if asked.cycle_time != current.cycle_time and asked.cycle_time is not None:
        found.append(cause.limitation(LimitationKind.CYCLE_TIME, asked=asked.cycle_time))
    if posture is None:
        return tuple(found)
    if asked.sway != current.sway:
        found.append(cause.limitation(LimitationKind.SWAY, asked=1.0, granted=0.0))
    corrected = posture.copy()
    corrected[:SWING_HEIGHT] += np.subtract(asked.correction, current.correction)
    found += stance_limitations(asked, corrected, cause, stance_width=current.stance_width)
    return tuple(found)
