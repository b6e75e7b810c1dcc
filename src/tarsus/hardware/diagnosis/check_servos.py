"""The decision tree: port, servos, supply, state, motion; it ends where what follows would mean nothing."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Generator, Iterator, Mapping
from typing import TypeAlias

from tarsus.errors import BusError, NoAnswerError, PortError
from tarsus.hardware.bus.inputs import InputBoard
from tarsus.hardware.bus.protocol import Bus, Telemetry
from tarsus.hardware.bus.registry import bus_kind, open_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.plant.reading.foot_contacts import thresholds_of
from tarsus.hardware.plant.settings import PlantSettings
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.hardware.transport.serial import list_ports

__all__ = ["check_servos"]

_Opener: TypeAlias = Callable[[BusSettings, int | None], Bus]
# Rates at which servos are found that were set to another one.
_RATES = (1_000_000, 57_600, 115_200, 500_000, 9_600, 38_400)
# A small motion: how far, how much of it must be seen, how long it takes [rad, s].
_STEP, _SEEN, _LASTS = math.radians(4), 0.5, 0.6
_TORQUE = 0.4
# An answer may be lost.
_TRIES = 3


def check_servos(
    calibration: Calibration,
    *,
    move: bool = False,
    open_port: _Opener | None = None,
    clock: Clock | None = None,
) -> Generator[Finding, None, None]:
    """Ask why nothing moves, and answer by measuring; yields a finding for each question.

    Parameters
    ----------
    calibration : Calibration
        A complete calibration.
    move : bool
        Whether each joint is moved by 4 deg and back, one at a time.
    open_port : callable, optional
        Opens the bus of settings at a rate; `open_bus` where left out.
    clock : Clock, optional
        The machine's.
    """
    joints = JointMap(calibration)
    for settings in calibration.buses:
        yield from _Check(calibration, joints, settings, open_port or _open, clock or SystemClock()).findings(move)


def _open(settings: BusSettings, baud: int | None) -> Bus:
    options = {"addresses": settings.addresses} if settings.addresses else {}
    return open_bus(settings.kind, settings.port, baud=baud or settings.baud, **options)


class _Check:
    """The questions about one bus."""

    def __init__(
        self, calibration: Calibration, joints: JointMap, settings: BusSettings, open_port: _Opener, clock: Clock
    ) -> None:
        self._calibration, self._joints, self._settings = calibration, joints, settings
        self._open, self._clock = open_port, clock
        self._numbers = joints.numbers(settings.name)

    def findings(self, move: bool) -> Iterator[Finding]:
        """Yield the answers, until one makes the others meaningless."""
        where = self._settings.port
        if not where:
            found = ", ".join(list_ports()) or "none"
            measured = f"the calibration names none for {self._settings.name!r}; there are: {found}"
            yield Finding(question="Does the port open?", ok=False, measured=measured, remedy="Give --port.")
            return
        try:
            bus = self._open(self._settings, None)
        except PortError as error:
            yield Finding(question="Does the port open?", ok=False, measured=error.received, remedy=error.remedy)
            return
        try:
            yield Finding(question="Does the port open?", ok=True, measured=f"{self._settings.name} on {where}")
            yield from self._of_bus(bus, move)
        except PortError as error:
            yield Finding(
                question="Does the port stay?", ok=False, measured=f"it is gone: {error.received}", remedy=error.remedy
            )
        finally:
            bus.close()

    def _of_bus(self, bus: Bus, move: bool) -> Iterator[Finding]:
        if bus.capabilities.ping != "servo":
            yield from self._of_board(bus)
            return
        found = bus.scan(self._numbers)
        alive = [number for number in self._numbers if number in found.values]
        if not alive:
            yield self._nobody(bus)
            return
        yield from self._who(bus, alive, found.errors)
        telemetry = bus.read_telemetry(alive).values
        yield from self._supply(telemetry)
        yield from self._state(telemetry)
        yield from self._positions(bus, alive)
        if move:
            yield from self._motion(bus, alive)

    def _of_board(self, bus: Bus) -> Iterator[Finding]:
        """Yield what a board that only sends pulses tells."""
        question = "Does the board answer?"
        if bus.capabilities.ping == "none":
            yield Finding(question=question, ok=None, measured="it never does")
        else:
            answer = bus.ping(self._numbers[0] if self._numbers else bus.capabilities.ids.start)
            remedy = "Check the supply of the board, its cable, and its mode: it must take commands from this port."
            if answer is None:
                yield Finding(question=question, ok=False, measured="nothing", remedy=remedy)
                return
            yield Finding(question=question, ok=True, measured=answer.name or "yes")
        yield from self._switches(bus)
        if not self._numbers:
            return
        yield Finding(
            question="Do the servos have supply, and get pulses?",
            ok=None,
            measured="a board for pulses can't tell",
            remedy=(
                "Measure the voltage between + and - of a servo's plug; the board's own supply does not feed servos. "
                "Connect the grounds of board and supply. Try the servo on another channel."
            ),
        )

    def _switches(self, bus: Bus) -> Iterator[Finding]:
        """Yield which foot switches are closed."""
        switches = self._calibration.foot_switches
        if switches is None or switches.bus != self._settings.name or not isinstance(bus, InputBoard):
            return
        question = "Do the foot switches answer?"
        legs = [(leg, number) for leg, number in enumerate(switches.inputs) if number is not None]
        try:
            levels = bus.read_inputs([number for _, number in legs])
        except PortError:
            raise
        except BusError as error:
            yield Finding(question=question, ok=False, measured=error.received, remedy=error.remedy)
            return
        names = self._calibration.robot.leg_names
        bounds, (count, highest) = (
            thresholds_of(switches, self._settings.properties),
            self._settings.properties.analogue,
        )
        side = "above" if switches.closed else "below"
        felt = []
        for (leg, number), level in zip(legs, levels, strict=True):
            volts = f" ({level * highest:.2f} V)" if number < count else ""
            own = f", threshold {sum(bounds[number]) / 2 * highest:.2f} V" if switches.thresholds else ""
            felt.append(f"{names[leg]} {level:.1f}{volts}{own}")
        bound = "its threshold" if switches.thresholds else "0.5"
        yield Finding(
            question=question,
            ok=None,
            measured=f"levels: {', '.join(felt)}; a foot is on the ground {side} {bound}",
            remedy="Press one foot after the other, and look whether its level changes.",
        )

    def _nobody(self, bus: Bus) -> Finding:
        """Return why no servo answers at all."""
        question = "Does any servo answer?"
        echo = self._echoes(bus)
        if echo:
            return Finding(
                question=question,
                ok=False,
                measured="only the echo of what is sent",
                remedy="The adapter sends but hears no servo: check the supply of the servos and the data line.",
            )
        rate = self._other_rate(bus)
        if rate is not None:
            return Finding(
                question=question,
                ok=False,
                measured=f"not at this rate, but at {rate}",
                remedy=f"Write baud = {rate} for the bus {self._settings.name!r} in the calibration.",
            )
        return Finding(
            question=question,
            ok=False,
            measured=f"none of {len(self._numbers)} at any common rate",
            remedy=(
                "Switch the supply of the servos on and measure it at a servo; then check data line and ground, and "
                "that the adapter is of the kind for these servos."
            ),
        )

    def _echoes(self, bus: Bus) -> bool:
        errors = bus.read_positions(self._numbers[:1]).errors
        return any(isinstance(error, NoAnswerError) and "echo" in error.received for error in errors)

    def _other_rate(self, bus: Bus) -> int | None:
        """Return a rate at which a servo answers; None where there is none."""
        bus.close()
        if bus_kind(self._settings.kind).transport != "serial":
            return None
        for rate in _RATES:
            try:
                other = self._open(dataclasses.replace(self._settings, baud=rate), rate)
            except BusError:
                continue
            try:
                if other.scan(self._numbers[:3]).values:
                    return rate
            except BusError:
                continue
            finally:
                other.close()
        return None

    def _who(self, bus: Bus, alive: list[int], errors: tuple[BusError, ...]) -> Iterator[Finding]:
        name, question = self._settings.name, "Do all servos answer?"
        corrupt = [error.id for error in errors if not isinstance(error, NoAnswerError) and error.id in self._numbers]
        if corrupt:
            listed = ", ".join(self._joints.describe(name, number) for number in corrupt)
            yield Finding(
                question="Has each servo an id of its own?",
                ok=False,
                measured=f"damaged answers of {listed}",
                remedy="Two servos have this id: connect them one at a time, and give one another id.",
            )
        missing = [number for number in self._numbers if number not in alive and number not in corrupt]
        if not missing:
            yield Finding(question=question, ok=not corrupt, measured=f"{len(alive)} of {len(self._numbers)}")
            return
        known = set(self._numbers)
        strangers = sorted(number for number in bus.scan(range(1, 31)).values if number not in known)
        listed = ", ".join(self._joints.describe(name, number) for number in missing)
        others = f"; ids that belong to no joint: {', '.join(map(str, strangers))}" if strangers else ""
        yield Finding(
            question=question,
            ok=False,
            measured=f"{len(alive)} of {len(self._numbers)}; missing: {listed}{others}",
            remedy=(
                "Set the ids of the strangers to the missing ones."
                if strangers
                else "Check the cable to the first that is missing: those behind it in the chain go with it."
            ),
        )

    def _supply(self, telemetry: Mapping[int, Telemetry]) -> Iterator[Finding]:
        values = telemetry.values()
        volts = [each.voltage for each in values if each.voltage is not None]
        question = "Is the supply strong enough?"
        supply = self._calibration.supply
        least = (
            supply.least_voltage
            if supply
            else max(
                (s.supply[0] for row in self._calibration.robot.servos for s in row if s is not None and s.supply),
                default=0.0,
            )
        )
        if not volts:
            yield Finding(question=question, ok=None, measured="the servos do not tell")
            return
        ok = min(volts) >= least
        yield Finding(
            question=question,
            ok=ok,
            measured=f"{min(volts):.1f} V at the servos, at least {least:.1f} V needed",
            remedy="" if ok else "Charge the battery; check its cable and plug for the current (tarsus loads).",
        )

    def _state(self, telemetry: Mapping[int, Telemetry]) -> Iterator[Finding]:
        hot = PlantSettings().hot
        wrong = [
            f"{self._joints.describe(self._settings.name, number)}: "
            + ", ".join([*each.alarms, *([f"{each.temperature:.0f} deg C"] if (each.temperature or 0) >= hot else [])])
            for number, each in telemetry.items()
            if each.alarms or (each.temperature or 0.0) >= hot
        ]
        hottest = max((each.temperature for each in telemetry.values() if each.temperature is not None), default=None)
        yield Finding(
            question="Do the servos report errors?",
            ok=not wrong,
            measured="; ".join(wrong) or f"none{'' if hottest is None else f', hottest {hottest:.0f} deg C'}",
            remedy="Let them cool and switch the supply off and on: servos let go until then." if wrong else "",
        )

    def _positions(self, bus: Bus, alive: list[int]) -> Iterator[Finding]:
        wrong = []
        for number, value in bus.read_positions(alive).values.items():
            place = self._joints.joint(self._settings.name, number)
            angle = (value - self._calibration.zeros[place]) / self._calibration.slopes[place]
            low, high = self._calibration.limits[place]
            if not low - _STEP <= angle <= high + _STEP:
                at, ends = math.degrees(angle), f"{math.degrees(low):.0f} to {math.degrees(high):.0f}"
                wrong.append(f"{self._calibration.joint_name(*place)} at {at:.0f} deg, limits {ends} deg")
        yield Finding(
            question="Are the joints within their limits?",
            ok=not wrong,
            measured="; ".join(wrong) or f"all {len(alive)}",
            remedy="Move them there by hand, or correct zero and direction (tarsus bring-up)." if wrong else "",
        )

    def _motion(self, bus: Bus, alive: list[int]) -> Iterator[Finding]:
        """Move one joint after the other by a little, and back; yield a finding for all that do not."""
        still = []
        for number in alive:
            moved = self._moved(bus, number)
            name = self._joints.describe(self._settings.name, number)
            if moved is None:
                still.append(f"{name}: no answer")
            elif moved < _SEEN * _STEP:
                still.append(f"{name}: {math.degrees(moved):.1f} of {math.degrees(_STEP):.0f} deg")
        yield Finding(
            question="Does each joint move when it is told to?",
            ok=not still,
            measured="; ".join(still) or f"all {len(alive)}",
            remedy="Free these joints and check their gears; a servo that hums and does not move is jammed or broken."
            if still
            else "",
        )

    def _moved(self, bus: Bus, number: int) -> float | None:
        """Return how far a joint moves that is told to move by a small step [rad]; None if it does not answer."""
        place = self._joints.joint(self._settings.name, number)
        slope = float(self._calibration.slopes[place])
        low, high = self._calibration.command_limits[place]
        start = _position(bus, number)
        if start is None:
            return None
        step = _STEP * abs(slope)
        goal = start + step if start + step <= high else start - step
        bus.set_torque_limit((number,), _TORQUE)
        bus.write_goals({number: round(min(max(start, low), high))})
        try:
            bus.set_torque((number,), True)
            bus.set_speed_limit((number,), step / _LASTS * 2)
            bus.write_goals({number: round(min(max(goal, low), high))})
            self._clock.sleep(_LASTS)
            end = _position(bus, number)
            bus.write_goals({number: round(min(max(start, low), high))})
            self._clock.sleep(_LASTS)
        finally:
            bus.set_torque((number,), False)
        bus.set_torque_limit((number,), 1.0)
        bus.set_speed_limit((number,), None)
        return None if end is None else abs(end - start) / abs(slope)


def _position(bus: Bus, number: int) -> float | None:
    """Return where a servo is; None if it does not answer, even when asked again."""
    for _ in range(_TRIES):
        found = bus.read_positions((number,)).values
        if found:
            return found[number]
    return None
