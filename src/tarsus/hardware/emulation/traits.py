"""What emulated servos of each bus are like, and what their registers hold as they are delivered."""

from __future__ import annotations

from tarsus.hardware.emulation.servo import ServoTraits

__all__ = ["INITIAL", "TRAITS"]

TRAITS = {
    # STS3215 at 7.4 V: 0.222 s for 60 degrees without load; LeRobot's users measure about 0.5 degrees of play.
    "feetech-sts": ServoTraits(per_turn=4096, lowest=0, highest=4095, speed=3070, play=6),
    # SCS0009 at 6 V: 0.1 s for 60 degrees.
    "feetech-scs": ServoTraits(per_turn=1228.8, lowest=0, highest=1023, speed=2048, play=2, stall_current=1.0),
    # XL430-W250 at 11.1 V: 57 rpm.
    "dynamixel-x": ServoTraits(per_turn=4096, lowest=0, highest=4095, speed=3890, play=4, stall_current=1.3),
    # MX-28 at 12 V: 55 rpm.
    "dynamixel-mx": ServoTraits(per_turn=4096, lowest=0, highest=4095, speed=3750, play=4, stall_current=1.4),
    # AX-12A at 12 V: 59 rpm.
    "dynamixel-ax": ServoTraits(per_turn=1228.8, lowest=0, highest=1023, speed=1208, play=2, stall_current=1.5),
}
"""Traits by the name of the bus, after the makers' data sheets."""

_FEETECH = {"status_level": 1, "most_torque": 1000, "lock": 1}
_DYNAMIXEL = {"status_level": 2, "return_delay": 250}

INITIAL = {
    "feetech-sts": {**_FEETECH, "model": 777, "firmware": 0x0A03, "torque_limit": 1000},
    "feetech-scs": {**_FEETECH, "model": 1284, "firmware": 0x0305},
    "dynamixel-x": {**_DYNAMIXEL, "model": 1060, "firmware": 46, "mode": 3, "torque_limit": 885},
    "dynamixel-mx": {**_DYNAMIXEL, "model": 29, "firmware": 36, "torque_limit": 1023},
    "dynamixel-ax": {**_DYNAMIXEL, "model": 12, "firmware": 24, "torque_limit": 1023},
}
"""Initial values of registers that are not 0, by the name of the bus."""
