"""The reward: named terms, each without a dimension, and their weights."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tarsus.errors import InputError
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.representation import represented
from tarsus.robot.robot import Robot
from tarsus.simulation.environment.body_motion import BodyMotion
from tarsus.simulation.simulated_plant import SimulatedPlant

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Reward", "RewardWeights"]

# Velocity error, as a fraction of the top speed, at which 1/e of the reward for following the command is left.
_TOLERANCE = 0.25
# Tilt, rocking, and rate of the joint targets at which the terms of these are 1 [rad, rad/s, rad/s].
_TILT, _ROCKING, _JOINT_SPEED = math.radians(10), 1.0, 5.0


@represented()
@dataclass(frozen=True, kw_only=True)
class RewardWeights:
    """The weight of each term of the reward of a step; the reward is the sum of weights times terms.

    Attributes
    ----------
    velocity : float
        Weight of ``exp(-(e/0.25)^2)``; e is the norm of the velocity errors forward and left, each over its top speed.
    turning : float
        Weight of the same for the turning rate.
    tilt : float
        Weight of ``(tilt / 10 deg)^2``.
    rocking : float
        Weight of ``(angular speed about x and y / (1 rad/s))^2``.
    torque : float
        Weight of the mean of ``(torque / stall torque)^2`` over the joints.
    power : float
        Weight of the sum of ``|torque * speed|`` over the joints, divided by the robot's weight and top speed forward.
    target_rate : float
        Weight of the mean of ``(change of the joint targets per second / (5 rad/s))^2`` over the joints.
    fall : float
        Weight of a term that is 1 in the step in which the robot falls, else 0.
    """

    velocity: float = 1.0
    turning: float = 0.5
    tilt: float = -0.1
    rocking: float = -0.1
    torque: float = -0.2
    power: float = -0.02
    target_rate: float = -0.1
    fall: float = -10.0

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):
            if not math.isfinite(getattr(self, field.name)):
                raise InputError(f"the weight of {field.name} is {getattr(self, field.name)}; it must be finite")


class Reward:
    """Computes the weighted terms.

    Parameters
    ----------
    robot : Robot
        The robot.
    weights : RewardWeights
        The weights.
    top : array, shape (3,)
        Top speed along each axis [m/s, m/s, rad/s].

    Attributes
    ----------
    names : tuple of str
        The terms.
    fall : float
        The weighted term of a fall.
    """

    def __init__(self, robot: Robot, weights: RewardWeights, top: Float[np.ndarray, "3"]) -> None:
        self._weights = tuple(dataclasses.asdict(weights).items())
        self.names, self.fall = tuple(name for name, _ in self._weights), weights.fall
        self._top = top
        self._weight_speed = float(total_mass(robot)) * STANDARD_GRAVITY * float(top[0])

    def terms(
        self,
        plant: SimulatedPlant,
        motion: BodyMotion,
        command: Float[np.ndarray, "3"],
        target_rates: Float[np.ndarray, "legs 3"],
    ) -> dict[str, float]:
        """Return the weighted terms of a step, by name.

        Parameters
        ----------
        plant : SimulatedPlant
            The robot after the step.
        motion : BodyMotion
            How its body moved.
        command : array, shape (3,)
            What was commanded [m/s, m/s, rad/s].
        target_rates : array, shape (legs, 3)
            Change of the joint targets per second [rad/s].
        """
        forward, left, turning = motion.command_error(command, self._top).tolist()
        torques, speeds = plant.torques.ravel(), plant.mj_data.qvel[6:]
        used, rates = torques / plant.stall_torques, target_rates.ravel() / _JOINT_SPEED
        joints = len(torques)
        values = (
            math.exp(-(forward * forward + left * left) / _TOLERANCE**2),
            math.exp(-turning * turning / _TOLERANCE**2),
            (motion.tilt / _TILT) ** 2,
            (motion.rocking / _ROCKING) ** 2,
            float(used @ used) / joints,
            float(np.abs(torques) @ np.abs(speeds)) / self._weight_speed,
            float(rates @ rates) / joints,
            float(motion.fallen),
        )
        return {name: weight * value for (name, weight), value in zip(self._weights, values, strict=True)}
