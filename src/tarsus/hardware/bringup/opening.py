"""The buses of a bring-up: on the ports of this machine, or emulated."""

from __future__ import annotations

from pathlib import Path

from tarsus.hardware.bringup.beginning import EMULATED, ports_of
from tarsus.hardware.bringup.dialogue import Dialogue
from tarsus.hardware.bringup.emulated_machine import EmulatedMachine
from tarsus.hardware.bringup.wizard import BringUp
from tarsus.hardware.bus import registry
from tarsus.hardware.bus.protocol import Bus
from tarsus.hardware.calibration.calibration import Calibration
from tarsus.hardware.calibration.parts import BusSettings
from tarsus.hardware.transport.clock import Clock

__all__ = ["bring_up_of", "emulated_machine_of"]


def emulated_machine_of(calibration: Calibration, *, clock: Clock | None = None) -> EmulatedMachine | None:
    """Return the emulated machine to which a calibration belongs; None for a real one.

    Parameters
    ----------
    calibration : Calibration
        As far as it is known.
    clock : Clock, optional
        Of the emulated servos.
    """
    settings = calibration.buses[0]
    return EmulatedMachine(calibration.robot, settings.kind, clock=clock) if settings.port == EMULATED else None


def bring_up_of(
    calibration: Calibration,
    path: Path,
    dialogue: Dialogue,
    *,
    emulated: EmulatedMachine | None = None,
    clock: Clock | None = None,
) -> BringUp:
    """Return the bring-up of a machine.

    Parameters
    ----------
    calibration : Calibration
        As far as it is known.
    path : Path
        Where it is saved after every answer.
    dialogue : Dialogue
        Who answers the questions.
    emulated : EmulatedMachine, optional
        Emulated servos, instead of those on the ports of this machine.
    clock : Clock, optional
        The machine's.
    """

    def open_bus(settings: BusSettings) -> Bus:
        if emulated is not None:
            return emulated.open(settings.kind, settings.port)
        return registry.open_bus(settings.kind, settings.port, baud=settings.baud)

    kind = calibration.buses[0].kind
    return BringUp(calibration, path, dialogue, open_bus=open_bus, ports=lambda: ports_of(kind), clock=clock)
