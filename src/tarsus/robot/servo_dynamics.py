"""Stiffness, play, inertia and timing of servos: known from sources, or assumed."""

from __future__ import annotations

import math

from tarsus.robot.known_servos import KNOWN_SERVOS, KnownServo
from tarsus.robot.servo import Servo

__all__ = ["NO_LOAD_SPEED", "ROTOR_INERTIA", "servo_dynamics"]

NO_LOAD_SPEED = 5.0
"""No-load speed that is assumed where the catalogue has none [rad/s]."""

ROTOR_INERTIA = 0.005
"""Inertia of rotor and gears, reflected to the output, assumed where it is unknown; less in small servos [kg m^2]."""

# Assumptions where no source gives a value. Position error at which a servo gives its stall torque [rad]: servos whose
# gain is known have 0.11 to 0.19, stiff digital ones less. With it, and the twist of the gears, the presets' joints
# have 9-24 N m/rad, in the lower part of what was measured on the loaded joints of a hexapod (10-79 N m/rad).
_FULL_TORQUE_ERROR = math.radians(5.0)
# Twist of the gears under stall torque [rad].
_GEAR_TWIST = math.radians(1.0)
# Greatest time constant of a servo without load, from standstill to 63 % of its no-load speed [s]; the presets' servos
# of unknown inertia have 0.016 to 0.035 s.
_TIME_CONSTANT = 0.035
_BACKLASH = math.radians(0.5)
_DEAD_BAND = math.radians(0.5)
_PWM_RATE, _BUS_RATE = 50.0, 100.0  # how often a servo takes over a new command [1/s]
_PWM_DELAY, _BUS_DELAY = 0.004, 0.006  # after a command is taken over [s]


def servo_dynamics(servo: Servo, stall: float, speed: float) -> tuple[dict[str, float], list[str]]:
    """Return the data of a servo that the catalogue lacks, known or assumed, and a line on the origin of each value.

    Parameters
    ----------
    servo : Servo
        The servo.
    stall : float
        Its stall torque at the supply voltage [N m].
    speed : float
        Its no-load speed at the supply voltage [rad/s].

    Returns
    -------
    values : dict
        ``control_stiffness`` and ``gear_stiffness`` [N m/rad], ``rotor_inertia`` [kg m^2], ``backlash`` and
        ``dead_band`` [rad], ``update_rate`` [1/s], ``delay`` [s].
    lines : list of str
        Each value and where it comes from.
    """
    known = KNOWN_SERVOS.get(servo.name, KnownServo(source=""))
    pulses = "pwm" in servo.control.lower()
    guesses = {
        "control_stiffness": (stall / _FULL_TORQUE_ERROR, "N m/rad", "stall torque at an error of 5 deg"),
        "rotor_inertia": (min(ROTOR_INERTIA, _TIME_CONSTANT * stall / speed), "kg m^2", "assumed"),
        "backlash": (_BACKLASH, "rad", "0.5 deg, assumed"),
        "dead_band": (_DEAD_BAND, "rad", "0.5 deg, assumed"),
        "update_rate": (_PWM_RATE if pulses else _BUS_RATE, "1/s", "pulses" if pulses else "a bus message a tick"),
    }
    values: dict[str, float] = {"gear_stiffness": stall / _GEAR_TWIST, "delay": _PWM_DELAY if pulses else _BUS_DELAY}
    lines = [
        f"gear stiffness {values['gear_stiffness']:.3g} N m/rad: 1 deg under stall torque",
        f"delay {1000 * values['delay']:g} ms after a command is taken over",
    ]
    for name, (guess, unit, why) in guesses.items():
        found = getattr(known, name)
        values[name] = guess if found is None else found
        origin = why if found is None else f"from {known.source}"
        lines.append(f"{name.replace('_', ' ')} {values[name]:.3g} {unit}: {origin}")
    return values, lines
