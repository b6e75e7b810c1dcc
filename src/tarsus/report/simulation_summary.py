"""Numbers of a simulated run, as printed by `tarsus simulate`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.report.tables import table_of
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    from jaxtyping import Float
    from rich.table import Table

    from tarsus.simulation.truth.outcome import Outcome

__all__ = ["simulation_summary", "simulation_table", "simulation_verdict"]


def simulation_summary(
    outcome: Outcome,
    planned: tuple[Float[np.ndarray, "3"], Float[np.ndarray, "3"]] | None,
    command_problems: Sequence[str] = (),
) -> dict[str, Any]:
    """Return the numbers of a simulated run, with units in the keys.

    Parameters
    ----------
    outcome : Outcome
        Result of the run.
    planned : (array, shape (3,), array, shape (3,)), optional
        Peak and root mean square torque of coxa, femur and tibia that statics predicts [N m].
    command_problems : sequence of str
        `Recording.command_problems` of a scenario.

    Returns
    -------
    dict
        Strings, numbers, lists and dicts; None if unknown.
    """
    joints = {}
    for number, name in enumerate(JOINTS):
        joints[name] = {
            "peak_nm": float(outcome.peak_torque[number]),
            "rms_nm": float(outcome.rms_torque[number]),
            "planned_peak_nm": None if planned is None else float(planned[0][number]),
            "planned_rms_nm": None if planned is None else float(planned[1][number]),
            "saturated_fraction": float(outcome.saturated[number]),
        }
    return {
        "duration_s": outcome.duration,
        "commanded_end": _place(outcome.commanded_end),
        "end": _place(outcome.end),
        "way_ratio": _finite(outcome.way_ratio),
        "turn_ratio": _finite(outcome.turn_ratio),
        "deviation_mm": 1000 * outcome.deviation,
        "tilt_deg": math.degrees(outcome.tilt),
        "sag_mm": 1000 * outcome.sag,
        "slip_mm": 1000 * outcome.slip,
        "joints": joints,
        "energy_j": outcome.energy,
        "cost_of_transport": _finite(outcome.cost_of_transport),
        "fell_at_s": outcome.fell_at,
        "stalls": list(outcome.stalls),
        "problems": [*outcome.problems, *command_problems],
        "ok": outcome.ok and not command_problems,
    }


def _place(place: tuple[float, float, float]) -> dict[str, float]:
    return {"x_mm": 1000 * place[0], "y_mm": 1000 * place[1], "turned_deg": math.degrees(place[2])}


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def simulation_table(summary: dict[str, Any]) -> Table:
    """Return the numbers of a simulated run as a table: as planned or commanded, in physics, and their ratio.

    Parameters
    ----------
    summary : dict
        Summary from `simulation_summary`.
    """
    numbers = ("planned", "physics", "ratio")
    table = table_of("quantity", *numbers, right=numbers)
    before, after = summary["commanded_end"], summary["end"]
    ways, turns = _ratio(summary["way_ratio"]), _ratio(summary["turn_ratio"])
    table.add_row("forward", f"{before['x_mm']:z.1f} mm", f"{after['x_mm']:z.1f} mm", ways)
    table.add_row("left", f"{before['y_mm']:z.1f} mm", f"{after['y_mm']:z.1f} mm", "")
    table.add_row("yaw", f"{before['turned_deg']:z.1f} deg", f"{after['turned_deg']:z.1f} deg", turns)
    for name, value in (
        ("maximum deviation", f"{summary['deviation_mm']:.1f} mm"),
        ("maximum tilt", f"{summary['tilt_deg']:.2f} deg"),
        ("sag of the body", f"{summary['sag_mm']:.1f} mm"),
        ("slip of a foot, mean", f"{summary['slip_mm']:.1f} mm"),
    ):
        table.add_row(name, "0", value, "")
    for joint, found in summary["joints"].items():
        for kind in ("peak", "rms"):
            planned, real = found[f"planned_{kind}_nm"], found[f"{kind}_nm"]
            ratio = "" if not planned or planned < _SMALL else _ratio(real / planned)
            name = f"{joint} torque, {'peak' if kind == 'peak' else 'RMS'}"
            table.add_row(name, "" if planned is None else f"{planned:.3f} N m", f"{real:.3f} N m", ratio)
        if found["saturated_fraction"]:
            table.add_row(f"{joint} saturated", "", f"{100 * found['saturated_fraction']:.1f} % of the time", "")
    table.add_row("energy", "", f"{summary['energy_j']:.2f} J", "")
    transport = summary["cost_of_transport"]
    table.add_row("cost of transport", "", "none" if transport is None else f"{transport:.2f}", "")
    return table


# Planned torques below this are too small for a meaningful ratio [N m].
_SMALL = 1e-3


def _ratio(value: float | None) -> str:
    return "" if value is None else f"{value:.3f}"


def simulation_verdict(summary: dict[str, Any]) -> str:
    """Return the verdict on a simulated run as text.

    Parameters
    ----------
    summary : dict
        Summary from `simulation_summary`.
    """
    if summary["ok"]:
        return "completed: the robot neither fell nor stalled"
    stands = summary["fell_at_s"] is None and not summary["stalls"]
    verdict = "the robot neither fell nor stalled, but did not do all that was commanded" if stands else "failed"
    return "\n".join([verdict, *(f"  {problem}" for problem in summary["problems"])])
