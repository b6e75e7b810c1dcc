"""`tarsus check-servos`: why nothing moves."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.signals import as_interrupts
from tarsus.cli.values import examples, json_option

__all__ = ["check_servos"]


@click.command(
    "check-servos",
    short_help="Nothing moves: find out why.",
    epilog=examples(
        "tarsus check-servos my-strider.toml --emulated",
        "tarsus check-servos my-strider.toml --emulated --json",
    ),
)
@click.argument("calibration", type=click.Path(path_type=Path))
@click.option("--port", metavar="PORT", help="Port of the robot.  [default: that of the calibration]")
@click.option("--move", is_flag=True, help="Also move each joint by 4 deg and back; keep the legs free.")
@click.option("--emulated", is_flag=True, help="Check emulated servos of this calibration.")
@json_option
def check_servos(calibration: Path, port: str | None, move: bool, emulated: bool, as_json: bool) -> int:
    """Find out why nothing moves: port, ids, supply, errors and positions of the servos of CALIBRATION.

    Each question is answered by measuring; it ends with the first one after which the others mean nothing. The exit
    code is 0 only if nothing is wrong.
    """
    import contextlib

    import numpy as np
    from rich.text import Text

    from tarsus.hardware.calibration.calibration import Calibration
    from tarsus.hardware.diagnosis.check_servos import check_servos as findings_of
    from tarsus.hardware.live.emulated_robot import EmulatedRobot

    found = Calibration.load(calibration)
    found.require_complete()
    if port:
        found = found.replace(buses=(dataclasses.replace(found.buses[0], port=port), *found.buses[1:]))
    findings = []
    with as_interrupts(), contextlib.ExitStack() as stack:
        opener = None
        if emulated:
            robot = stack.enter_context(EmulatedRobot(found, np.asarray(found.limits).mean(axis=-1)))
            found, opener = robot.calibration, robot.open
        # Closing the generator of the findings releases the servos, also where the loop ends early.
        for finding in stack.enter_context(contextlib.closing(findings_of(found, move=move, open_port=opener))):
            findings.append(finding)
            if not as_json:
                mark, colour = {True: ("yes", "green"), False: ("NO ", "red"), None: ("?  ", "yellow")}[finding.ok]
                show(Text.assemble((mark, colour), f"  {finding.question} {finding.measured}"))
                if finding.remedy:
                    show(f"     {finding.remedy}")
    ok = all(finding.ok is not False for finding in findings)
    if as_json:
        print_json({"calibration": str(calibration), "ok": ok, "findings": [vars(each) for each in findings]})
    return 0 if ok else 1
