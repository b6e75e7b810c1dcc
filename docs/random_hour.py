"""Write the table of random walks in ground-measured.md: robots, terrain, commands and faults drawn at random.

python docs/random_hour.py --minutes 60 --jobs 16
python docs/random_hour.py --minutes 5 --seed 100 --print
"""

from __future__ import annotations

import argparse
import math
import traceback
from typing import Any, NamedTuple

import numpy as np

import tarsus
from estimated_contacts import JOINTS
from leg_failures import break_servo
from page_tables import measured, write_tables
from rough_ground import CLEAR, LIES, PAGE, ROBOTS, switches
from sensor_faults import LATE, LOAD_CELLS, LOST, ONE_DEGREE, SUITES, Stuck, with_sensors
from tarsus.simulation import SensorSuite, SimulatedPlant, terrain

DT, MINUTE = 0.01, 60.0
# Greatest heights [mm] and slopes [deg].
GROUNDS = {"smooth": 60, "blocks": 60, "step": 40, "ramp": 20}
GAITS = ("tripod", "tetrapod", "ripple", "wave")
SENSORS: dict[str, Any] = {
    "hobby": SensorSuite.named("hobby"),
    "smart": JOINTS,
    "late": LATE,
    "1 % wrong": switches(flips=0.01),
    "5 % wrong": switches(flips=0.05),
    "1 deg": with_sensors(attitude=ONE_DEGREE),
    "lost": with_sensors(**LOST),
    "load cells": SUITES[LOAD_CELLS],
}
# Of the weight, and how long [s].
PUSH, PUSHED = 0.1, 0.2
# Robots turn back this far from the middle of the terrain, which is 2 m wide to each side [m].
FAR = 1.1
FALLEN = math.radians(45.0)


class Minute(NamedTuple):
    """What is drawn for a minute: robot, ground, sensors, and when what fails."""

    seed: int
    robot: str
    ground: str = "flat"
    height: float = 0.0
    sensors: str = "ideal"
    pushes: tuple[float, ...] = ()
    stuck_switch: tuple[int, bool] | None = None
    servo: tuple[float, int, int] | None = None

    @classmethod
    def drawn(cls, seed: int) -> Minute:
        """Return what a seed draws."""
        draw = np.random.default_rng(seed)
        robot = str(draw.choice(sorted(ROBOTS)))
        ground = str(draw.choice(["flat", *GROUNDS]))
        height = float(draw.uniform(0.3, 1.0)) * GROUNDS.get(ground, 0)
        height *= -1.0 if ground == "step" and draw.random() < 1 / 2 else 1.0
        sensors = str(draw.choice(["ideal", *SENSORS]))
        pushes = tuple(sorted(draw.uniform(2, MINUTE, 3).tolist())) if draw.random() < 1 / 3 else ()
        stuck = (int(draw.integers(6)), bool(draw.random() < 1 / 2)) if draw.random() < 1 / 8 else None
        servo = (float(draw.uniform(5, 40)), int(draw.integers(6)), int(draw.integers(3)))
        stuck = None if sensors in {"smart", "load cells"} else stuck
        return cls(seed, robot, ground, height, sensors, pushes, stuck, servo if draw.random() < 1 / 8 else None)

    @property
    def faultless(self) -> Minute:
        """The same minute with ideal sensors, and nothing that pushes or fails."""
        return self._replace(sensors="ideal", pushes=(), stuck_switch=None, servo=None)

    @property
    def level(self) -> Minute:
        """The same minute on level ground."""
        return self._replace(ground="flat", height=0.0)

    @property
    def terrain(self) -> Any:
        """The ground."""
        size = self.height / 1e3
        kinds: dict[str, Any] = {
            "flat": terrain.Flat,
            "smooth": lambda: terrain.Smooth(amplitude=size, clear=CLEAR, seed=self.seed),
            "blocks": lambda: terrain.Blocks(rise=size, clear=CLEAR, seed=self.seed),
            "step": lambda: terrain.Step(rise=size),
            "ramp": lambda: terrain.Ramp(slope=math.radians(self.height)),
        }
        return kinds[self.ground]()

    def text(self) -> str:
        """Return what is drawn in words."""
        parts = [f"seed {self.seed}: {self.robot} on {self.ground} {self.height:.0f}, {self.sensors} sensors"]
        parts += ["pushed"] if self.pushes else []
        parts += [f"switch {self.stuck_switch[0]} {self.stuck_switch[1]}"] if self.stuck_switch else []
        parts += [f"servo {self.servo[1:]} limp at {self.servo[0]:.0f} s"] if self.servo else []
        return ", ".join(parts)


