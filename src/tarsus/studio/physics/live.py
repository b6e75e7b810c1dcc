"""A driven robot in physics: the simulated plant, and what its frames show."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.control_output import ControlOutput
from tarsus.control.robot_state import RobotState
from tarsus.robot.robot import JOINTS, Robot
from tarsus.simulation.plant_state import PlantState
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.truth.as_motion import CONTACT_FORCE
from tarsus.simulation.truth.outcome import FALLEN
from tarsus.studio.encoding import degrees, flags, millimetres, plain
from tarsus.studio.messages.physics import FramePhysics, PhysicsOptions

if TYPE_CHECKING:
    from jaxtyping import Bool

__all__ = ["LivePhysics", "contacts_of"]

# A servo is named this long after it was at its maximum torque [s].
_NAMED = 0.5
# States in which the body must not touch the ground; in the others it lies there, or moves to or from there.
_UPRIGHT = (RobotState.STANDING, RobotState.WALKING)


class LivePhysics:
    """The simulated plant of a driven robot, with a watch for falls and for servos at their maximum torque.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    options : PhysicsOptions
        Servos and sensors.
    terrain : Terrain
        Ground to walk on.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown; with the servos of the catalogue, also if a servo is.
    TarsusError
        If MuJoCo is not installed.
    """

    def __init__(self, robot: Robot, options: PhysicsOptions, terrain: Terrain) -> None:
        self.plant = SimulatedPlant(robot, terrain=terrain, servos=options.servos, sensors=options.sensors)
        self._robot = robot
        self._saturated_at = np.full((robot.legs, 3), -math.inf)
        self._fell: str | None = None

    def frame(self, output: ControlOutput) -> tuple[PlantState, FramePhysics]:
        """Return the state of the robot, as it is and as part of a frame.

        Parameters
        ----------
        output : ControlOutput
            The output that the plant executed last.
        """
        state = self.plant.state
        self._saturated_at[state.saturated] = state.time
        tilt = math.acos(float(np.clip(state.body.rotation[:, 2] @ output.body.rotation[:, 2], -1.0, 1.0)))
        self._watch(output, state, tilt)
        away = state.body.position[:2] - output.body.position[:2]
        return state, FramePhysics(
            position_mm=millimetres(state.body.position),
            rpy_deg=degrees(state.body.rpy),
            angles_deg=degrees(state.joint_angles),
            contacts=flags(contacts_of(state)),
            forces_n=plain(state.foot_forces),
            slip_mm_s=millimetres(state.slip_speeds),
            saturated=flags(state.saturated),
            tilt_deg=round(math.degrees(tilt), 2),
            deviation_mm=round(1000 * float(np.hypot(*away)), 1),
            fallen=self._fell is not None,
            problems=self._problems(state.time),
        )

    def _watch(self, output: ControlOutput, state: PlantState, tilt: float) -> None:
        """Keep when and how the robot first falls."""
        if self._fell is not None:
            return
        if tilt > FALLEN:
            self._fell = f"fell at {state.time:.1f} s: inclined by {math.degrees(tilt):.0f} deg"
        elif state.body_touches and output.state in _UPRIGHT:
            self._fell = f"fell at {state.time:.1f} s: its body touched the ground"

    def _problems(self, time: float) -> list[str]:
        recent = np.argwhere(self._saturated_at > time - _NAMED).tolist()
        names = ", ".join(f"{self._robot.leg_names[leg]} {JOINTS[joint]}" for leg, joint in recent)
        return [
            *([] if self._fell is None else [self._fell]),
            *([f"servos at their maximum torque: {names}"] if names else []),
        ]


def contacts_of(state: PlantState) -> Bool[np.ndarray, "legs"]:
    """Return which feet are on the ground ``(legs,)``.

    Parameters
    ----------
    state : PlantState
        State of the simulated robot.
    """
    return np.asarray(state.foot_forces[:, 2] > CONTACT_FORCE)
