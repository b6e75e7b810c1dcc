"""Write the tables of faults and of changes of state in how-true.md: what happens to a walk when something breaks."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from page_tables import write_tables
from tarsus import Command, ControlOutput, Robot, RobotController, SensorReadings, list_robots, load_robot, run
from tarsus.kinematics.mass import STANDARD_GRAVITY, total_mass
from tarsus.simulation import FootSwitch, Outcome, SensorSuite, SimulatedPlant, TracedPlant

PAGE = Path(__file__).parent / "how-true.md"
SPEED, DURATION = 0.05, 8.0
FAULT_AT = 2.0
PUSH = 0.2
"""Duration of a push [s]."""
ROBOTS = ("strider", "phantomx")


class FaultyPlant(TracedPlant):
    """A traced plant whose sensors or body something happens to."""

    def __init__(self, plant: SimulatedPlant, fault: Callable[[FaultyPlant, float, SensorReadings], SensorReadings]):
        super().__init__(plant)
        self.fault, self.kept = fault, SensorReadings()

    def step(self, output: ControlOutput, dt: float) -> SensorReadings:
        """Execute joint angles for one tick, and measure."""
        readings = super().step(output, dt)
        return self.fault(self, self.plant.state.time, readings)


def nothing(_plant: FaultyPlant, _time: float, readings: SensorReadings) -> SensorReadings:
    """Leave the readings as they are."""
    return readings


def stuck_attitude(plant: FaultyPlant, time: float, readings: SensorReadings) -> SensorReadings:
    """Repeat the attitude that was measured at the time of the fault."""
    if time < FAULT_AT:
        plant.kept = readings
    return dataclasses.replace(readings, attitude=plant.kept.attitude)


def push(fraction: float) -> Callable[[FaultyPlant, float, SensorReadings], SensorReadings]:
    """Return a fault that pushes the body to the left, with a fraction of the robot's weight."""

    def pushed(plant: FaultyPlant, time: float, readings: SensorReadings) -> SensorReadings:
        weight = float(total_mass(plant.robot)) * STANDARD_GRAVITY
        force = fraction * weight if FAULT_AT <= time < FAULT_AT + PUSH else 0.0
        plant.plant.mj_data.xfrc_applied[1, 1] = force
        return readings

    return pushed


def weak_servo(plant: SimulatedPlant, fraction: float) -> Any:
    """Return the plant's servos, with a fraction of its torque left to the middle left femur's."""
    servos = [list(row) for row in plant.servos]
    servo = servos[1][1]
    left = max(fraction, 1e-3)
    servos[1][1] = dataclasses.replace(
        servo,
        stall_torque=left * servo.stall_torque,
        control_stiffness=left * servo.control_stiffness if fraction == 0 else servo.control_stiffness,
    )
    return servos


def walked(robot: Robot, *, sensors: Any, levelling: Any = None, servo: float = 1.0, fault: Any = nothing) -> str:
    """Return the cells of a row: way, turn, tilt, interventions of the guard, and what happened."""
    plant = SimulatedPlant(robot, sensors=sensors, seed=1)
    if servo < 1:
        plant = SimulatedPlant(robot, sensors=sensors, seed=1, servos=weak_servo(plant, servo))
    faulty = FaultyPlant(plant, fault)
    controller = RobotController(robot, levelling=levelling)
    recording = run(controller, faulty, [(0.0, Command(twist=(SPEED, 0.0, 0.0)))], duration=DURATION)
    outcome = Outcome.of(faulty.trace)
    guard = sum(recording.interventions.values())
    result = "; ".join(outcome.problems) or "walks on"
    return (
        f"{outcome.way_ratio:.2f} | {round(math.degrees(outcome.end[2]))} deg | {math.degrees(outcome.tilt):.1f} deg | "
        f"{guard} | {result}"
    )


def flipping_switches(fraction: float) -> SensorSuite:
    """Return the hobby suite with foot switches that are wrong a fraction of the time."""
    suite = SensorSuite.named("hobby")
    assert isinstance(suite.contacts, FootSwitch)
    return dataclasses.replace(suite, contacts=dataclasses.replace(suite.contacts, flips=fraction))


FAULTS: dict[str, dict[str, Any]] = {
    "none": {"sensors": "blind"},
    "one servo dead (middle left femur)": {"sensors": "blind", "servo": 0.0},
    "one servo with half its torque": {"sensors": "blind", "servo": 0.5},
    "push of a tenth of the weight for 0.2 s": {"sensors": "blind", "fault": push(0.1)},
    "push of half the weight for 0.2 s": {"sensors": "blind", "fault": push(0.5)},
    "foot switches and IMU, no fault": {"sensors": flipping_switches(0.0), "levelling": "level"},
    "IMU stuck": {"sensors": flipping_switches(0.0), "levelling": "level", "fault": stuck_attitude},
    "foot switches wrong 1 % of the time": {"sensors": flipping_switches(0.01), "levelling": "level"},
}


def fault_row(name: str, fault: str) -> str:
    """Return a row of the table of faults."""
    return f"| {name} | {fault} | {walked(load_robot(name), **FAULTS[fault])} |\n"


def fault_table() -> str:
    """Return the table of faults."""
    rows = "".join(fault_row(name, fault) for fault in FAULTS for name in ROBOTS)
    return f"| robot | fault | distance | turned | tilt | guard | result |\n|---|---|---|---|---|---|---|\n{rows}"


def state_row(name: str, servos: str) -> str:
    """Return a row of the table of changes of state: stand up from the folded pose, sit down, fold."""
    robot = load_robot(name)
    traced = TracedPlant(SimulatedPlant(robot, servos=servos, sensors="blind"))
    commands = [(0.0, Command(state="standing")), (9.0, Command(state="lying")), (15.0, Command(state="folded"))]
    recording = run(RobotController(robot, start="folded"), traced, commands, duration=20.0)
    outcome, trace = Outcome.of(traced.trace), traced.trace
    stall = np.array([[servo.stall_torque for servo in row] for row in traced.plant.servos])
    used = float((np.abs(trace.torques) / stall).max())
    peaks = ", ".join(f"{torque:.2f}" for torque in outcome.peak_torque)
    states = recording.states[-1]
    return (
        f"| {name} | {servos} | {math.degrees(outcome.tilt):.1f} deg | {peaks} N m | "
        f"{'none' if used == 0 else f'{100 * used:.0f} %'} | {'; '.join(outcome.problems) or f'ends {states}'} |\n"
    )


def state_table() -> str:
    """Return the table of changes of state."""
    robots = [name for name in list_robots() if load_robot(name).has_masses]
    rows = "".join(state_row(name, servos) for name in robots for servos in ("ideal", "catalogue"))
    return (
        "| robot | servos | tilt | peak torque: coxa, femur, tibia | of the stall torque | result |\n"
        f"|---|---|---|---|---|---|\n{rows}"
    )


if __name__ == "__main__":
    write_tables(__doc__, PAGE, lambda _: {"faults": fault_table(), "states": state_table()})
