"""Terminal tables."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from tarsus.kinematics.reach import Reach

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["angle_table", "gait_table", "number", "robot_table", "source_table", "table_of", "verdict", "walk_table"]

_UNKNOWN = "unknown"


def number(value: float | None, unit: str, *, digits: int = 1) -> str:
    """Format a number with its unit, or "unknown".

    Parameters
    ----------
    value : float or None
        The number.
    unit : str
        Unit.
    digits : int
        Digits after the decimal point.
    """
    return _UNKNOWN if value is None else f"{value:.{digits}f} {unit}".rstrip()


def table_of(*columns: str, header: bool = True, right: Collection[str] = ()) -> Table:
    """Return an empty table in the style of all tables.

    Parameters
    ----------
    *columns : str
        Headers of the columns.
    header : bool
        Whether to show them.
    right : collection of str
        Headers of the columns that are aligned at the right.
    """
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD if header else None, show_header=header, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, overflow="fold", justify="right" if column in right else "left")
    return table


def walk_table(summary: dict[str, Any]) -> Table:
    """Return the numbers of a walk as a table with two columns.

    Parameters
    ----------
    summary : dict
        Summary from `tarsus.report.walk_summary.walk_summary`.
    """
    end, margin, feet = summary["end"], summary["least_margin"], summary["nearest_feet"]
    table = table_of("quantity", "value", header=False)
    table.add_row("robot", summary["robot"])
    table.add_row("gait", f"{summary['gait']}, duty factor {summary['duty_factor']:.3g}")
    table.add_row("end", f"x {end['x_mm']:z.1f} mm, y {end['y_mm']:z.1f} mm, yaw {end['turned_deg']:z.1f} deg")
    table.add_row("duration", f"{summary['duration_s']:.2f} s, {summary['steps']} steps")
    table.add_row("stroke", f"{summary['stroke_mm']:.1f} mm at {summary['speed_mm_s']:.1f} mm/s")
    table.add_row("cycle time", number(summary["cycle_time_s"], "s", digits=3))
    table.add_row("body height", f"{summary['body_height_mm']:.1f} mm")
    table.add_row("swing height", f"{summary['swing_height_mm']:.1f} mm")
    for joint, speed in summary["joint_speed"].items():
        table.add_row(f"{joint} speed", _joint_speed(speed))
    table.add_row("stability margin", _least_margin(margin))
    table.add_row("foot distance", f"{feet['mm']:.1f} mm, {' and '.join(feet['legs'])} at {feet['at_s']:.2f} s")
    for assumed in summary["assumed"]:
        table.add_row("assumed", assumed)
    return table


def _least_margin(margin: dict[str, Any]) -> str:
    if margin["mm"] == float("-inf"):
        return f"none at {margin['at_s']:.2f} s: no foot on the ground"
    return f"minimum {margin['mm']:.1f} mm at {margin['at_s']:.2f} s"


def _joint_speed(speed: dict[str, Any]) -> str:
    text = f"peak {speed['deg_s']:.0f} deg/s ({speed['leg']}); {speed['limit_fraction'] * 100:.0f} % of"
    if speed["no_load_deg_s"] is None:
        return f"{text} {speed['limit_deg_s']:.0f} deg/s, as the no-load speed is unknown"
    return f"{text} the no-load speed of {speed['servo']}"


def verdict(summary: dict[str, Any]) -> RenderableType:
    """Return whether the request is possible, with the problems if not.

    Parameters
    ----------
    summary : dict
        Summary with `possible` and `problems`.
    """
    from rich.text import Text

    if summary["possible"]:
        return Text("possible", style="bold green")
    text = Text("not possible", style="bold red")
    for problem in summary["problems"]:
        text.append(f"\n  {problem}", style="not bold default")
    return text


def angle_table(summary: dict[str, Any]) -> Table:
    """Return a table of the joint angles, with the reach of each leg if known.

    Parameters
    ----------
    summary : dict
        Summary with `legs`, `joints`, `angles_deg` and optionally `reach`.
    """
    joints = [f"{joint} deg" for joint in summary["joints"]]
    table = table_of("leg", *joints, *(["reach"] if "reach" in summary else []), right=joints)
    reach = summary.get("reach", [None] * len(summary["legs"]))
    for leg, angles, code in zip(summary["legs"], summary["angles_deg"], reach, strict=True):
        table.add_row(leg, *(f"{round(angle, 2) + 0.0:.2f}" for angle in angles), *([Reach[code].text] if code else []))
    return table


def robot_table(summaries: list[dict[str, Any]]) -> Table:
    """Return a table of robots with sizes, masses and servos.

    Parameters
    ----------
    summaries : list of dict
        Summary from `tarsus.report.robot_summary.robot_summary`.
    """
    table = table_of("robot", "legs", "coxa, femur, tibia mm", "body mm", "mass", "servos", "gait")
    for robot in summaries:
        lengths = ", ".join(_value(robot[f"{joint}_mm"]) for joint in ("coxa", "femur", "tibia"))
        body = _UNKNOWN if robot["body_mm"] is None else " x ".join(f"{size:g}" for size in robot["body_mm"])
        mass, servos = number(robot["mass_kg"], "kg", digits=2), ", ".join(robot["servos"]) or _UNKNOWN
        table.add_row(robot["name"], str(robot["legs"]), lengths, body, mass, servos, robot["gait"])
    return table


def gait_table(trials: list[dict[str, Any]]) -> Table:
    """Return a table of the gaits that exist for the robot's number of legs, and of a short walk with each.

    Parameters
    ----------
    trials : list of dict
        `gaits` from `tarsus.report.robot_check.check_robot`.
    """
    table = table_of("gait", "walk", "longest stroke", "stability margin")
    for trial in trials:
        margin = trial["least_margin_mm"]
        # Without a foot on the ground the margin is minus infinity.
        known = margin is not None and margin != float("-inf")
        table.add_row(
            trial["gait"],
            "possible" if trial["possible"] else "not possible",
            "" if trial["longest_stroke_mm"] is None else number(trial["longest_stroke_mm"], "mm"),
            number(margin, "mm") if known else "",
        )
    return table


def _value(value: Any) -> str:
    """Format a value as in a robot file."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_value(item)}" for key, item in value.items())
    if isinstance(value, list):
        return f"[{', '.join(_value(item) for item in value)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def source_table(rows: list[dict[str, Any]]) -> Table:
    """Return a table of a robot's numbers with confidence and source.

    Parameters
    ----------
    rows : list of dict
        Summary from `tarsus.report.robot_summary.dimensions`.
    """
    table = table_of("key", "value", "confidence", "source")
    for row in rows:
        source = "none" if row["source_number"] is None else f"({row['source_number']})"
        table.add_row(row["key"], _value(row["value"]), row["confidence"] or _UNKNOWN, source)
    return table
