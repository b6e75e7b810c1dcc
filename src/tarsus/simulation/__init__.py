"""Physics: a robot in MuJoCo, with actuators modelled on real servos, terrain and sensors.

::

    from tarsus import Command, RobotController, load_robot, run
    from tarsus.simulation import SimulatedPlant, terrain

    robot = load_robot("strider")
    plant = SimulatedPlant(robot, terrain=terrain.Ramp(slope=0.1), sensors="hobby")
    run(RobotController(robot), plant, [(0.0, Command(twist=(0.05, 0.0, 0.0)))])

MuJoCo is imported when a model is built; the extra ``sim`` installs it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tarsus.simulation import environment, terrain
    from tarsus.simulation.plant_state import PlantState
    from tarsus.simulation.robot_model import model, model_assumptions
    from tarsus.simulation.sensors.suite import FootSwitch, Sensor, SensorSuite
    from tarsus.simulation.servos.servo_model import ServoModel
    from tarsus.simulation.simulated_plant import SimulatedPlant
    from tarsus.simulation.terrain.from_text import terrain_from_text
    from tarsus.simulation.truth.comparison import Truth, compare
    from tarsus.simulation.truth.outcome import Outcome
    from tarsus.simulation.truth.trace import Trace, trace_to_csv, trace_to_dataset
    from tarsus.simulation.truth.traced_plant import TracedPlant, play

_HOMES = {
    "FootSwitch": "tarsus.simulation.sensors.suite",
    "Outcome": "tarsus.simulation.truth.outcome",
    "PlantState": "tarsus.simulation.plant_state",
    "Sensor": "tarsus.simulation.sensors.suite",
    "SensorSuite": "tarsus.simulation.sensors.suite",
    "ServoModel": "tarsus.simulation.servos.servo_model",
    "SimulatedPlant": "tarsus.simulation.simulated_plant",
    "Trace": "tarsus.simulation.truth.trace",
    "TracedPlant": "tarsus.simulation.truth.traced_plant",
    "Truth": "tarsus.simulation.truth.comparison",
    "compare": "tarsus.simulation.truth.comparison",
    "model": "tarsus.simulation.robot_model",
    "model_assumptions": "tarsus.simulation.robot_model",
    "play": "tarsus.simulation.truth.traced_plant",
    "terrain_from_text": "tarsus.simulation.terrain.from_text",
    "trace_to_csv": "tarsus.simulation.truth.trace",
    "trace_to_dataset": "tarsus.simulation.truth.trace",
}

__all__ = [
    "FootSwitch",
    "Outcome",
    "PlantState",
    "Sensor",
    "SensorSuite",
    "ServoModel",
    "SimulatedPlant",
    "Trace",
    "TracedPlant",
    "Truth",
    "compare",
    "environment",
    "model",
    "model_assumptions",
    "play",
    "terrain",
    "terrain_from_text",
    "trace_to_csv",
    "trace_to_dataset",
]


def __getattr__(name: str) -> Any:
    """Import a public name from its module."""
    if name in ("environment", "terrain"):
        return import_module(f"tarsus.simulation.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module 'tarsus.simulation' has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
