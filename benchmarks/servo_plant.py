"""The plant of servos in real time, and fuzzed: `--fuzz SECONDS` sends it anything for so much robot time."""

from __future__ import annotations

import argparse
import dataclasses
import math
import subprocess
import sys
from collections.abc import Iterator, Mapping
from typing import Any

# Must be imported before NumPy: it sets the number of threads.
from measure import Row, all_cores  # isort: split

import numpy as np

import tarsus
from tarsus import Command, RobotController, hardware
from tarsus.errors import TarsusError
from tarsus.robot.joint_limits import joint_limits

__all__ = ["servo_plant_rows"]

KIND, BAUD, SECONDS, RATE = "feetech-sts", 1_000_000, 60.0, 100.0


def servo_plant_rows() -> Iterator[Row]:
    """Walk for a minute on emulated servos of a process of their own."""
    command = [sys.executable, "-m", "tarsus.hardware.emulation", KIND, "1-18", "--baud", str(BAUD)]
    with all_cores(), subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            timing = walked(process.stdout.readline().strip())
        finally:
            process.kill()
    yield Row(
        what=f"robot controller and 18 emulated servos ({KIND}) at {RATE:.0f} Hz, walking for {SECONDS:.0f} s",
        measured=(
            f"{timing.missed} of {timing.ticks + timing.missed} ticks missed; begun late by "
            f"{timing.median * 1e3:.2f} ms, at worst {timing.worst * 1e3:.1f} ms"
        ),
        target="< 1 % missed",
        met=timing.missed < 0.01 * timing.ticks,
    )


def walked(port: str) -> hardware.Timing:
    """Walk, and return how well the ticks were kept."""
    robot = tarsus.load_robot("strider")
    made = hardware.nominal_calibration(robot, "strider", kind=KIND, port=port)
    made = made.replace(buses=(dataclasses.replace(made.buses[0], baud=BAUD),))
    kept: list[hardware.Timing] = []
    with hardware.ServoPlant(made.limited_robot, made) as plant:

        class Source:
            def command(self, time: float, *_: Any) -> Command:
                return Command(twist=(0.05, 0.0, 0.1 * math.sin(time)))

            def over(self, time: float, _output: Any) -> bool:
                if time >= SECONDS:
                    kept.append(plant.timing)
                return bool(kept)

        tarsus.run(RobotController(made.limited_robot), plant, Source(), rate=RATE)
    return kept[0]


class Checked:
    """A bus whose goals are checked one by one."""

    def __init__(self, bus: Any, clock: hardware.ManualClock, made: hardware.Calibration) -> None:
        self._bus, self._clock = bus, clock
        speeds = joint_limits(made.robot).speed * np.abs(made.slopes)
        self._speed = dict(enumerate(speeds.ravel().tolist(), 1))
        self._limits = dict(enumerate(made.command_limits.reshape(-1, 2).tolist(), 1))
        self._last: dict[int, tuple[float, float]] = {}
        self.goals = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._bus, name)

    def write_goals(self, goals: Mapping[int, float]) -> None:
        """Check goals against limits and speeds, and send them."""
        now = self._clock.now()
        for number, goal in goals.items():
            low, high = self._limits[number]
            if not low <= goal <= high:
                raise SystemExit(f"{now:.3f} s: {goal} of servo {number} is beyond {low} to {high}")
            before, at = self._last.get(number, (now, goal))
            if abs(goal - at) > self._speed[number] * (now - before) + 1e-6:
                raise SystemExit(f"{now:.3f} s: servo {number} goes from {at} to {goal} within {now - before:.4f} s")
            self._last[number] = now, goal
            self.goals += 1
        self._bus.write_goals(goals)


def fuzzed(seconds: float, seed: int) -> str:
    """Send a plant anything, and return what left."""
    random, clock = np.random.default_rng(seed), hardware.ManualClock()
    robot = tarsus.load_robot("strider")
    made = hardware.nominal_calibration(robot, "strider", kind=KIND)
    bus, line = hardware.emulated_bus(KIND, range(1, 19), clock=clock, baud=BAUD)
    checked = Checked(bus, clock, made)
    buses: Any = {"main": checked}
    errors: dict[str, int] = {}
    while clock.now() < seconds:
        # A new run, from wherever the servos are, after at most a minute.
        controller = RobotController(made.limited_robot)
        plant = hardware.ServoPlant(made.limited_robot, made, buses=buses, clock=clock)
        for servo in line.servos.values():
            servo.temperature = 25.0
        end = clock.now() + random.uniform(1, 60)
        noise = 10.0 ** random.uniform(-4, 3)
        try:
            with plant:
                plant.start(controller.output)
                while clock.now() < end:
                    run_tick(random, clock, controller, plant, noise)
        except TarsusError as error:
            errors[type(error).__name__] = errors.get(type(error).__name__, 0) + 1
    return f"{checked.goals} goals in {clock.now():.0f} s, none beyond a limit or a speed; runs ended by {errors}"


def run_tick(
    random: np.random.Generator,
    clock: hardware.ManualClock,
    controller: RobotController,
    plant: hardware.ServoPlant,
    noise: float,
) -> None:
    """Give a plant the output of a controller, or something else."""
    dt = float(random.choice([0.01, 0.02, 0.005, 1e-6, 1.0]))
    twist = random.uniform(-0.1, 0.1, 3)
    output = controller.step(Command(twist=tuple(twist.tolist())), 0.01)
    angles = output.angles
    kind = random.random()
    if kind < 0.05:
        angles = angles + random.normal(0, noise, angles.shape)
    elif kind < 0.0503:
        angles = np.where(random.random(angles.shape) < 0.1, random.choice([np.nan, np.inf, -np.inf]), angles)
    if random.random() < 0.02:
        clock.sleep(float(random.exponential(0.05)))
    plant.step(dataclasses.replace(output, angles=angles), dt)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fuzz", type=float, metavar="SECONDS", help="robot time to be fuzzed [s]")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    if options.fuzz:
        print(fuzzed(options.fuzz, options.seed))
    else:
        for row in servo_plant_rows():
            print(row)