class Outcome(NamedTuple):
    """What became of a minute: when the robot fell, what the guard stopped, what was raised; empty for nothing.

    Each touch of the body that is no fall has its time and its duration [s].
    """

    minute: Minute
    fell: float = math.nan
    touches: tuple[tuple[float, float], ...] = ()
    stopped: tuple[str, ...] = ()
    raised: str = ""
    way: float = 0.0

    @property
    def mishap(self) -> bool:
        """Whether the robot has fallen, or its body has touched the ground."""
        return not math.isnan(self.fell) or bool(self.touches)


def commanded(draw: np.random.Generator, robot: tarsus.Robot, home: complex | None, top: float) -> tarsus.Command:
    """Return the next command: most change the twist, some the gait, the posture, or the state of the robot."""
    heading = np.angle(home) if home is not None else draw.choice([0.0, draw.uniform(-math.pi, math.pi)])
    speed = top * draw.uniform(0.2, 1.0) * (draw.random() > 0.15)
    turn = draw.uniform(-0.5, 0.5) * (draw.random() < 0.4)
    more: dict[str, Any] = {}
    kind = draw.random()
    height = tarsus.default_body_height(robot)
    if kind < 0.1:
        more["gait"] = str(draw.choice(GAITS))
    elif kind < 0.2:
        more["body"] = (*draw.uniform(-0.015, 0.015, 3), *draw.uniform(-0.08, 0.08, 3))
    elif kind < 0.25:
        more["body_height"] = height * draw.uniform(0.85, 1.15)
    elif kind < 0.3:
        more["swing_height"] = draw.uniform(0.02, 0.06)
    elif kind < 0.35:
        more["stance_width"] = draw.uniform(-0.01, 0.02)
    elif kind < 0.4:
        more["cycle_time"] = draw.choice([0.8, 1.2, 2.0])
    elif kind < 0.43:
        more["state"] = str(draw.choice(["lying", "folded"]))
    more.setdefault("state", "standing")
    return tarsus.Command(twist=(speed * math.cos(heading), speed * math.sin(heading), turn), **more)


def lived(minute: Minute) -> Outcome:
    """Return what becomes of a minute."""
    try:
        return _lived(minute)
    except Exception as error:
        where = traceback.extract_tb(error.__traceback__)[-1]
        return Outcome(minute, raised=f"{type(error).__name__}: {error} ({where.name}, line {where.lineno})")


