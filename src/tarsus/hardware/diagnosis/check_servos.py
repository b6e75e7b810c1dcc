"""The decision tree: port, servos, supply, state, motion; it ends where further answers would mean nothing."""

from __future__ import annotations

from collections.abc import Generator, Iterator

from tarsus.errors import PortError
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.bus.registry import open_bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.diagnosis.board import check_board
from tarsus.hardware.diagnosis.condition import check_condition
from tarsus.hardware.diagnosis.finding import Finding
from tarsus.hardware.diagnosis.motion import check_motion
from tarsus.hardware.diagnosis.presence import check_presence, why_nobody_answers
from tarsus.hardware.diagnosis.subject import Opener, Subject
from tarsus.hardware.plant.joint_map import JointMap
from tarsus.hardware.transport.clock import Clock, SystemClock
from tarsus.hardware.transport.serial import list_ports

__all__ = ["check_servos"]


def check_servos(
    calibration: Calibration,
    *,
    move: bool = False,
    open_port: Opener | None = None,
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
        Opens the bus that settings describe, at a baud rate; `open_bus` where left out.
    clock : Clock, optional
        The machine's.
    """
    joints = JointMap(calibration)
    for settings in calibration.buses:
        subject = Subject(
            calibration=calibration,
            joints=joints,
            settings=settings,
            open_port=open_port or _open,
            clock=clock or SystemClock(),
        )
        yield from _findings(subject, move)


def _open(settings: BusSettings, baud: int | None) -> Bus:
    options = {"addresses": settings.addresses} if settings.addresses else {}
    return open_bus(settings.kind, settings.port, baud=baud or settings.baud, **options)


def _findings(subject: Subject, move: bool) -> Iterator[Finding]:
    """Yield the answers, until one makes the others meaningless."""
    where = subject.settings.port
    if not where:
        found = ", ".join(list_ports()) or "none"
        measured = f"the calibration names none for {subject.settings.name!r}; there are: {found}"
        yield Finding(question="Does the port open?", ok=False, measured=measured, remedy="Give --port.")
        return
    try:
        bus = subject.open_port(subject.settings, None)
    except PortError as error:
        yield Finding(question="Does the port open?", ok=False, measured=error.received, remedy=error.remedy)
        return
    try:
        yield Finding(question="Does the port open?", ok=True, measured=f"{subject.settings.name} on {where}")
        yield from _of_bus(subject, bus, move)
    except PortError as error:
        yield Finding(
            question="Does the port stay?", ok=False, measured=f"it is gone: {error.received}", remedy=error.remedy
        )
    finally:
        bus.close()


def _of_bus(subject: Subject, bus: Bus, move: bool) -> Iterator[Finding]:
    if bus.capabilities.ping != "servo":
        yield from check_board(subject, bus)
        return
    found = bus.scan(subject.numbers)
    alive = [number for number in subject.numbers if number in found.values]
    if not alive:
        yield why_nobody_answers(subject, bus)
        return
    yield from check_presence(subject, bus, alive, found.errors)
    yield from check_condition(subject, bus, alive)
    if move:
        yield check_motion(subject, bus, alive)
