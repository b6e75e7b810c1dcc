"""Which values of a robot are estimates: those whose source in the robot file has the confidence ``guess``."""

from __future__ import annotations

from collections.abc import Iterable

from tarsus.robot.about import Source
from tarsus.robot.robot import Robot

__all__ = ["MASS_KEYS", "SERVO_KEY", "estimate_text", "estimated_keys", "source_of"]

MASS_KEYS = ("body.mass_kg", "leg.mass_kg")
"""Keys of the masses."""

SERVO_KEY = "leg.servo"
"""Key of the servos."""

_GUESS = "guess"


def source_of(names: Iterable[str], sources: tuple[Source, ...]) -> Source | None:
    """Return the source of a value, by the first of its names that a source lists.

    Parameters
    ----------
    names : iterable of str
        Keys of the value, such as ``"leg.mass_kg"`` and ``"leg"``, the most specific first.
    sources : tuple of Source
        Sources of the robot.
    """
    for name in names:
        for source in sources:
            if any(of == name or ("." in name and of.startswith(f"{name}.")) for of in source.of):
                return source
    return None


def estimated_keys(robot: Robot, keys: Iterable[str] = (*MASS_KEYS, SERVO_KEY)) -> tuple[str, ...]:
    """Return the keys whose values are estimates.

    Parameters
    ----------
    robot : Robot
        The robot.
    keys : iterable of str
        Keys in question, such as ``"body.mass_kg"``. Default: masses and servos, on which loads depend.
    """
    known = {
        "body.mass_kg": robot.body_mass is not None,
        "leg.mass_kg": robot.link_mass is not None,
        SERVO_KEY: any(servo is not None for row in robot.servos for servo in row),
    }
    estimated = []
    for key in keys:
        source = source_of((key, key.partition(".")[0]), robot.sources)
        if known.get(key, True) and source is not None and source.confidence == _GUESS:
            estimated.append(key)
    return tuple(estimated)


def estimate_text(robot: Robot, keys: Iterable[str] = (*MASS_KEYS, SERVO_KEY)) -> str:
    """Return which values are estimates as a sentence, or an empty string.

    Parameters
    ----------
    robot : Robot
        The robot.
    keys : iterable of str
        Keys in question. Default: masses and servos.
    """
    estimated = estimated_keys(robot, keys)
    return f"estimated in the robot file, not measured: {', '.join(estimated)}" if estimated else ""
