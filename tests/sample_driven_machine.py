"""A robot on emulated servos that a studio drives, in the servos' own time."""

import contextlib
import math
import threading
import time as real_time

import tarsus
from sample_studio import Asked
from tarsus import RobotController, hardware
from tarsus.studio.machine.driven_run import DrivenRun
from tarsus.studio.messages.state import StudioState
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Limits, Settings
from tarsus.studio.session import Session

STRIDER = tarsus.load_robot("strider")
START = StudioState(view="drive")


class Machine:
    """A robot on emulated servos that a studio drives, and what its visitors do at which time."""

    def __init__(self, kind="feetech-sts", start="standing"):
        self.clock = hardware.ManualClock()
        self.calibration = hardware.nominal_calibration(STRIDER, "strider", kind=kind)
        first = kind == "feetech-sts"
        self.bus, self.line = hardware.emulated_bus(kind, range(first, 18 + first), clock=self.clock)
        self.controller = RobotController(self.calibration.limited_robot, start=start)
        commands = self.calibration.commands(self.controller.output.angles).ravel()
        for number, command in enumerate(commands, first):
            self.line.servos[number].place(command)
        self.run = DrivenRun(self.controller, f"emulated: {kind}", clock=self.clock)
        self.plan, self.given, self.notes = {}, [], []
        self.tick = 0.0

    def visitor(self):
        return Asked(Session(START, run=self.run))

    def command(self, time, output, note):
        real_time.sleep(self.tick)
        for moment in [moment for moment in self.plan if moment <= time]:
            self.plan.pop(moment)()
        command = self.run.command(time, output, lambda kind, text: (note(kind, text), self.notes.append(text)))
        self.given.append((time, command))
        return command

    def over(self, time, output):
        return time >= self.until or self.run.over(time, output)

    def go(self, until, plan=()):
        """Run until a time, while visitors act."""
        self.until, self.plan = until, dict(plan)
        buses = {"main": self.bus}
        robot = self.calibration.limited_robot
        plant = hardware.ServoPlant(robot, self.calibration, buses=buses, clock=self.clock, observer=self.run.observe)
        self.run.plant = plant
        return tarsus.run(self.controller, plant, self, rate=100.0)

    @contextlib.contextmanager
    def going(self):
        """Run in a thread, a tick in no less than its time, until a visitor ends the run; yield the server."""
        limits = Limits(frame_hz=30.0)
        self.recordings, self.tick = [], 0.01
        thread = threading.Thread(target=lambda: self.recordings.append(self.go(math.inf)), daemon=True)
        with Serving(Settings(start=START, run=self.run, limits=limits)) as server:
            thread.start()
            try:
                yield server
            finally:
                self.until = 0.0
                thread.join()
