"""Numbers as tables for a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["angle_table", "number", "robot_table", "source_table", "verdict", "walk_table"]

_UNKNOWN = "unknown"


def number(value: float | None, unit: str, *, digits: int = 1) -> str:
    """Return a number with its unit, or that it is unknown.

    Parameters
    ----------
    value : float or None
        The number.
    unit : str
        Its unit.
    digits : int
        Digits after the point.
    """
    return _UNKNOWN if value is None else f"{value:.{digits}f} {unit}".rstrip()


def _table(*columns: str, header: bool = True) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD if header else None, show_header=header, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, overflow="fold")
    return table


def walk_table(summary: dict[str, Any]) -> Table:
    """Return a walk's numbers as a table of two columns.

    Parameters
    ----------
    summary : dict
        From `tarsus.report.walk_summary.walk_summary`.
    """
    end, margin, feet = summary["end"], summary["least_margin"], summary["nearest_feet"]
    table = _table("what", "how much", header=False)
    table.add_row("robot", summary["robot"])
    table.add_row("gait", f"{summary['gait']}, each foot down for {summary['duty_factor'] * 100:.0f} % of the cycle")
    table.add_row("ends at", f"x {end['x_mm']:.1f} mm, y {end['y_mm']:.1f} mm, turned {end['turned_deg']:.1f} deg")
    table.add_row("duration", f"{summary['duration_s']:.2f} s, {summary['steps']} steps")
    table.add_row("stroke", f"{summary['stroke_mm']:.1f} mm at {summary['speed_mm_s']:.1f} mm/s")
    table.add_row("cycle time", number(summary["cycle_time_s"], "s", digits=3))
    table.add_row(
        "body_height", f"{summary['body_height_mm']:.1f} mm, feet lifted by {summary['swing_height_mm']:.1f} mm"
    )
    for joint, speed in summary["joint_speed"].items():
        table.add_row(f"fastest {joint}", _joint_speed(speed))
    table.add_row("least margin", _least_margin(margin))
    table.add_row("nearest feet", f"{feet['mm']:.1f} mm, {' and '.join(feet['legs'])} at {feet['at_s']:.2f} s")
    for assumed in summary["assumed"]:
        table.add_row("assumed", assumed)
    return table


def _least_margin(margin: dict[str, Any]) -> str:
    if margin["mm"] == float("-inf"):
        return f"none at {margin['at_s']:.2f} s: no foot is on the ground"
    return f"{margin['mm']:.1f} mm at {margin['at_s']:.2f} s"


def _joint_speed(speed: dict[str, Any]) -> str:
    text = f"{speed['deg_s']:.0f} deg/s ({speed['leg']})"
    if speed["share_of_no_load"] is None:
        return f"{text}; speed of the servo unknown"
    return f"{text}; {speed['share_of_no_load'] * 100:.0f} % of what {speed['servo']} does without load"


def verdict(summary: dict[str, Any]) -> RenderableType:
    """Return whether all of it is possible, and if not, why.

    Parameters
    ----------
    summary : dict
        With `possible` and `problems`.
    """
    from rich.text import Text

    if summary["possible"]:
        return Text("possible", style="bold green")
    text = Text("not possible", style="bold red")
    for problem in summary["problems"]:
        text.append(f"\n  {problem}", style="not bold default")
    return text


def angle_table(summary: dict[str, Any]) -> Table:
    """Return the angles of every leg, and whether it reaches its foothold where that is known.

    Parameters
    ----------
    summary : dict
        With `legs`, `joints`, `angles_deg` and perhaps `reach`.
    """
    table = _table("leg", *(f"{joint} deg" for joint in summary["joints"]), *(["reach"] if "reach" in summary else []))
    for column in table.columns[1:4]:
        column.justify = "right"
    reach = summary.get("reach", [None] * len(summary["legs"]))
    for leg, angles, code in zip(summary["legs"], summary["angles_deg"], reach, strict=True):
        table.add_row(leg, *(f"{round(angle, 2) + 0.0:.2f}" for angle in angles), *([code] if code else []))
    return table


def robot_table(summaries: list[dict[str, Any]]) -> Table:
    """Return robots with their sizes, masses and servos, a row each.

    Parameters
    ----------
    summaries : list of dict
        From `tarsus.report.robot_summary.robot_summary`.
    """
    table = _table("robot", "legs", "coxa, femur, tibia mm", "body mm", "mass", "servos", "gait")
    for robot in summaries:
        lengths = ", ".join(_value(robot[f"{joint}_mm"]) for joint in ("coxa", "femur", "tibia"))
        body = _UNKNOWN if robot["body_mm"] is None else " x ".join(f"{size:g}" for size in robot["body_mm"])
        mass, servos = number(robot["mass_kg"], "kg", digits=2), ", ".join(robot["servos"]) or _UNKNOWN
        table.add_row(robot["name"], str(robot["legs"]), lengths, body, mass, servos, robot["gait"])
    return table


def _value(value: Any) -> str:
    """Return a value of a robot file as it would stand there."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value(item)}" for key, item in value.items())
    if isinstance(value, list):
        return f"[{', '.join(_value(item) for item in value)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def source_table(rows: list[dict[str, Any]]) -> Table:
    """Return every number of a robot with the number of its source and how sure it is.

    Parameters
    ----------
    rows : list of dict
        From `tarsus.report.robot_summary.dimensions`.
    """
    table = _table("key", "value", "sure", "source")
    for row in rows:
        place = "none named" if row["source_number"] is None else f"({row['source_number']})"
        table.add_row(row["key"], _value(row["value"]), row["confidence"] or _UNKNOWN, place)
    return table
