"""Output files of joint loads: table, figures and an HTML page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tarsus.errors import InputError
from tarsus.gait.storage import write_table
from tarsus.load.loads import JointLoads
from tarsus.report.loads_page import loads_page
from tarsus.report.loads_speed import plot_torque_speed
from tarsus.report.loads_torque import plot_torques
from tarsus.report.style import save_figure
from tarsus.robot.robot import JOINTS

__all__ = ["write_loads", "write_loads_csv"]


def write_loads(loads: JointLoads, summary: dict[str, Any], folder: Path) -> list[Path]:
    """Write table, figures and page, and return their paths.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    summary : dict
        Summary from `tarsus.report.loads_summary.loads_summary`.
    folder : Path
        Existing folder.

    Raises
    ------
    InputError
        If a file can't be written.
    TarsusError
        If matplotlib is not installed.
    """
    figures = {"torques.png": plot_torques(loads), "torque-speed.png": plot_torque_speed(loads)}
    table, page = folder / "loads.csv", folder / "report.html"
    write_loads_csv(loads, table)
    for name, figure in figures.items():
        save_figure(figure, folder / name)
    try:
        page.write_text(loads_page(summary, [folder / name for name in figures]), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{page} can't be written: {error.strerror or error}") from None
    return [table, *(folder / name for name in figures), page]


def write_loads_csv(loads: JointLoads, path: Path) -> None:
    """Write a table with the joint torques and contact forces of each sample.

    Parameters
    ----------
    loads : JointLoads
        Joint loads.
    path : Path
        Output file.

    Raises
    ------
    InputError
        If the file can't be written.
    """
    codes = loads.robot.leg_codes
    header = ["time_s", "margin_mm"]
    header += [f"{code}_{joint}_nm" for code in codes for joint in JOINTS]
    header += [f"{code}_f{axis}_n" for code in codes for axis in "xyz"]
    samples = zip(loads.motion.time, loads.margin, loads.torques, loads.forces, strict=True)
    # Adding zero turns -0.0 into 0.0.
    rows = (
        [
            f"{time:.6f}",
            f"{1000 * margin:.3f}",
            *(f"{round(float(v), 6) + 0.0:.6f}" for v in (*torques.ravel(), *forces.ravel())),
        ]
        for time, margin, torques, forces in samples
    )
    write_table(path, header, rows)
