"""Check that a plant and its commands are of the same robot, up to errors in its dimensions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["require_same_robot"]

# Greatest difference of links and mounts, over the length of a leg: those of another robot differ by more, those of the
# same robot with errors in its dimensions by less.
_SAME_MEASURES = 0.1


def require_same_robot(plant: Robot, commanded: Robot, what: str) -> None:
    """Refuse a plant that is another robot than the one that is commanded.

    Parameters
    ----------
    plant, commanded : Robot
        Single robots: that of the plant, and the one that its commands are made for.
    what : str
        Where the commands come from, for the message, such as "controller".

    Raises
    ------
    InputError
        If the legs have other names, or links or mounts differ by more than 0.1 of the length of the leg.
    """
    both = f"the plant is {plant.name!r}, the {what} is for {commanded.name!r}; both must be the same robot"
    if plant.leg_names != commanded.leg_names:
        names = " and ".join(", ".join(robot.leg_names) for robot in (plant, commanded))
        raise InputError(f"{both}, but their legs are {names}")
    lengths = np.sum([commanded.coxa, commanded.femur, commanded.tibia], axis=0)
    # A difference in the direction of a leg counts as the distance by which it moves the foot.
    turn = np.abs(np.angle(np.exp(1j * (plant.mount_yaw - commanded.mount_yaw)))) * lengths
    off = np.max([*np.abs(_measures(plant) - _measures(commanded)), turn], axis=0)
    leg = int((off / lengths).argmax())
    most = _SAME_MEASURES * lengths[leg]
    if off[leg] > most:
        raise InputError(
            f"{both}, but links or mount of {commanded.leg_names[leg]} differ by {1e3 * off[leg]:.3g} mm; at most "
            f"{1e3 * most:.3g} mm are taken for errors of measures"
        )


def _measures(robot: Robot) -> Float[np.ndarray, "8 legs"]:
    """Return the positions of the mounts, the offsets of the femur axes and the lengths of the links [m]."""
    offsets = robot.femur_axis_offset.T
    return np.array([*robot.mount_position.T, *offsets, robot.coxa, robot.femur, robot.tibia])
