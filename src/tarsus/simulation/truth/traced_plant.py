"""A simulated plant that records what it does, and the playback of planned motions on it."""

from __future__ import annotations

from tarsus.control.control_output import ControlOutput
from tarsus.control.readings import SensorReadings
from tarsus.control.robot_state import RobotState
from tarsus.errors import InputError
from tarsus.gait.motion import Motion
from tarsus.representation import represented
from tarsus.robot.same_robot import require_same_robot
from tarsus.simulation.plant_state import PlantState
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.truth.trace import Trace

__all__ = ["TracedPlant", "play"]

# How long the last angles of a motion are held, until the servos have reached them [s].
_HOLD = 0.5


@represented("robot", "plant")
class TracedPlant:
    """A `Plant` that records the exact state of a simulated plant after every tick.

    Parameters
    ----------
    plant : SimulatedPlant
        The plant.

    Attributes
    ----------
    robot : Robot
        Its robot.
    plant : SimulatedPlant
        The plant.
    """

    def __init__(self, plant: SimulatedPlant) -> None:
        self.robot, self.plant = plant.robot, plant
        plant.average_torques()
        self._commanded: list[ControlOutput] = []
        self._states: list[PlantState] = []

    def start(self, output: ControlOutput) -> None:
        """Place the robot and let it settle, as `SimulatedPlant.start` does."""
        self.plant.start(output)
        self._commanded, self._states = [output], [self.plant.state]

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute joint angles for one tick, and measure, as `SimulatedPlant.step` does."""
        readings = self.plant.step(output, dt)
        self._commanded.append(output)
        self._states.append(self.plant.state)
        return readings

    def stop(self) -> None:
        """Do nothing: the robot stays as it is."""

    @property
    def trace(self) -> Trace:
        """What the robot has done since its start.

        Raises
        ------
        InputError
            If it has not been started.
        """
        if not self._states:
            raise InputError("the plant has not been started; there is no trace of it")
        return Trace.of(self.robot, self._commanded, self._states)


def play(motion: Motion, plant: SimulatedPlant) -> Trace:
    """Execute a planned motion on a simulated plant, without any feedback, and hold its end for 0.5 s.

    Parameters
    ----------
    motion : Motion
        The motion; its samples are the commands.
    plant : SimulatedPlant
        The plant, of the same robot.

    Raises
    ------
    InputError
        If the plant is of another robot, or the robot starts inside the terrain.
    SimulationError
        If the simulation becomes unstable.
    """
    require_same_robot(plant.robot, motion.robot, "motion")
    traced, times = TracedPlant(plant), motion.time.tolist()
    traced.start(_output(motion, 0))
    before = times[0]
    for number, time in enumerate(times[1:], start=1):
        traced.step(_output(motion, number), time - before)
        before = time
    tick = times[-1] - times[-2]
    last = _output(motion, len(times) - 1)
    for _ in range(round(_HOLD / tick)):
        traced.step(last, tick)
    return traced.trace


def _output(motion: Motion, number: int) -> ControlOutput:
    """Return a sample of a motion as a controller would give it out."""
    return ControlOutput(
        time=float(motion.time[number]),
        angles=motion.angles[number],
        state=RobotState.WALKING,
        activity="planned",
        limitations=(),
        interventions=(),
        guard="",
        body=motion.body[number],
        feet=motion.feet[number],
        contacts=motion.contacts[number],
        belly=False,
        twist=(0.0, 0.0, 0.0),
        gait=motion.gait,
        cycle_time=motion.cycle_time,
        at_rest=False,
    )
