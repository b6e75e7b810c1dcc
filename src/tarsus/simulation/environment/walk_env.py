"""The environment of one robot: `gymnasium.Env`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from tarsus.control.readings import SensorReadings
from tarsus.control.robot_controller import RobotController
from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, SimulationError
from tarsus.representation import represented
from tarsus.robot.file import load_robot
from tarsus.robot.robot import Robot
from tarsus.simulation.environment.actions import ActionKind, ActionMap
from tarsus.simulation.environment.body_motion import BodyMotion
from tarsus.simulation.environment.command_sampler import CommandSampler, top_speeds
from tarsus.simulation.environment.domain_randomisation import Domain, DomainRandomisation
from tarsus.simulation.environment.observation import BOUND, Observer
from tarsus.simulation.environment.reward import Reward, RewardWeights
from tarsus.simulation.environment.terrain_curriculum import TerrainCurriculum
from tarsus.simulation.sensors.suite import SensorSuite
from tarsus.simulation.servos.servo_table import ServoTable
from tarsus.simulation.simulated_plant import SimulatedPlant
from tarsus.simulation.terrain.protocol import Terrain

if TYPE_CHECKING:
    from jaxtyping import Float, Shaped

__all__ = ["DT", "WalkEnv"]

DT = 0.02
"""Duration of a step [s]."""


@represented("robot", "sensors", "action_kind", "command")
class WalkEnv(gymnasium.Env[Any, Any]):
    """A robot in physics that is to follow velocity commands, at 50 steps a second.

    An observation is what a real robot with the sensor suite would know, see `layout`; an action has three numbers in
    [-1, 1] for each leg. The reward of a step is the sum of the weighted terms of `RewardWeights`, which are in
    ``info["reward_terms"]``. An episode ends when the robot falls: the body touches the ground, or is tilted by 45 deg.

    Parameters
    ----------
    robot : Robot or str
        A single robot with masses, or the name of a preset or file.
    sensors : SensorSuite or str
        What it measures: a suite or the name of one (`SensorSuite.named`).
    actions : "residual" or "joint"
        Residuals on the joint angles of a `WalkController` that gets the same commands and no readings; or the joint
        targets themselves, 0 those of standing, -1 and 1 the joint limits.
    residual : float
        Residual for an action of 1 [rad].
    commands : CommandSampler, optional
        Where the velocity commands come from.
    terrain : Terrain, sequence of Terrain or TerrainCurriculum, optional
        What it walks on: one ground, or levels from easy to hard; flat ground where left out.
    randomisation : DomainRandomisation, optional
        What differs from one episode to the next; nothing where left out.
    servos : "catalogue", "ideal", ServoModel or nested sequence of ServoModel
        As for `SimulatedPlant`.
    reward : RewardWeights, optional
        Weights of the reward's terms.

    Attributes
    ----------
    robot : Robot
        The robot, as in its file.
    sensors : SensorSuite
        Its sensors.
    action_kind : str
        ``"residual"`` or ``"joint"``.
    top_speeds : array, shape (3,)
        Top speed forward, left [m/s] and turning [rad/s].
    curriculum : TerrainCurriculum
        The terrains.
    plant : SimulatedPlant
        The robot of this episode in physics.
    command : array, shape (3,)
        The present command: forward, left [m/s], turning [rad/s].
    targets : array, shape (legs, 3)
        The last joint targets [rad].
    readings : SensorReadings
        What was measured last.
    motion : BodyMotion
        The exact motion of the body.

    Raises
    ------
    InputError
        If an argument is out of its range, or the robot is a batch.
    MissingDataError
        If the mass of the body or of a link is unknown; with ``"catalogue"``, also if a servo is.
    """

    readings: SensorReadings
    motion: BodyMotion
    command: Float[np.ndarray, "3"]
    targets: Float[np.ndarray, "legs 3"]
    _angles: Float[np.ndarray, "legs 3"]
    _kept: Float[np.ndarray, "3"] | None
    _elapsed: float
    _until: float
    _asked: float
    _covered: float

    metadata: dict[str, Any] = {"render_modes": [], "render_fps": round(1 / DT)}  # noqa: RUF012 - Gymnasium's type

    def __init__(
        self,
        robot: Robot | str = "strider",
        *,
        sensors: SensorSuite | str = "hobby",
        actions: ActionKind = "residual",
        residual: float = 0.15,
        commands: CommandSampler | None = None,
        terrain: Terrain | Sequence[Terrain] | TerrainCurriculum | None = None,
        randomisation: DomainRandomisation | None = None,
        servos: Any = "catalogue",
        reward: RewardWeights | None = None,
    ) -> None:
        self.robot = load_robot(robot) if isinstance(robot, str) else robot
        self.sensors = SensorSuite.named(sensors) if isinstance(sensors, str) else sensors
        self.action_kind: ActionKind = actions
        self.curriculum = _curriculum(terrain)
        self._first_level = self.curriculum.level
        self._commands, self._randomisation = commands or CommandSampler(), randomisation
        self._domain = Domain(self.robot, ServoTable.of(self.robot, servos).servos, 1.0)
        self._start = RobotController(self.robot).output
        self._walk = WalkController(self.robot)
        self._cycle_time, self.top_speeds = self._walk.cycle_time, top_speeds(self._walk)
        standing = self._start.angles
        self._actions = ActionMap(self.robot, standing, kind=actions, residual=residual)
        self._reward = Reward(self.robot, reward or RewardWeights(), self.top_speeds)
        self.plant = self._new_plant(self.curriculum.levels[0], self._domain)
        self._begin(seed=0)
        self._observer = Observer(standing, self.top_speeds, self.readings, residual=actions == "residual")
        self.observation_space = gymnasium.spaces.Box(-BOUND, BOUND, (self._observer.size,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (standing.size,), np.float32)

    @property
    def layout(self) -> dict[str, slice]:
        """Where each part of an observation is: its name, and a slice."""
        return dict(self._observer.layout)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Float[np.ndarray, "size"], dict[str, Any]]:
        """Begin an episode.

        Parameters
        ----------
        seed : int, optional
            Seed of all that is random from now on; the curriculum starts again at its first level. The same seed and
            actions give the same episodes to the bit.
        options : dict, optional
            ``"command"``: a twist that is kept for the whole episode [m/s, m/s, rad/s]; ``"level"``: the level of the
            terrain.

        Returns
        -------
        observation, info

        Raises
        ------
        InputError
            If an option is unknown, or not possible.
        """
        super().reset(seed=seed)
        wanted = dict(options or {})
        command, level = wanted.pop("command", None), wanted.pop("level", None)
        if wanted:
            raise InputError(f"unknown option {next(iter(wanted))!r} of reset; there are 'command' and 'level'")
        random = self.np_random
        if level is not None or seed is not None:
            self.curriculum.go_to(self._first_level if level is None else int(level))
        elif self._asked > 0:
            covered = self._covered / self._asked
            self.curriculum.finish(covered, fallen=self._crashed or self.motion.fallen, random=random)
        domain = self._domain
        if self._randomisation is not None:
            domain = self._randomisation.sample(self.robot, domain.servos, random)
        terrain = self.curriculum.terrain(domain.friction, random)
        if self._randomisation is not None or terrain is not self.plant.terrain:
            self.plant = self._new_plant(terrain, domain)
        self._begin(seed=int(random.integers(2**31)))
        self._kept = None if command is None else _twist(command)
        self._choose_command()
        return self._observation(), self._info({})

    def step(
        self, action: Shaped[np.ndarray, "..."]
    ) -> tuple[Float[np.ndarray, "size"], float, bool, bool, dict[str, Any]]:
        """Take a step of 20 ms.

        Parameters
        ----------
        action : array, shape (3 * legs,)
            The action.

        Returns
        -------
        observation, reward, terminated, truncated, info
            Truncated is always False: `gymnasium.make` adds the time limit.

        Raises
        ------
        InputError
            If the action has another size, or is not finite.
        """
        targets = self._actions.targets(action, self._angles)
        rates, self.targets = (targets - self.targets) / DT, targets
        try:
            self.readings = self.plant.execute(targets, DT)
        except SimulationError:
            # A robot that can no longer be simulated counts as fallen.
            self._crashed = True
            return self._observation(), self._reward.fall, True, False, self._info({"fall": self._reward.fall})
        self.motion.update(DT)
        terms = self._reward.terms(self.plant, self.motion, self.command, rates)
        self._count()
        self._elapsed += DT
        info = self._info(terms)
        if self._elapsed >= self._until:
            self._choose_command()
        self._advance_walk()
        return self._observation(), sum(terms.values()), self.motion.fallen, False, info

    def _new_plant(self, terrain: Terrain, domain: Domain) -> SimulatedPlant:
        return SimulatedPlant(domain.robot, terrain=terrain, sensors=self.sensors, servos=domain.servos)

    def _begin(self, *, seed: int) -> None:
        """Place robot and walk controller at the start of an episode."""
        self.plant.start(self._start, seed=seed)
        self.readings = self.plant.readings
        self.motion = BodyMotion(self.plant)
        if self.action_kind == "residual":
            self._walk = WalkController(self.robot)
        self._angles, self.targets = self._start.angles, self._start.angles
        self.command = np.zeros(3)
        self._kept = None
        self._elapsed, self._until = 0.0, math.inf
        self._asked, self._covered, self._crashed = 0.0, 0.0, False

    def _choose_command(self) -> None:
        """Take the next command, and set when it ends."""
        if self._kept is not None:
            self.command = self._kept
            return
        self.command = self._commands.sample(self._walk, self.top_speeds, self.np_random)
        self._until = self._elapsed + self._commands.every - DT / 2

    def _advance_walk(self) -> None:
        if self.action_kind == "residual":
            self._angles = self._walk.step(self.command.tolist(), DT)

    def _count(self) -> None:
        """Add the last step to the commanded distance and the distance covered along it, in units of the top speeds."""
        asked, made = self.command / self.top_speeds, self.motion.travelled / self.top_speeds
        size = math.sqrt(float(asked @ asked))
        if size > 0:
            self._asked += size * DT
            self._covered += float(made @ asked) / size

    def _observation(self) -> Float[np.ndarray, "size"]:
        if self.action_kind == "residual":
            walk: tuple[Any, ...] = (self._angles, self._walk.contacts)
        else:
            walk = (self._elapsed / self._cycle_time % 1.0,)
        return self._observer.vector(self.command, self.readings, self.targets, *walk)

    def _info(self, terms: dict[str, float]) -> dict[str, Any]:
        return {
            "reward_terms": {name: terms.get(name, 0.0) for name in self._reward.names},
            "command": self.command.copy(),
            "velocity": self.motion.velocity.copy(),
            "level": self.curriculum.level,
        }

    def action_of(self, targets: Float[np.ndarray, "legs 3"]) -> Float[np.ndarray, "joints"]:
        """Return the action that gives joint targets now, or the nearest possible, ``(3 * legs,)``.

        Parameters
        ----------
        targets : array, shape (legs, 3)
            Joint targets [rad].
        """
        return self._actions.action(targets, self._angles)


def _curriculum(terrain: Terrain | Sequence[Terrain] | TerrainCurriculum | None) -> TerrainCurriculum:
    if isinstance(terrain, TerrainCurriculum):
        # Each environment has its own level.
        return TerrainCurriculum(terrain.levels, level=terrain.level)
    if terrain is None:
        return TerrainCurriculum()
    return TerrainCurriculum([terrain] if isinstance(terrain, Terrain) else terrain)


def _twist(command: Sequence[float]) -> Float[np.ndarray, "3"]:
    twist = np.array(command, dtype=float)
    if twist.shape != (3,) or not np.isfinite(twist).all():
        raise InputError(f"the command is {command!r}; it must be three finite numbers: forward, left, turning")
    return twist
