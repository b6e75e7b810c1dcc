"""Terminal tables of joint loads and servo sizing."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tarsus.load.verdict import BURNOUT_FACTOR, class_of, severity_of
from tarsus.report.tables import number, table_of

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = [
    "LEGEND",
    "LOAD_COLUMNS",
    "SERVO_LEGEND",
    "SEVERITY_STYLES",
    "candidate_table",
    "change_table",
    "is_worst",
    "load_bar",
    "load_rows",
    "loads_lines",
    "loads_table",
    "loads_verdict",
    "motion_line",
    "on_estimates",
    "servo_lines",
]

LOAD_COLUMNS = (
    "joint",
    "servo",
    "peak N m",
    "pressed",
    "RMS N m",
    "of stall",
    "factor",
    "class",
    "deg/s",
    "utilisation",
    "thermal",
)
"""Column headers of `load_rows`; `LEGEND` explains them."""

_FACTOR = "stall torque over peak torque (below 1 cannot stand, below 1.5 stalls or burns, below 3 marginal)"
_THERMAL = "RMS torque over 1/5 of the stall torque, the limit of continuous load"
LEGEND = (
    "pressed: peak torque by compliant statics, in which the feet press against each other through friction",
    "of stall: the higher peak torque over stall torque, full at 100 %",
    f"factor: {_FACTOR}",
    "utilisation: peak load relative to the servo's torque-speed line, from stall torque to no-load speed",
    f"thermal: {_THERMAL}",
)
"""What the columns mean, a line for each."""

SERVO_LEGEND = (
    "servos: one for all joints, or those of coxa / femur / tibia, on one bus and at one supply voltage",
    f"factor: smallest {_FACTOR}",
    f"thermal: largest {_THERMAL}",
)
"""What the columns of `change_table` and `candidate_table` mean, a line for each."""

SEVERITY_STYLES = {"good": "green", "warning": "yellow", "bad": "red"}
"""Colour of each severity in the terminal."""

_ALL_LEGS = "all legs"
_CLASS = LOAD_COLUMNS.index("class")
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
    """Return a row of text for each joint, with the columns `LOAD_COLUMNS`; one row for all legs where they are equal.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    rows = [(joint["joint"], _row(joint)) for joint in summary["joints"]]
    texts: dict[str, set[tuple[str, ...]]] = {}
    for name, row in rows:
        texts.setdefault(name, set()).add(row[1:])
    merged = {name: f"{_ALL_LEGS} {name}" for name, found in texts.items() if len(found) == 1}
    return list(dict.fromkeys((merged.get(name, row[0]), *row[1:]) for name, row in rows))


def is_worst(row: tuple[str, ...], summary: dict[str, Any]) -> bool:
    """Return whether a row of `load_rows` shows the smallest factor of all coxae, femurs or tibiae.

    Parameters
    ----------
    row : tuple of str
        The row.
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    return row[0] in summary["worst"] or row[0].startswith(_ALL_LEGS)


def _row(joint: dict[str, Any]) -> tuple[str, ...]:
    pressed = joint["compliant_peak_nm"]
    fraction = None if joint["stall_nm"] is None else max(joint["peak_nm"], pressed or 0.0) / joint["stall_nm"]
    return (
        f"{joint['leg']} {joint['joint']}",
        joint["servo"] or "none",
        f"{joint['peak_nm']:.3f}",
        "unknown" if pressed is None else f"{pressed:.3f}",
        f"{joint['rms_nm']:.3f}",
        load_bar(fraction),
        _factor(joint),
        joint["class"],
        f"{math.degrees(joint['peak_speed_rad_s']):.0f}",
        _percent(joint["utilisation"]),
        _percent(joint["thermal_ratio"]),
    )


def _factor(joint: dict[str, Any]) -> str:
    """Return the safety factor as text; a servo without load has none, and it is empty for an unknown servo."""
    if joint["factor"] is None:
        return "" if joint["stall_nm"] is None else "no load"
    return f"{joint['factor']:.2f}"


def _percent(value: float | None) -> str:
    return "unknown" if value is None else f"{value * 100:.0f} %"


# Payloads below this are reported as none [kg].
_NO_PAYLOAD = 0.005
_RIGHT = {
    "supply",
    "peak N m",
    "pressed",
    "RMS N m",
    "factor",
    "deg/s",
    "utilisation",
    "thermal",
    "servos kg",
    "robot kg",
}


def loads_table(summary: dict[str, Any]) -> Table:
    """Return a table of the joint loads, with a row for each joint.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    table = table_of(*LOAD_COLUMNS, right=_RIGHT)
    from rich.text import Text

    for row in load_rows(summary):
        cells: list[str | Text] = list(row)
        cells[_CLASS] = Text(row[_CLASS], style=SEVERITY_STYLES[severity_of(row[_CLASS])])
        table.add_row(*cells, style="bold" if is_worst(row, summary) else None)
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
    lines += _compliant_lines(summary)
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


