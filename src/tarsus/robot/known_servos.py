"""Data of individual servos for which the catalogue has no columns, each with its source."""

from __future__ import annotations

import math
from typing import NamedTuple

__all__ = ["KNOWN_SERVOS", "KnownServo"]


class KnownServo(NamedTuple):
    """Figures of a servo; None where unknown.

    Attributes
    ----------
    source : str
        Where they come from.
    control_stiffness : float or None
        Torque per angle of the position loop [N m/rad].
    rotor_inertia : float or None
        Inertia of the rotor and gears, reflected to the output [kg m^2].
    backlash : float or None
        Free play at the output [rad].
    dead_band : float or None
        Width of the dead band [rad].
    update_rate : float or None
        How often it takes over a new command [1/s].
    """

    source: str
    control_stiffness: float | None = None
    rotor_inertia: float | None = None
    backlash: float | None = None
    dead_band: float | None = None
    update_rate: float | None = None


_STS3215 = KnownServo(
    source="identified model in github.com/TheRobotStudio/SO-ARM100 (kp 17.8, armature 0.028); "
    "free play measured by robonine.com; dead zones of 1 step on either side",
    control_stiffness=17.8,
    rotor_inertia=0.028,
    backlash=math.radians(1.0),
    dead_band=math.radians(2 * 360 / 4096),
)
_AX = KnownServo(
    source="ROBOTIS e-manual: compliance slope 32 steps of 0.29 deg, margin 1 step on either side",
    control_stiffness=1.5 / math.radians(32 * 300 / 1024),
    dead_band=math.radians(2 * 300 / 1024),
)

KNOWN_SERVOS = {
    "STS3215 7.4V (C001)": _STS3215,
    "STS3215 12V (C018)": _STS3215,
    "AX-12A": _AX,
    "XM430-W350-T": KnownServo(
        source="robotis_op3 in github.com/google-deepmind/mujoco_menagerie (kp 21.1, armature 0.045)",
        control_stiffness=21.1,
        rotor_inertia=0.045,
    ),
    "DS3225": KnownServo(
        source="catalogue note: dead band 3 us, of 2000 us for 270 deg",
        dead_band=math.radians(3 / 2000 * 270),
    ),
}
"""Figures of servos, by their names in the catalogue."""