def _lived(minute: Minute) -> Outcome:
    draw, robot = np.random.default_rng(minute.seed + 1_000_000), tarsus.load_robot(minute.robot)
    sensors = SENSORS.get(minute.sensors, "ideal")
    plant = SimulatedPlant(robot, terrain=minute.terrain, sensors=sensors, seed=minute.seed)
    controller = tarsus.RobotController(robot)
    top = tarsus.WalkController(robot).top_speed((1, 0, 0))
    output, command, due = controller.output, tarsus.Command(), 0.0
    plant.start(output)
    stopped: list[str] = []
    touches: list[tuple[float, float]] = []
    lying = 0.0
    way, before = 0.0, complex(*plant.state.body.position[:2])
    weight = float(plant.mj_model.body_mass.sum()) * 9.80665
    for tick in range(round(MINUTE / DT)):
        time, state = tick * DT, plant.state
        at = complex(*state.body.position[:2].tolist())
        roll, pitch, yaw = np.asarray(state.body.rpy).tolist()
        way, before = way + abs(at - before), at
        lies = state.body_touches and output.state.upright
        if lying and not lies:
            touches.append((time - lying, lying))
        lying = lying + DT if lies else 0.0
        if math.hypot(roll, pitch) > FALLEN or lying > LIES:
            return Outcome(minute, time, tuple(touches), tuple(stopped), way=way)
        if time >= due:
            home = -at * np.exp(-1j * yaw) if abs(at) > FAR else None
            command, due = commanded(draw, robot, home, top), time + draw.uniform(2.0, 6.0)
        else:
            command = tarsus.Command(twist=command.twist)
        plant.mj_data.xfrc_applied[1, :2] = 0.0
        for push in minute.pushes:
            if push <= time < push + PUSHED:
                direction = 2 * math.pi * (push % 1.0)
                plant.mj_data.xfrc_applied[1, :2] = PUSH * weight * np.array([math.cos(direction), math.sin(direction)])
        if minute.servo and time >= minute.servo[0]:
            _, leg, joint = minute.servo
            break_servo(plant, 3 * leg + joint, limp=True)
        readings = plant.step(output, DT)
        if minute.stuck_switch:
            readings = Stuck(*minute.stuck_switch)(readings, time)
        output = controller.step(command, DT, readings)
        stopped += [each.text() for each in output.interventions]
    if lying:
        touches.append((MINUTE - lying, lying))
    return Outcome(minute, touches=tuple(touches), stopped=tuple(stopped), way=way)


def cause(mishap: Outcome) -> str:
    """Return what a fall or touch takes: the minute is repeated without the faults, and on level ground."""
    repeated = {"the faults": mishap.minute.faultless, "the ground": mishap.minute.level}
    needed = [name for name, minute in repeated.items() if minute != mishap.minute and not lived(minute).mishap]
    return " and ".join(needed) or "neither faults nor ground"


def table(outcomes: list[Outcome]) -> str:
    """Return the table of the outcomes."""
    falls = [each for each in outcomes if not math.isnan(each.fell)]
    raised = [f"{each.minute.text()}: {each.raised}" for each in outcomes if each.raised]
    refused = [f"{each.minute.text()}: {text}" for each in outcomes for text in each.stopped]
    fallen = [f"{each.minute.text()}, after {each.fell:.0f} s; it takes {cause(each)}" for each in falls]
    touched = [
        f"{each.minute.text()}, {len(each.touches)} from {each.touches[0][0]:.0f} s on, for"
        f" {1e3 * max(duration for _, duration in each.touches):.0f} ms at most; it takes {cause(each)}"
        for each in outcomes
        if each.touches and math.isnan(each.fell)
    ]
    rows = [
        f"| minutes, way | {len(outcomes)}, {sum(each.way for each in outcomes):.0f} m |",
        *(
            f"| {title} | {'<br>'.join([str(len(lines)), *lines])} |"
            for title, lines in (
                ("exceptions", raised),
                ("angles that the guard refused", refused),
                ("falls", fallen),
                ("minutes in which the body touches the ground", touched),
            )
        ),
    ]
    return "\n".join(["| random walks | |", "|---|---|", *rows])


def tables(asked: argparse.Namespace) -> dict[str, str]:
    """Measure, tell of each minute as it ends, and return the table."""
    minutes = [Minute.drawn(asked.seed + number) for number in range(asked.minutes)]
    outcomes = []
    for outcome in measured(lived, minutes, asked.jobs):
        outcomes.append(outcome)
        fell = "" if math.isnan(outcome.fell) else f"fell after {outcome.fell:.1f} s"
        touches = f"touches {len(outcome.touches)} times" if outcome.touches else ""
        print(
            outcome.minute.text(),
            f"{outcome.way:.1f} m",
            fell,
            touches,
            *outcome.stopped[:1],
            outcome.raised,
            flush=True,
        )
    return {"random hour": table(outcomes)}


if __name__ == "__main__":
    write_tables(__doc__, PAGE, tables, minutes=60, seed=0, jobs=1)
