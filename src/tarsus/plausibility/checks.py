"""All plausibility checks of a robot."""

from __future__ import annotations

from tarsus.errors import InputError
from tarsus.plausibility.dimensions import Dimensions
from tarsus.plausibility.directions import direction_warnings
from tarsus.plausibility.lengths import LEG_CODES, length_warnings
from tarsus.plausibility.limits import limit_warnings
from tarsus.plausibility.masses import mass_warnings
from tarsus.plausibility.mirror import position_warnings
from tarsus.plausibility.names import name_warnings
from tarsus.plausibility.servos import servo_warnings
from tarsus.plausibility.warning import PlausibilityWarning
from tarsus.robot.robot import Robot, require_robot

__all__ = ["plausibility_warnings"]


def plausibility_warnings(robot: Robot) -> tuple[PlausibilityWarning, ...]:
    """Return warnings of values that no robot like this one has, such as lengths in cm or limits in radians.

    The bounds hold for robots with four to eight legs, each 60 mm to 1.5 m long. They come from the presets and other
    published robots, with a margin; a robot without warnings may still be wrong.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Returns
    -------
    tuple of PlausibilityWarning
        Each with the key, the number against its bound and the likely cause.

    Raises
    ------
    InputError
        If the robot is a batch of designs.
    """
    require_robot(robot)
    if robot.batch_shape:
        raise InputError(f"plausibility is checked for a single robot, not for a batch {robot.batch_shape} of designs")
    size = Dimensions.of(robot.item(()))
    lengths = tuple(length_warnings(robot, size))
    doubtful = any(warning.code in LEG_CODES for warning in lengths)
    return (
        *lengths,
        *position_warnings(robot, size),
        *direction_warnings(robot, size),
        *name_warnings(robot, size),
        *limit_warnings(robot, size),
        *(() if doubtful else mass_warnings(robot, size)),
        *servo_warnings(robot),
    )
