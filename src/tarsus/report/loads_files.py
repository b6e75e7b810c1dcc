"""The files of a walk's loads: table, pictures, and one page with all of it."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

from tarsus.errors import InputError
from tarsus.load.loads import JointLoads
from tarsus.report.loads_page import loads_page
from tarsus.report.loads_speed import plot_torque_speed
from tarsus.report.loads_torque import plot_torques
from tarsus.report.style import save_figure
from tarsus.robot.robot import JOINTS

__all__ = ["write_loads", "write_loads_csv"]


def write_loads(found: JointLoads, summary: dict[str, Any], folder: Path) -> list[Path]:
    """Write table, pictures and page, and return where they are.

    Parameters
    ----------
    found : Loads
        The loads.
    summary : dict
        From `tarsus.report.loads_summary.loads_summary`.
    folder : Path
        A folder that is there.

    Raises
    ------
    InputError
        If a file can't be written.
    TarsusError
        If matplotlib is not installed.
    """
    pictures = {"torques.png": plot_torques(found), "torque-speed.png": plot_torque_speed(found)}
    table, page = folder / "loads.csv", folder / "report.html"
    write_loads_csv(found, table)
    for name, figure in pictures.items():
        save_figure(figure, folder / name)
    try:
        page.write_text(loads_page(summary, [folder / name for name in pictures]), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{page} can't be written: {error.strerror or error}") from None
    return [table, *(folder / name for name in pictures), page]


def write_loads_csv(found: JointLoads, path: Path) -> None:
    """Write a row for each moment: torques, and the ground's forces.

    Parameters
    ----------
    found : Loads
        The loads.
    path : Path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written.
    """
    codes = found.robot.leg_codes
    header = ["time_s", "margin_mm"]
    header += [f"{code}_{joint}_nm" for code in codes for joint in JOINTS]
    header += [f"{code}_f{axis}_n" for code in codes for axis in "xyz"]
    try:
        with path.open("w", encoding="utf-8", newline="") as stream:
            table = csv.writer(stream)
            table.writerow(header)
            rows = zip(found.motion.time, found.margin, found.torques, found.forces, strict=True)
            for time, margin, torques, forces in rows:
                numbers = (*torques.ravel(), *forces.ravel())
                # Adding zero makes -0.0 a plain 0.0.
                table.writerow(
                    [f"{time:.6f}", f"{1000 * margin:.3f}", *(f"{round(float(v), 6) + 0.0:.6f}" for v in numbers)]
                )
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror or error}") from None
