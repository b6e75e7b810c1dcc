"""A plant in MuJoCo: servos, terrain and sensors of a simulated robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.control.control_output import ControlOutput
from tarsus.control.readings import SensorReadings
from tarsus.errors import InputError, SimulationError
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.kinematics.pose import Pose
from tarsus.representation import represented
from tarsus.robot.robot import Robot, require_robot
from tarsus.simulation.engine import mujoco_module
from tarsus.simulation.initial_state import check_stability, place
from tarsus.simulation.measurement import Measurement
from tarsus.simulation.plant_state import PlantState
from tarsus.simulation.robot_model import model, model_assumptions
from tarsus.simulation.seed import require_seed
from tarsus.simulation.sensors.sampler import Sampler
from tarsus.simulation.sensors.suite import SensorSuite
from tarsus.simulation.servos.actuators import ACTUATORS
from tarsus.simulation.servos.command_timing import CommandTiming
from tarsus.simulation.servos.servo_table import ServoTable
from tarsus.simulation.settings import TIMESTEP
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["SimulatedPlant"]


# Settling ends when nothing moves faster than this [m/s, rad/s], at the latest after this time [s].
_AT_REST, _LONGEST_SETTLING = 2e-3, 3.0
_SETTLING_CHECK = 25  # physics steps from one check to the next
# Longest tick [s]: those of controllers last milliseconds; far longer ones would overflow the number of steps.
_LONGEST_TICK = 60.0
# Norm of all speeds together from which on the simulation counts as unstable [m/s, rad/s].
_UNSTABLE = 1e3


@represented("robot", "terrain", "sensors", "assumed")
class SimulatedPlant:
    """Executes joint angles in physics: a `Plant`.

    The engine computes the servos' torques in every physics step of 2 ms, from the targets that they have taken over by
    then.

    Parameters
    ----------
    robot : Robot
        A single robot with masses.
    terrain : Terrain, optional
        What it walks on; flat ground where left out.
    sensors : SensorSuite or str
        What it measures: a suite or the name of one (`SensorSuite.named`).
    servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
        Models of the servos in the robot's file (`ServoModel.of`), ideal ones, one for all joints, or ``[leg][joint]``.
    seed : int
        Seed of what is random in the sensors. The same seed gives the same run to the bit.

    Attributes
    ----------
    terrain : Terrain
        The ground.
    sensors : SensorSuite
        The sensors.
    servos : tuple of tuple of ServoModel
        The servos, ``servos[leg][joint]``.
    assumed : tuple of str
        What the model and the servos assume, a line each.
    mj_model, mj_data : mujoco.MjModel, mujoco.MjData
        Model and state in the engine, for viewers, and for values that have no method here.

    Raises
    ------
    MissingDataError
        If the mass of the body or of a link is unknown; with ``"catalogue"``, also if a servo is.
    InputError
        If the robot is a batch, a mass is too small to be simulated, no foot switch would close under the robot's
        weight, or the seed is not a whole number from 0 on.
    TarsusError
        If MuJoCo is not installed.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        terrain: Terrain | None = None,
        sensors: SensorSuite | str = "ideal",
        servos: Any = "catalogue",
        seed: int = 0,
    ) -> None:
        require_robot(robot)
        self.robot = robot
        self.terrain: Terrain = Flat() if terrain is None else terrain
        self.sensors = SensorSuite.named(sensors) if isinstance(sensors, str) else sensors
        if not isinstance(self.sensors, SensorSuite):
            raise InputError(f"sensors must be a SensorSuite or the name of one, got {self.sensors!r}")
        self._seed = require_seed(seed)
        self._table = ServoTable.of(robot, servos)
        self.servos = self._table.servos
        self.assumed = (*model_assumptions(robot), *self._table.assumed)
        self._mujoco = mujoco_module()
        self.mj_model = model(robot, terrain=self.terrain, servos=self.servos).compile()
        _require_switches_that_close(self.sensors, robot)
        self.mj_data = self._mujoco.MjData(self.mj_model)
        data, joints = self.mj_data, 3 * robot.legs
        # Views are kept, as looking an array up in the engine's data takes longer than reading it.
        self._angles, self._speeds, self._all_speeds = data.qpos[7:], data.qvel[6:], data.qvel
        self._targets = data.ctrl.reshape(joints, len(ACTUATORS))
        self._servo_torques, self._back_emf = data.qfrc_actuator[6:], data.actuator_force[2 :: len(ACTUATORS)]
        self._measurement = Measurement(robot, self.mj_model, data)
        self._stall_currents = _stall_currents(robot)
        self._exact_channels = self._channels()
        self._timing: CommandTiming | None = None
        self._sampler: Sampler | None = None
        self._time, self._steps = 0.0, 0
        self._sum_of_drives: Float[np.ndarray, "joints"] | None = None
        self._mean_torques = np.zeros(joints)

    def average_torques(self) -> None:
        """From now on, give torques as means over a tick instead of those of its last physics step.

        Commands change in steps. After each step, damped servos first give more torque than the motion needs and then
        less, so that the last value of a tick differs systematically from the torque that the joints bear. Averaging
        takes about a tenth more time.
        """
        self._sum_of_drives = np.zeros(3 * self.robot.legs)

    def start(self, output: ControlOutput, *, seed: int | None = None) -> None:
        """Place the robot on the terrain in the controller's pose, and let it settle.

        Its lowest foot touches the ground; a robot on its belly lies on it.

        Parameters
        ----------
        output : ControlOutput
            What the controller starts with.
        seed : int, optional
            Seed of what is random in the sensors from now on; that of the plant where left out.

        Raises
        ------
        InputError
            If the robot starts inside the terrain, or servos are too stiff for the physics step.
        SimulationError
            If the simulation becomes unstable.
        """
        angles = _checked(output.angles, self.robot.legs)
        self._mujoco.mj_resetData(self.mj_model, self.mj_data)
        place(self.robot, self.terrain, output, self.mj_model, self.mj_data)
        check_stability(self._table, self.mj_model, self.mj_data)
        self._timing = CommandTiming(self._table, TIMESTEP, angles)
        self._time, self._steps = 0.0, 0
        for _ in range(round(_LONGEST_SETTLING / TIMESTEP / _SETTLING_CHECK)):
            self._advance(_SETTLING_CHECK)
            if np.abs(self.mj_data.qvel).max() < _AT_REST:
                break
        self._timing = CommandTiming(self._table, TIMESTEP, angles)
        self._time, self._steps = 0.0, 0
        self._measurement.turned()
        self._sampler = Sampler(self.sensors, self._exact(), seed=self._seed if seed is None else require_seed(seed))

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute joint angles for one tick, and measure.

        Parameters
        ----------
        output : ControlOutput
            What the controller gave out.
        dt : float
            Duration of the tick [s]; physics steps to the tick's end, rounded to a whole number of steps.

        Raises
        ------
        InputError
            If an angle or the duration is not finite, or the plant has not been started.
        SimulationError
            If the simulation becomes unstable.
        """
        return self.execute(output.angles, dt)

    def execute(self, angles: Float[np.ndarray, "legs 3"], dt: float) -> SensorReadings:
        """Execute joint angles that no controller gave out, as `step` does.

        Parameters
        ----------
        angles : array, shape (legs, 3)
            The joint angles [rad].
        dt : float
            Duration of the tick [s].
        """
        if self._timing is None or self._sampler is None:
            raise InputError("the simulated plant has not been started; call start(output) before step(output, dt)")
        if not 0 < dt <= _LONGEST_TICK:
            raise InputError(f"dt is {dt:g} s; it must be greater than 0 and at most {_LONGEST_TICK:g} s")
        self._timing.command(self._steps, _checked(angles, self.robot.legs))
        self._time += dt
        steps = round(self._time / TIMESTEP) - self._steps
        self._advance(steps)
        if steps and self.sensors.angular_rates:
            self._measurement.turned(steps * TIMESTEP)
        return self._sampler.read(self._time, self._exact())

    def stop(self) -> None:
        """Do nothing: the robot stays as it is."""

    @property
    def readings(self) -> SensorReadings:
        """The readings at the start; `step` returns all later ones.

        Raises
        ------
        InputError
            If the plant has not been started.
        """
        if self._sampler is None:
            raise InputError("the simulated plant has not been started; call start(output) before")
        return self._sampler.first

    @property
    def torques(self) -> Float[np.ndarray, "legs 3"]:
        """The servos' torques in the last physics step ``(legs, 3)`` [N m]."""
        return self._torques()

    @property
    def stall_torques(self) -> Float[np.ndarray, "joints"]:
        """The servos' stall torques, leg by leg ``(3 * legs,)`` [N m]; may be infinite."""
        return self._table.stall_torque

    @property
    def body_touches(self) -> bool:
        """Whether the body is in contact with the ground."""
        return self._measurement.body_touches()

    @property
    def state(self) -> PlantState:
        """The exact state of the robot; a copy."""
        data, shape = self.mj_data, (self.robot.legs, 3)
        return PlantState(
            time=self._time,
            body=Pose(self._measurement.rotation(), np.array(data.qpos[:3])),
            joint_angles=self._angles.reshape(shape).copy(),
            joint_speeds=self._speeds.reshape(shape).copy(),
            torques=self._torques(),
            saturated=self._table.saturated(self._drives(), self._speeds).reshape(shape),
            foot_forces=self._measurement.foot_forces(),
            slip_speeds=self._measurement.slip_speeds(),
            body_touches=self._measurement.body_touches(),
        )

    def _advance(self, steps: int) -> None:
        """Take physics steps."""
        assert self._timing is not None
        timing, number, end = self._timing, self._steps, self._steps + steps
        before = self._angles.copy()
        if self._sum_of_drives is not None:
            self._sum_of_drives[:] = 0.0
        while number < end:
            self._targets[:] = timing.advance(number)[:, None]
            until = timing.next_change(number, end)
            if self._sum_of_drives is None:
                self._mujoco.mj_step(self.mj_model, self.mj_data, until - number)
            else:
                self._average(self._sum_of_drives, until - number)
            number = until
        self._steps, speeds = end, self._all_speeds
        if self._sum_of_drives is not None and steps:
            damped = self._table.damping * (self._angles - before) / TIMESTEP
            self._mean_torques = (self._sum_of_drives - damped) / steps
        if not float(speeds @ speeds) < _UNSTABLE**2:
            fastest = float(np.abs(speeds).max())
            raise SimulationError(
                f"the simulation became unstable by {self._steps * TIMESTEP:.3f} s: a speed of {fastest:g} m/s or "
                "rad/s; softer servos, more rotor inertia or heavier links would work"
            )

    def _average(self, total: Float[np.ndarray, "joints"], steps: int) -> None:
        """Take physics steps, and add the servos' torques before damping to a total."""
        for _ in range(steps):
            self._mujoco.mj_step(self.mj_model, self.mj_data)
            total += self._servo_torques
            total -= self._back_emf

    def _drives(self) -> Float[np.ndarray, "joints"]:
        """Return the servos' torques before damping in the last physics step, ``(joints,)`` [N m]."""
        drives: np.ndarray = self._servo_torques - self._back_emf
        return drives

    def _torques(self) -> Float[np.ndarray, "legs 3"]:
        """Return the servos' torques in the last physics step, or their means over a tick ``(legs, 3)`` [N m]."""
        if self._sum_of_drives is not None:
            return self._mean_torques.reshape(self.robot.legs, 3).copy()
        # The implicit integrator damps by the speed at the end of the step.
        return np.asarray(self._drives() - self._table.damping * self._speeds).reshape(self.robot.legs, 3)

    def _channels(self) -> dict[str, Callable[[], Any]]:
        """Return a function for each channel of the sensor suite that gives its exact value, which may be a view."""
        measurement, shape = self._measurement, (self.robot.legs, 3)
        angles, speeds, currents = self._angles.reshape(shape), self._speeds.reshape(shape), self._stall_currents
        channels: dict[str, Callable[[], Any]] = {
            "joint_angles": lambda: angles,
            "joint_speeds": lambda: speeds,
            "torques": self._torques,
            "contacts": measurement.contact_forces,
            "forces": lambda: measurement.foot_forces() @ measurement.rotation(),
            "attitude": measurement.attitude,
            "angular_rates": measurement.angular_rates,
            "ground": lambda: partial(measurement.ground_heights, self.terrain),
        }
        if currents is not None:
            channels["currents"] = lambda: np.abs(self._torques()) * currents
        return {name: channel for name, channel in channels.items() if getattr(self.sensors, name)}

    def _exact(self) -> dict[str, Any]:
        """Return the exact values of all channels of the sensor suite."""
        return {name: channel() for name, channel in self._exact_channels.items()}


