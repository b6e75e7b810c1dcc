"""Terminal tables of joint loads and servo sizing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tarsus.load.verdict import BURNOUT_FACTOR
from tarsus.report.tables import number, table_of

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = [
    "candidate_table",
    "load_bar",
    "load_rows",
    "loads_lines",
    "loads_table",
    "loads_verdict",
    "on_estimates",
    "servo_lines",
]

LOAD_COLUMNS = (
    "joint",
    "servo",
    "peak N m",
    "RMS N m",
    "of stall",
    "factor",
    "class",
    "deg/s",
    "utilisation",
    "thermal",
)
"""Column headers of `load_rows`; "utilisation" is of the torque-speed line, "thermal" the RMS over 1/5 of stall."""

_BAR = 10
_EIGHTHS = " ▏▎▍▌▋▊▉█"


def load_bar(fraction: float | None, *, width: int = _BAR) -> str:
    """Return a text bar for a fraction of the stall torque: full at 1, with an arrow above; empty if unknown.

    Parameters
    ----------
    fraction : float or None
        The fraction.
    width : int
        Length of a full bar [characters].
    """
    if fraction is None:
        return ""
    if fraction > 1:
        return "█" * (width - 1) + "▶"
    eighths = math.ceil(fraction * width * 8)
    return "█" * (eighths // 8) + _EIGHTHS[eighths % 8].strip()


def load_rows(summary: dict[str, Any]) -> list[tuple[str, ...]]:
    """Return a row of text for each joint, with the columns `LOAD_COLUMNS`.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    rows: list[tuple[str, ...]] = []
    for joint in summary["joints"]:
        factor = joint["factor"]
        fraction = None if joint["stall_nm"] is None else joint["peak_nm"] / joint["stall_nm"]
        rows.append(
            (
                f"{joint['leg']} {joint['joint']}",
                joint["servo"] or "none",
                f"{joint['peak_nm']:.3f}",
                f"{joint['rms_nm']:.3f}",
                load_bar(fraction),
                "" if factor is None else f"{factor:.2f}",
                joint["class"],
                f"{math.degrees(joint['peak_speed_rad_s']):.0f}",
                _percent(joint["utilisation"]),
                _percent(joint["thermal_ratio"]),
            )
        )
    return rows


def _percent(value: float | None) -> str:
    return "unknown" if value is None else f"{value * 100:.0f} %"


_RIGHT = {"peak N m", "RMS N m", "factor", "deg/s", "utilisation", "thermal", "servo mass", "robot mass"}


def loads_table(summary: dict[str, Any]) -> Table:
    """Return a table of the joint loads, with a row for each joint.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    table = table_of(*LOAD_COLUMNS, right=_RIGHT)
    for row in load_rows(summary):
        name = row[0]
        table.add_row(*row, style="bold" if name in summary["worst"] else None)
    return table


def loads_lines(summary: dict[str, Any]) -> list[str]:
    """Return the lines below the table: verdicts and causes, supply, cost of transport, assumptions.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    by_name = {f"{joint['leg']} {joint['joint']}": joint for joint in summary["joints"]}
    lines = [f"{name}: {by_name[name]['text']}; peak {by_name[name]['peak_cause']}" for name in summary["worst"]]
    supply = summary["supply"]
    if supply["stall_current_unknown"]:
        lines.append(
            f"current: unknown, as the stall current of {', '.join(supply['stall_current_unknown'])} is unknown"
        )
    else:
        battery = "" if supply["battery_min"] is None else f"; battery life {supply['battery_min']:.0f} min"
        lines.append(f"current: mean {supply['mean_a']:.1f} A, peak {supply['peak_a']:.1f} A{battery}")
    if supply["warning"]:
        lines.append(f"supply: {supply['warning']}")
    lines.append(
        f"cost of transport: {number(summary['cost_of_transport'], '', digits=2)} (mechanical: "
        f"{summary['energy_j']:.2f} J over {summary['distance_m']:.3f} m)"
    )
    margin = summary["least_margin_mm"]
    if not summary["balanced"]:
        how = "loses contact" if margin is None else f"tips: the load is {-margin:.1f} mm outside the support polygon"
        lines.append(f"the robot {how}")
    return [*lines, *(f"assumed: {text}" for text in summary["assumed"])]


def loads_verdict(summary: dict[str, Any]) -> RenderableType:
    """Return the verdict on the servos in a line.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    from rich.text import Text

    estimates = on_estimates(summary)
    worst = min(
        summary["joints"], key=lambda joint: -1.0 if joint["class"] == "unknown" else joint["factor"] or math.inf
    )
    name = f"{worst['leg']} {worst['joint']}"
    if summary["class"] == "unknown":
        return Text(f"unknown: the robot file names no servo for {name}", style="bold yellow")
    if not summary["balanced"]:
        return Text(f"not carried: the robot tips; servos: {summary['class']} ({name}){estimates}", style="bold red")
    factor = "" if worst["factor"] is None else f", safety factor {worst['factor']:.2f}"
    text = f"{summary['class']}: {name}{factor}"
    if not summary["carried"]:
        return Text(f"{text}; at least {BURNOUT_FACTOR:g} is required{estimates}", style="bold red")
    return Text(f"{text}{estimates}", style="bold green" if summary["class"] == "good" else "bold yellow")


def on_estimates(summary: dict[str, Any]) -> str:
    """Return the words that qualify a verdict on estimated masses or servos; empty without estimates.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary` or `servos_summary`.
    """
    return f" (with estimated {', '.join(summary['estimated'])})" if summary["estimated"] else ""


def candidate_table(summary: dict[str, Any]) -> Table:
    """Return a table of the sufficient servos, the lightest first; the mixed choice last.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.servos_summary`.
    """
    table = table_of("sufficient servos", "factor", "thermal", "servo mass", "robot mass", right=_RIGHT)
    for candidate in [*summary["candidates"], *([summary["mixed"]] if summary["mixed"] else [])]:
        named = candidate["name"]
        name = f"coxa / femur / tibia: {named}" if " / " in named and candidate is summary["mixed"] else named
        table.add_row(
            name,
            "" if candidate["factor"] is None else f"{candidate['factor']:.2f}",
            _percent(candidate["thermal_ratio"]),
            f"{candidate['servo_mass_kg']:.3f} kg",
            f"{candidate['robot_mass_kg']:.3f} kg",
        )
    return table


def servo_lines(summary: dict[str, Any]) -> list[str]:
    """Return the lines below the table: payload, link lengths, excluded servos, assumptions.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.servos_summary`.
    """
    lines = [f"payload: {_payload(summary)}"]
    lines += [f"length: {text}" for text in summary["advice"]]
    lines += [f"excluded: {name}, as {reason}" for name, reason in summary["excluded"].items()]
    return [*lines, *(f"assumed: {text}" for text in summary["assumed"])]


def _payload(summary: dict[str, Any]) -> str:
    largest, maximum = summary["largest_payload_kg"], summary["maximum_payload_kg"]
    if largest is None:
        return "unknown, as the robot file does not name all servos"
    rule = f"factor {summary['safety_factor']:g}" if summary["rule"] == "factor" else "the continuous load limit"
    return f"{largest:.2f} kg with {rule}, at most {maximum:.2f} kg before servos stall or burn"