def _compliant_lines(summary: dict[str, Any]) -> list[str]:
    """Return lines on compliant statics: its problems, or why it was not computed."""
    if summary["compliant"] is None:
        return [f"compliant statics: not computed: {summary['compliant_missing']}"]
    return [f"compliant statics: {text}" for text in summary["compliant"]["problems"]]


def motion_line(summary: dict[str, Any]) -> str:
    """Return whether the walk itself is possible, apart from its servos.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    """
    return "walk: possible" if summary["possible"] else f"walk: not possible: {'; '.join(summary['problems'])}"


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
        why = f"{name}: {worst['text']}" if worst["servo"] else f"the robot file names no servo for {name}"
        return Text(f"unknown: {why}", style=_style("unknown"))
    if not summary["balanced"]:
        return Text(f"not carried: the robot tips; servos: {summary['class']} ({name}){estimates}", style="bold red")
    factor = "" if worst["factor"] is None else f", safety factor {worst['factor']:.2f}"
    text = f"{summary['class']}: {name}{factor}"
    if not summary["carried"]:
        return Text(f"{text}; at least {BURNOUT_FACTOR:g} is required{estimates}", style="bold red")
    return Text(f"{text}{estimates}", style=_style(summary["class"]))


def on_estimates(summary: dict[str, Any]) -> str:
    """Return the words that qualify a verdict on estimated masses or servos; empty without estimates.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary` or `servos_summary`.
    """
    return f" (with estimated {', '.join(summary['estimated'])})" if summary["estimated"] else ""


def _style(class_name: str) -> str:
    return f"bold {SEVERITY_STYLES[severity_of(class_name)]}"


def change_table(summary: dict[str, Any]) -> Table:
    """Return a table of the changes of the walk that relieve the robot's servos, the most effective first.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.servos_summary`.
    """
    table = table_of("changes for the robot's servos", "factor", "thermal", right=_RIGHT)
    for change in summary["changes"]:
        style = SEVERITY_STYLES[severity_of(class_of(change["factor"]))]
        table.add_row(change["text"], f"{change['factor']:.2f}", _percent(change["thermal_ratio"]), style=style)
    return table


def candidate_table(summary: dict[str, Any]) -> Table:
    """Return a table of sufficient servos, the lightest first: one for all joints, or a set for one bus and supply.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.loads_summary.servos_summary`.
    """
    table = table_of("sufficient servos", "bus", "supply", "factor", "thermal", "servos kg", "robot kg", right=_RIGHT)
    rows = [*summary["candidates"], *summary["sets"]]
    for candidate in sorted(rows, key=lambda row: row["servo_mass_kg"]):
        table.add_row(
            candidate["name"],
            candidate["bus"],
            number(candidate["supply_v"], "V"),
            "" if candidate["factor"] is None else f"{candidate['factor']:.2f}",
            _percent(candidate["thermal_ratio"]),
            f"{candidate['servo_mass_kg']:.3f}",
            f"{candidate['robot_mass_kg']:.3f}",
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
    by_reason: dict[str, list[str]] = {}
    for name, reason in summary["excluded"].items():
        by_reason.setdefault(reason, []).append(name)
    lines += [f"not evaluated, as {reason}: {', '.join(names)}" for reason, names in by_reason.items()]
    return [*lines, *(f"assumed: {text}" for text in summary["assumed"])]


def _payload(summary: dict[str, Any]) -> str:
    largest, maximum = summary["largest_payload_kg"], summary["maximum_payload_kg"]
    if largest is None:
        return "unknown, as the torque of some servos is unknown"
    rule = f"factor {summary['safety_factor']:g}" if summary["rule"] == "factor" else "the continuous load limit"
    limit = f"the limit, factor {BURNOUT_FACTOR:g}, below which servos stall or burn"
    at_limit = f"none at {limit}" if maximum < _NO_PAYLOAD else f"{maximum:.2f} kg at {limit}"
    return f"{'none' if largest < _NO_PAYLOAD else f'{largest:.2f} kg'} at {rule}; {at_limit}"
