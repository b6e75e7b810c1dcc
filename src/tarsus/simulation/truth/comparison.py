"""A planned motion, compared with its execution in physics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.load.loads import joint_loads
from tarsus.simulation.sensors.suite import SensorSuite
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.truth.outcome import Outcome
from tarsus.simulation.truth.trace import Trace
from tarsus.simulation.truth.traced_plant import play

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Truth", "compare", "planned_torques"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Truth:
    """A plan and what it became in physics.

    Attributes
    ----------
    motion : Motion
        The plan.
    plant : SimulatedPlant
        The plant, at the end.
    trace : Trace
        What the robot did.
    outcome : Outcome
        The trace in numbers.
    planned_peak, planned_rms : array, shape (3,)
        Peak and root mean square torque of coxa, femur and tibia as `joint_loads` predicts them from vertical forces,
        of the leg where they are greatest [N m].
    assumed : tuple of str
        What the model and the servos assume.
    """

    motion: Motion
    plant: SimulatedPlant
    trace: Trace
    outcome: Outcome
    planned_peak: Float[np.ndarray, "3"]
    planned_rms: Float[np.ndarray, "3"]
    assumed: tuple[str, ...]

    def __repr__(self) -> str:
        found = self.outcome
        verdict = "; ".join(found.problems) or "no fall, no stall"
        return f"Truth({self.motion.robot.name!r}, {self.motion.gait.name}, way {found.way_ratio:.3f}, {verdict})"


def compare(
    motion: Motion,
    *,
    terrain: Terrain | None = None,
    servos: Any = "catalogue",
    sensors: SensorSuite | str = "blind",
    seed: int = 0,
) -> Truth:
    """Execute a planned motion in physics, without feedback, and compare.

    Parameters
    ----------
    motion : Motion
        The plan, with commands at its samples; 100 a second or more.
    terrain, servos, sensors, seed
        As for `SimulatedPlant`.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown; with ``"catalogue"``, also if a servo is.
    SimulationError
        If the simulation becomes unstable.
    """
    plant = SimulatedPlant(motion.robot, terrain=terrain, servos=servos, sensors=sensors, seed=seed)
    trace = play(motion, plant)
    peak, rms = planned_torques(motion)
    return Truth(
        motion=motion,
        plant=plant,
        trace=trace,
        outcome=Outcome.of(trace),
        planned_peak=peak,
        planned_rms=rms,
        assumed=plant.assumed,
    )


def planned_torques(motion: Motion) -> tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]]:
    """Return peak and root mean square torque of coxa, femur and tibia in a plan, shape (3,) each [N m].

    Parameters
    ----------
    motion : Motion
        The plan.
    """
    loads = joint_loads(motion.robot, motion)
    return loads.peak.max(0), loads.rms.max(0)
