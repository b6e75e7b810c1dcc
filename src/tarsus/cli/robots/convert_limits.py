"""`tarsus robots convert-limits`: joint limits of common firmware as those of a robot file."""

from __future__ import annotations

from typing import Any

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import Numbers, examples, json_option, number_option

__all__ = ["convert_limits"]

_LIMITS = Numbers("LOW", "HIGH")


@click.command(
    "convert-limits",
    epilog=examples(
        "tarsus robots convert-limits phoenix --coxa -65,65 --femur -105,75 --tibia -53,90",
        "tarsus robots convert-limits lynxmotion --side right --unit tenths --femur -1010,950 --tibia -1060,770",
        "tarsus robots convert-limits phantomx --unit ticks --coxa 256,768",
        "tarsus robots convert-limits freenove --coxa 0,180 --femur 10,170 --tibia 0,150 --side right",
    ),
)
@click.argument("firmware", metavar="FIRMWARE")
@click.option("--coxa", type=_LIMITS, metavar="LOW,HIGH", help="Limits of the coxa.")
@click.option("--femur", type=_LIMITS, metavar="LOW,HIGH", help="Limits of the femur.")
@click.option("--tibia", type=_LIMITS, metavar="LOW,HIGH", help="Limits of the tibia.")
@click.option("--side", type=click.Choice(["left", "right"]), help="Side of the leg.  [default: both]")
@click.option(
    "--unit", default="deg", show_default=True, help="deg, tenths (of a degree), us (pulse width) or ticks (AX-12)."
)
@number_option("--femur-horn", "DEG", "Offset of the femur's servo horn, cFemurHornOffset1 / 10.")
@number_option("--tibia-horn", "DEG", "Offset of the tibia's servo horn, cTibiaHornOffset1 / 10.")
@json_option
def convert_limits(
    firmware: str,
    side: str | None,
    unit: str,
    femur_horn: float | None,
    tibia_horn: float | None,
    as_json: bool,
    **limits: tuple[float, float] | None,
) -> int:
    """Convert the joint limits of FIRMWARE to limits_deg of a robot file.

    FIRMWARE is phoenix (angles of the Phoenix code), lynxmotion (its configuration for the Lynxmotion Phoenix, where
    the right legs have the signs of the servos), phantomx (its configuration for AX-12 servos) or freenove (angles of
    the servos, 0 to 180).
    """
    from tarsus.robot.firmware import SIDES
    from tarsus.robot.firmware import convert_limits as converted

    given = {joint: pair for joint, pair in limits.items() if pair is not None}
    if not given:
        raise click.UsageError("give the limits of at least one joint: --coxa, --femur or --tibia")
    horns = {"femur": femur_horn, "tibia": tibia_horn}
    sides: dict[str, dict[str, list[float]]] = {
        one: {
            joint: [
                round(angle, 2)
                for angle in converted(firmware, joint, pair, side=one, unit=unit, horn=horns.get(joint))
            ]
            for joint, pair in given.items()
        }
        for one in (SIDES if side is None else [side])
    }
    if as_json:
        print_json({"firmware": firmware, "unit": unit, **{one: {"limits_deg": sides[one]} for one in sides}})
        return 0
    alike = len({str(table) for table in sides.values()}) == 1
    for one, table in sides.items():
        show(*([] if alike else [f"# {one} legs"]), _toml(table))
        if alike:
            break
    return 0


def _toml(table: dict[str, Any]) -> str:
    pairs = (f"{joint} = [{low:g}, {high:g}]" for joint, (low, high) in table.items())
    return f"limits_deg = {{ {', '.join(pairs)} }}"