def _checked(angles: Shaped[np.ndarray, "..."], legs: int) -> Shaped[np.ndarray, "..."]:
    """Return joint angles in one axis; refuse another shape and angles that are not finite."""
    given = np.array(angles, dtype=float)
    if given.shape != (legs, 3):
        raise InputError(f"the commanded angles have shape {given.shape}; expected ({legs}, 3)")
    flat = given.ravel()
    # Faster than a test of each number; no angle is so large that its square overflows.
    if not math.isfinite(flat @ flat):
        leg, joint = np.argwhere(~np.isfinite(angles))[0].tolist()
        raise InputError(f"the commanded angle of leg {leg}, joint {joint} is {angles[leg, joint]}; it must be finite")
    return flat


def _require_switches_that_close(sensors: SensorSuite, robot: Robot) -> None:
    switch, load = sensors.contacts, float(total_mass(robot)) * STANDARD_GRAVITY / robot.legs
    if switch is not None and switch.threshold >= load:
        raise InputError(
            f"foot switches close at {switch.threshold:g} N, and each foot of a {robot.name} that stands bears "
            f"{load:.3g} N: none would close; lighter ones: SensorSuite(contacts=FootSwitch(threshold={load / 4:.2g}))"
        )


def _stall_currents(robot: Robot) -> Float[np.ndarray, "legs 3"] | None:
    """Return stall current over stall torque of every servo ``(legs, 3)`` [A/(N m)]; None if one is unknown."""
    rows = [
        [s.stall_current / s.stall_torque if s and s.stall_current else math.nan for s in row] for row in robot.servos
    ]
    ratio = np.array(rows)
    return None if np.isnan(ratio).any() else ratio
