"""The project's own controller as a policy, with which learned ones can be compared."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.robot_controller import RobotController
from tarsus.errors import InputError
from tarsus.representation import represented
from tarsus.simulation.environment.walk_env import DT, WalkEnv

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["ScriptedPolicy"]


@represented("env")
class ScriptedPolicy:
    """A `RobotController` that walks the robot of an environment, with the readings of its sensors.

    Parameters
    ----------
    env : gymnasium.Env
        ``tarsus/Walk-v0`` with joint actions.
    feedback : bool
        Whether the controller gets the readings.

    Raises
    ------
    InputError
        If the environment is another one, or has residual actions.
    """

    def __init__(self, env: Any, *, feedback: bool = True) -> None:
        inner = env.unwrapped
        if not isinstance(inner, WalkEnv) or inner.action_kind != "joint":
            raise InputError("the scripted policy needs the environment tarsus/Walk-v0 with actions='joint'")
        self.env: WalkEnv = inner
        self.feedback = feedback
        self.reset()

    def reset(self) -> None:
        """Begin an episode."""
        self.controller = RobotController(self.env.robot)

    def __call__(self, observation: Shaped[np.ndarray, "..."]) -> Float[np.ndarray, "joints"]:  # noqa: ARG002
        """Return the next action, ``(3 * legs,)``.

        Parameters
        ----------
        observation : array
            Not used: command and readings are the environment's.
        """
        readings = self.env.readings if self.feedback else None
        output = self.controller.step(self.env.command.tolist(), DT, readings)
        return self.env.action_of(output.angles)
