"""Drives live walkers, and finds out afterwards what they broke of what must hold whatever is asked of them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from tarsus.control.command import Command
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController
from tarsus.gait.foot_polygons import NORMALS
from tarsus.kinematics.leg import forward_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rolling import rolling_displacements
from tarsus.kinematics.stability import stability_margin

ROUNDING = 1.001
STILL = 1e-6
# Of its radius: how far a ball may slip while the posture changes, which moves what it rolls about.
SLIP_OF_BALLS = 0.7
GAITS = ("tripod", "tetrapod", "ripple", "wave")
LONGEST_TICK = 0.05


class Trace:
    """What a walker did, tick by tick; the first row is where it stood.

    Everything is judged by the joint angles, the body's pose and the contacts alone: where the feet are comes from
    forward kinematics.
    """

    def __init__(self, controller: WalkController) -> None:
        self.controller = controller
        self._rows: list[tuple[Any, ...]] = []
        self.commands: list[tuple[Any, float]] = []
        self._record(controller.angles, LONGEST_TICK)

    def step(self, command: Any, dt: float, **readings: Any) -> None:
        """Go on by one tick, and note what came of it."""
        self.commands.append((command, dt))
        self._record(self.controller.step(command, dt, **readings), dt)

    def run(self, command: Any, duration: float, dt: float = 0.025) -> Trace:
        """Continue with one command for a time."""
        for _ in range(max(1, round(duration / dt))):
            self.step(command, dt)
        return self

    def _record(self, angles: np.ndarray, dt: float) -> None:
        body = self.controller.body
        self._rows.append((dt, angles, body.rotation, body.position, self.controller.contacts))

    def column(self, which: int) -> np.ndarray:
        return np.array([row[which] for row in self._rows])

    @property
    def dt(self) -> np.ndarray:
        return self.column(0)

    @property
    def angles(self) -> np.ndarray:
        return self.column(1)

    @property
    def body(self) -> Pose:
        return Pose(self.column(2), self.column(3))

    @property
    def contacts(self) -> np.ndarray:
        return self.column(4)

    @property
    def feet(self) -> np.ndarray:
        """The feet in G ``(n, legs, 3)`` [m]."""
        return self.body @ forward_kinematics(self.controller.robot, self.angles)[..., 3, :]

    def margins(self) -> np.ndarray:
        return np.asarray(stability_margin(self.controller.robot, self.angles, self.body, self.contacts))

    def joint_shares(self) -> tuple[np.ndarray, np.ndarray]:
        """Speed and acceleration of every joint by divided differences, over the greatest; ``(n - 1, legs, 3)``."""
        dt, angles = self.dt, self.angles
        speed = np.diff(angles, axis=0) / dt[1:, None, None]
        change = np.diff(speed, axis=0, prepend=np.zeros_like(speed[:1]))
        between = (dt[1:] + np.concatenate([dt[1:2], dt[1:-1]])) / 2
        fastest, hardest = self.controller.joint_speed, self.controller.joint_acceleration
        return np.abs(speed) / fastest, np.abs(change / between[:, None, None]) / hardest

    def slip(self) -> np.ndarray:
        """How far every foot that is down has slipped, beyond rolling, since it came down ``(n, legs)`` [m]."""
        feet, down = self.feet, self.contacts
        rolled = rolling_displacements(self.controller.robot, self.angles, self.body)
        feet[1:] -= np.cumsum(rolled, axis=0)
        begins = down & ~np.concatenate([np.zeros_like(down[:1]), down[:-1]])
        since = np.maximum.accumulate(np.where(begins, np.arange(len(down))[:, None], 0), axis=0)
        moved = np.abs(feet - np.take_along_axis(feet, since[..., None], axis=0)).max(-1)
        return np.asarray(np.where(down, moved, 0.0))

    def broken(self, *, flat: bool = True) -> list[str]:
        """Return what of the invariants is broken, where first and how much.

        On ground that is not flat, or not known to be, margins and heights are not looked at.
        """
        angles, limits = self.angles, self.controller.robot.limits
        if not np.isfinite(angles).all():
            return ["angles that are not finite"]
        speed, acceleration = self.joint_shares()
        beyond = np.maximum(limits[..., 0] - angles, angles - limits[..., 1])
        down = self.contacts.sum(-1)
        radius = float(np.max(self.controller.robot.foot_radius))
        found = [
            *_over("beyond a joint's limit [rad]", beyond, 1e-9),
            *_over("joint speed over the greatest", speed, ROUNDING),
            *_over("joint acceleration over the greatest", acceleration, ROUNDING),
            *_over("feet missing of three that are down", 3 - down, 0),
            *_over("slip of a foot that is down [m]", self.slip(), STILL + SLIP_OF_BALLS * radius),
        ]
        if flat:
            height = self.feet[..., 2]
            found += [
                *_over("centre of mass outside the support [m]", -self.margins(), 0.0),
                *_over("height of a foot that is down [m]", np.where(self.contacts, np.abs(height), 0.0), STILL),
                *_over("depth of a foot under the ground [m]", -height, STILL),
            ]
        return found

    def assert_sound(self, *, flat: bool = True) -> None:
        found = self.broken(flat=flat)
        assert not found, f"{self.controller.robot.name}: " + "; ".join(found)


def beyond(controller: WalkController) -> float:
    """How far the foot on the ground that is farthest out is beyond its polygon [m]."""
    now, bounds = controller._tick.gait, controller._walk.transitions.footholds.bounds
    seen = (now.foot - now.origin) * np.exp(-1j * now.yaw)
    return float(((seen[:, None] * NORMALS.conj()).real - bounds)[now.down].max())


def _over(what: str, values: np.ndarray, bound: float) -> Iterable[str]:
    rows = values.reshape(len(values), math.prod(values.shape[1:])).max(-1)
    bad = np.flatnonzero(~(rows <= bound))
    if bad.size:
        yield f"{what}: {bad.size} times, first at tick {bad[0]}, at most {rows[bad].max():.6g} (bound {bound:g})"


class Stream:
    """Random commands, for as long as one likes: each lasts for a while, and changes one thing at a time or several.

    The seed settles everything: robot apart, the same stream always asks for the same.
    """

    def __init__(self, seed: int, controller: WalkController, *, with_foot_targets: bool = False) -> None:
        self._rng = np.random.default_rng(seed)
        self._body_height, self._lift = (
            controller.robot.gait.body_height or 0.1,
            controller.robot.gait.swing_height or 0.03,
        )
        self._feet = controller.feet
        self._twist = np.zeros(3)
        # Some streams tick evenly, most don't.
        self._even = float(self._rng.choice([0.0, 0.0, 0.05, 0.03]))
        self._kinds = (
            *[self._turn] * 6,
            *[self._gait, self._body] * 2,
            self._height,
            self._stance,
            self._pace,
            *([self._sway, self._foot_target, self._foot_velocity] if with_foot_targets else []),
        )

    def dt(self) -> float:
        """The next tick's length [s]: 36 ms in the mean."""
        return self._even or float(self._rng.choice([self._rng.uniform(0.001, 0.05), 0.045, 0.03]))

    def lasts(self) -> float:
        """Duration of the next command [s]."""
        return float(self._rng.choice([0.05, 0.3, 1.0, 3.0, 10.0]))

    def command(self) -> Command:
        """The next command."""
        changes: dict[str, Any] = {}
        for kind in self._rng.choice(len(self._kinds), size=self._rng.choice([1, 1, 1, 3])):
            changes |= self._kinds[kind]()
        return Command(twist=tuple(self._twist), **changes)

    def readings(self) -> SensorReadings:
        """Readings that no sensor could give, mixed with some that one could on flat ground."""
        rng = self._rng
        garbage = (None, math.nan, math.inf, "broken", [], [math.nan] * 6, np.full((6, 3), np.nan), [[1e9] * 3] * 6)
        return SensorReadings(
            contacts=garbage[rng.integers(len(garbage))],
            attitude=(None, (math.nan, 0.0), (9.0, 0.0), "level", (0.0, 0.0))[rng.integers(5)],
            forces=garbage[rng.integers(len(garbage))],
            torques=garbage[rng.integers(len(garbage))],
            age=(0.0, 0.0, math.nan, -1.0, 1e9, None)[rng.integers(6)],
        )

    def _turn(self) -> dict[str, Any]:
        size = self._rng.choice([0, 0.05, 0.2, 1.0, 10.0])
        axes = self._rng.choice([[1, 1, 3], [1, 0, 0], [0, 1, 0], [0, 0, 3]])
        self._twist = self._rng.normal(size=3) * size * axes
        return {}

    def _gait(self) -> dict[str, Any]:
        return {"gait": str(self._rng.choice(GAITS))}

    def _body(self) -> dict[str, Any]:
        size = self._rng.choice([0, 1, 3])
        return {"body": tuple(size * self._rng.normal(size=6) * [0.02, 0.02, 0.02, 0.1, 0.1, 0.1])}

    def _height(self) -> dict[str, Any]:
        return {"body_height": self._body_height * self._rng.uniform(0.5, 1.5)}

    def _stance(self) -> dict[str, Any]:
        return {"swing_height": self._lift * self._rng.uniform(0, 1.8), "stance_width": self._rng.uniform(-0.03, 0.03)}

    def _pace(self) -> dict[str, Any]:
        return {"cycle_time": self._rng.choice([0.3, 0.5, 1, 2, 4])}

    def _sway(self) -> dict[str, Any]:
        size = self._rng.choice([0, 1])
        return {"sway": tuple(size * self._rng.uniform(0, 1, size=6) * [0.01, 0.01, 0.01, 0.05, 0.05, 0.05])}

    def _foot_target(self) -> dict[str, Any]:
        leg = int(self._rng.integers(6))
        point = self._feet[leg] + self._rng.normal(size=3) * 0.05 + [0, 0, 0.05]
        back = dict.fromkeys(range(6))
        return {"foot_targets": back | {leg: tuple(point)} if self._rng.random() < 0.6 else back}

    def _foot_velocity(self) -> dict[str, Any]:
        return {"foot_velocities": {int(self._rng.integers(6)): tuple(self._rng.normal(size=3) * 0.05)}}


def drive(
    controller: WalkController, seed: int, duration: float, *, sensing: bool = False, with_foot_targets: bool = False
) -> Trace:
    """Drive a walker with a stream of commands, and of sensors' garbage where it is `sensing`."""
    stream, trace = Stream(seed, controller, with_foot_targets=with_foot_targets), Trace(controller)
    while controller.time < duration:
        asked: Any = stream.command()
        until, twist = min(controller.time + stream.lasts(), duration), asked.twist
        while asked is not twist or controller.time < until:
            trace.step(asked, stream.dt(), **({"readings": stream.readings()} if sensing else {}))
            asked = twist
    return trace
