"""Joints as springs and dampers: position-controlled servos, as in `tarsus.simulation` but without their inertia."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.errors import InputError, MissingDataError
from tarsus.load.servo_limits import at_supply, why_not_rated
from tarsus.representation import represented
from tarsus.robot.robot import JOINTS, Robot
from tarsus.robot.servo_dynamics import NO_LOAD_SPEED, ROTOR_INERTIA, servo_dynamics

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["JointSprings"]

# Fraction of the stiffness that is left within the play and in a saturated servo, to keep the equations regular.
_SOFT = 1e-3


@represented()
@dataclass(frozen=True, eq=False, kw_only=True)
class JointSprings:
    """Springs between commanded and achieved joint angles.

    Attributes
    ----------
    stiffness : array, shape (legs, 3)
        Torque per position error, of control loop and gears in series [N m/rad].
    damping : array, shape (legs, 3)
        Torque per speed: stall torque over no-load speed, the slope of the torque-speed line [N m s/rad].
    play : array, shape (legs, 3)
        Half the backlash [rad].
    dead_band : array, shape (legs, 3)
        Half the range of commands around its target in which a servo does not react [rad].
    stall_torque : array, shape (legs, 3)
        Greatest torque [N m]; may be infinite.
    rotor_inertia : array, shape (legs, 3)
        Inertia of rotors and gears, reflected to the joints [kg m^2].
    assumed : tuple of str
        What is assumed beyond the catalogue.
    """

    stiffness: Float[np.ndarray, "legs 3"]
    damping: Float[np.ndarray, "legs 3"]
    play: Float[np.ndarray, "legs 3"]
    dead_band: Float[np.ndarray, "legs 3"]
    stall_torque: Float[np.ndarray, "legs 3"]
    rotor_inertia: Float[np.ndarray, "legs 3"]
    assumed: tuple[str, ...] = ()

    @classmethod
    def of(cls, robot: Robot, *, supply: float | None = None) -> Self:
        """Return the springs of a robot's servos.

        Parameters
        ----------
        robot : Robot
            A single robot.
        supply : float, optional
            Supply voltage [V]; left out, that of the catalogue's ratings.

        Raises
        ------
        MissingDataError
            If a servo is unknown, or the supply is too high for it.
        """
        values = np.empty((robot.legs, 3, 6))
        lines: list[str] = []
        for leg, row in enumerate(robot.servos):
            for joint, servo in enumerate(row):
                if servo is None:
                    raise MissingDataError(
                        f"robot {robot.name!r}, leg {robot.leg_names[leg]}: the servo of the {JOINTS[joint]} is "
                        "unknown, so its stiffness is, too; add it to its file ([leg] servo), or give the stiffness"
                    )
                if why := why_not_rated(servo, supply):
                    raise MissingDataError(f"{why}, and so is its stiffness")
                stall, speed = at_supply(servo, supply)
                speed = NO_LOAD_SPEED if np.isnan(speed) else speed
                found, _ = servo_dynamics(servo, stall, speed)
                stiffness = 1.0 / (1.0 / found["control_stiffness"] + 1.0 / found["gear_stiffness"])
                play, band, inertia = (found[name] for name in ("backlash", "dead_band", "rotor_inertia"))
                values[leg, joint] = stiffness, stall / speed, play / 2, band / 2, stall, inertia
                degrees = [f"{np.degrees(found[name]):.3g} deg" for name in ("backlash", "dead_band")]
                lines.append(
                    f"{servo.name}: {stiffness:.3g} N m/rad of control loop and gears, backlash {degrees[0]}, "
                    f"dead band {degrees[1]}, rotor inertia {inertia:.3g} kg m^2"
                )
        columns = ("stiffness", "damping", "play", "dead_band", "stall_torque", "rotor_inertia")
        return cls(
            **dict(zip(columns, np.moveaxis(values, -1, 0), strict=True)),
            assumed=tuple(dict.fromkeys(lines)),
        )

    @classmethod
    def uniform(
        cls, robot: Robot, stiffness: float, *, damping: float = 0.0, rotor_inertia: float = ROTOR_INERTIA
    ) -> Self:
        """Return equal springs in all joints, without play and with any torque: ideal servos.

        Parameters
        ----------
        robot : Robot
            A single robot.
        stiffness : float
            Torque per position error [N m/rad].
        damping : float
            Torque per speed [N m s/rad].
        rotor_inertia : float
            Inertia of rotor and gears, reflected to the joint [kg m^2].

        Raises
        ------
        InputError
            If the stiffness is not positive and finite, or damping or inertia are negative or not finite.
        """
        if not 0 < stiffness < np.inf:
            raise InputError(f"stiffness is {stiffness:g} N m/rad; it must be greater than 0 and finite")
        for name, value, unit in (("damping", damping, "N m s/rad"), ("rotor_inertia", rotor_inertia, "kg m^2")):
            if not 0 <= value < np.inf:
                raise InputError(f"{name} is {value:g} {unit}; it must be a finite number, not negative")
        shape = (robot.legs, 3)
        return cls(
            stiffness=np.full(shape, stiffness),
            damping=np.full(shape, damping),
            play=np.zeros(shape),
            dead_band=np.zeros(shape),
            stall_torque=np.full(shape, np.inf),
            rotor_inertia=np.full(shape, rotor_inertia),
            assumed=(
                f"every joint: {stiffness:g} N m/rad, {damping:g} N m s/rad, rotor inertia {rotor_inertia:g} kg m^2",
            ),
        )

    def targets(self, angles: Float[np.ndarray, "n legs 3"]) -> Float[np.ndarray, "n legs 3"]:
        """Return the angles that servos aim at, which follow the commands only as far as these leave the dead band.

        Parameters
        ----------
        angles : array, shape (n, legs, 3)
            Commanded angles, one after the other [rad].
        """
        lowest, targets = angles - self.dead_band, angles + self.dead_band
        target = angles[0]
        for low, high in zip(lowest, targets, strict=True):
            # The row of upper bounds is overwritten with the targets.
            target = np.minimum(np.maximum(target, low), high, out=high)
        return np.asarray(targets)

    @cached_property
    def _unlimited(self) -> bool:
        """Whether all springs are without play and give any torque."""
        return bool(np.isinf(self.stall_torque).all() and not self.play.any())

    @cached_property
    def _parts(self) -> tuple[Float[np.ndarray, "legs 3"], ...]:
        """Stiffness lost in play or saturation, stall torques, lower ends of the play, zeros."""
        return (1.0 - _SOFT) * self.stiffness, self.stall_torque, -self.play, np.zeros_like(self.play)

    def torque(
        self, error: Float[np.ndarray, "legs 3"], turned: Float[np.ndarray, "legs 3"], step: float
    ) -> tuple[Float[np.ndarray, "legs 3"], Float[np.ndarray, "legs 3"]]:
        """Return the torques at position errors, and the slopes by which they fall as the angles grow.

        Parameters
        ----------
        error : array, shape (legs, 3)
            Commanded less achieved angles [rad].
        turned : array, shape (legs, 3)
            Change of the achieved angles in the last step of time [rad].
        step : float
            The step [s]; infinite for a robot at rest.

        Returns
        -------
        torque : array, shape (legs, 3)
            Torques [N m]; beyond the torque-speed line, they grow with a thousandth of the spring's stiffness.
        slope : array, shape (legs, 3)
            Their derivatives by the angles, with the opposite sign [N m/rad].
        """
        damping = self.damping / step
        loss = damping * turned
        if self._unlimited:
            return self.stiffness * error - loss, self.stiffness + damping
        hard, stall, loose, none = self._parts
        inside = np.minimum(np.maximum(error, loose), self.play)
        drive = self.stiffness * error - hard * inside
        bounded = np.minimum(np.maximum(drive, np.maximum(loss, none) - stall), np.minimum(loss, none) + stall)
        softer = ((inside == error) | (bounded != drive)) * hard
        return bounded + _SOFT * (drive - bounded) - loss, self.stiffness - softer + damping
