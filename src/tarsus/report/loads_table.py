"""Loads and servos as tables for a terminal."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tarsus.load.verdict import BURNOUT_FACTOR
from tarsus.report.tables import number

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["candidate_table", "load_bar", "load_rows", "loads_lines", "loads_table", "loads_verdict", "servo_lines"]

LOAD_COLUMNS = ("joint", "servo", "peak N m", "RMS N m", "of stall", "factor", "class", "deg/s", "line used", "heat")
"""Headings of the rows of `load_rows`; "line used" is of the torque-speed line, "heat" the RMS over 1/5 of stall."""

_BAR = 10
_EIGHTHS = " ▏▎▍▌▋▊▉█"


def load_bar(share: float | None, *, width: int = _BAR) -> str:
    """Return a bar for a share of the stall torque: full at the whole of it, with an arrow beyond; empty if unknown.

    Parameters
    ----------
    share : float or None
        The share.
    width : int
        Characters of a full bar.
    """
    if share is None:
        return ""
    if share > 1:
        return "█" * (width - 1) + "▶"
    eighths = math.ceil(share * width * 8)
    return "█" * (eighths // 8) + _EIGHTHS[eighths % 8].strip()


def load_rows(summary: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return a row of texts for each joint, under `LOAD_COLUMNS`.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.loads_summary`.
    """
    rows: list[tuple[str, ...]] = []
    for joint in summary["joints"]:
        factor = joint["factor"]
        share = None if joint["stall_nm"] is None else joint["peak_nm"] / joint["stall_nm"]
        rows.append(
            (
                f"{joint['leg']} {joint['joint']}",
                joint["servo"] or "none named",
                f"{joint['peak_nm']:.3f}",
                f"{joint['rms_nm']:.3f}",
                load_bar(share),
                "" if factor is None else f"{factor:.2f}",
                joint["class"],
                f"{math.degrees(joint['peak_speed_rad_s']):.0f}",
                _share(joint["utilisation"]),
                _share(joint["thermal_ratio"]),
            )
        )
    return rows


def _share(value: float | None) -> str:
    return "unknown" if value is None else f"{value * 100:.0f} %"


def _table(*columns: str) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, overflow="fold", justify="right" if column in _RIGHT else "left")
    return table


_RIGHT = {"peak N m", "RMS N m", "factor", "deg/s", "line used", "heat", "18 servos", "servos weigh", "robot weighs"}


def loads_table(summary: dict[str, Any]) -> Table:
    """Return what each joint bears, a row each.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.loads_summary`.
    """
    table = _table(*LOAD_COLUMNS)
    for row in load_rows(summary):
        name = row[0]
        table.add_row(*row, style="bold" if name in summary["worst"] else None)
    return table


def loads_lines(summary: dict[str, Any]) -> list[str]:
    """Return what is to be said beside the table: causes, supply, cost of transport, what is assumed.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.loads_summary`.
    """
    by_name = {f"{joint['leg']} {joint['joint']}": joint for joint in summary["joints"]}
    lines = [f"{name}: {by_name[name]['text']}; peak {by_name[name]['peak_cause']}" for name in summary["worst"]]
    drawn = summary["supply"]
    if drawn["stall_current_unknown"]:
        lines.append(f"current: unknown, for want of the stall current of {', '.join(drawn['stall_current_unknown'])}")
    else:
        battery = "" if drawn["battery_min"] is None else f"; the battery lasts {drawn['battery_min']:.0f} min"
        lines.append(f"current: {drawn['mean_a']:.1f} A on average, {drawn['peak_a']:.1f} A at its peak{battery}")
    if drawn["warning"]:
        lines.append(f"supply: {drawn['warning']}")
    lines.append(
        f"cost of transport: {number(summary['cost_of_transport'], '', digits=2)} (mechanical; "
        f"{summary['energy_j']:.2f} J over {summary['distance_m']:.3f} m)"
    )
    margin = summary["least_margin_mm"]
    if not summary["balanced"]:
        how = "lifts off the ground" if margin is None else f"tips: its load is {-margin:.1f} mm outside its feet"
        lines.append(f"the robot {how}")
    return [*lines, *(f"assumed: {text}" for text in summary["assumed"])]


def loads_verdict(summary: dict[str, Any]) -> RenderableType:
    """Return whether the servos carry the robot.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.loads_summary`.
    """
    from rich.text import Text

    worst = min(
        summary["joints"], key=lambda joint: -1.0 if joint["class"] == "unknown" else joint["factor"] or math.inf
    )
    name = f"{worst['leg']} {worst['joint']}"
    if summary["class"] == "unknown":
        return Text(f"not known: {name} has no servo in the robot file", style="bold yellow")
    if not summary["balanced"]:
        return Text(f"not carried: the robot tips; servos: {summary['class']}, by {name}", style="bold red")
    factor = "" if worst["factor"] is None else f" with factor {worst['factor']:.2f}"
    text = f"{summary['class']}: {name}{factor}"
    if not summary["carried"]:
        return Text(f"{text}; at least {BURNOUT_FACTOR:g} is needed to last", style="bold red")
    return Text(text, style="bold green" if summary["class"] == "good" else "bold yellow")


def candidate_table(summary: dict[str, Any]) -> Table:
    """Return the servos that would do, a row each, the lightest first; the mixed choice last.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.servos_summary`.
    """
    table = _table("servos that would do", "factor", "heat", "servos weigh", "robot weighs")
    for candidate in [*summary["candidates"], *([summary["mixed"]] if summary["mixed"] else [])]:
        named = candidate["name"]
        name = f"coxa / femur / tibia: {named}" if " / " in named and candidate is summary["mixed"] else named
        table.add_row(
            name,
            "" if candidate["factor"] is None else f"{candidate['factor']:.2f}",
            _share(candidate["thermal_ratio"]),
            f"{candidate['servo_mass_kg']:.3f} kg",
            f"{candidate['robot_mass_kg']:.3f} kg",
        )
    return table


def servo_lines(summary: dict[str, Any]) -> list[str]:
    """Return what is to be said beside the table: verdicts, payload, lengths, what was left out, what is assumed.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.loads_summary.servos_summary`.
    """
    lines = [f"payload: {_payload(summary)}"]
    lines += [f"length: {text}" for text in summary["advice"]]
    lines += [f"not tried: {name}, as {reason}" for name, reason in summary["left_out"].items()]
    return [*lines, *(f"assumed: {text}" for text in summary["assumed"])]


def _payload(summary: dict[str, Any]) -> str:
    most, utmost = summary["payload_carried_kg"], summary["payload_before_burning_kg"]
    if most is None:
        return "unknown, as not all servos are named in the robot file"
    asked = f"factor {summary['safety_factor']:g}" if summary["rule"] == "factor" else "the rule for lasting loads"
    return f"{most:.2f} kg with {asked}, {utmost:.2f} kg before the servos stall or burn"
