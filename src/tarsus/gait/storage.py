"""Motions as files: a CSV table, a labelled data set, and a file that holds the whole motion."""

from __future__ import annotations

import csv
import dataclasses
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tarsus.errors import InputError, TarsusError
from tarsus.gait.gait import Gait
from tarsus.gait.motion import Motion
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.reach import Reach
from tarsus.robot.file import robot_from_text, robot_text
from tarsus.robot.robot import JOINTS

if TYPE_CHECKING:
    import xarray
    from jaxtyping import Float, Shaped

__all__ = ["labels", "load_motion", "motion_to_csv", "motion_to_dataset", "save_motion", "write_table"]

_ARRAYS = ("time", "feet", "contacts", "angles", "reach")
_NUMBERS = ("cycle_time", "stroke", "speed", "body_height", "swing_height", "foot_distance")
_FORMAT = "tarsus motion 1"


def csv_columns(motion: Motion) -> dict[str, Float[np.ndarray, "..."]]:
    """Return the columns of a motion's table, in the units that their names state."""
    x, y, z = (motion.body.position * 1000).T
    roll, pitch, yaw = np.degrees(motion.body.rpy).T
    table: dict[str, np.ndarray] = {"time_s": motion.time}
    for leg, name in enumerate(motion.robot.leg_codes):
        for joint, joint_name in enumerate(JOINTS):
            table[f"{name} {joint_name} deg"] = np.degrees(motion.angles[:, leg, joint])
    table |= {"body x mm": x, "body y mm": y, "body z mm": z}
    table |= {"body roll deg": roll, "body pitch deg": pitch, "body yaw deg": yaw}
    for leg, name in enumerate(motion.robot.leg_codes):
        for axis, letter in enumerate("xyz"):
            table[f"{name} foot {letter} mm"] = motion.feet[:, leg, axis] * 1000
        table[f"{name} down"] = motion.contacts[:, leg].astype(int)
        table[f"{name} reach"] = np.array([Reach(int(code)).name for code in motion.reach[:, leg]])
    table["margin mm"] = motion.margin * 1000
    return {name.replace(" ", "_"): column for name, column in table.items()}


def motion_to_csv(motion: Motion, path: str | os.PathLike[str]) -> None:
    """Write a motion as a table: a row for each sample, angles in degrees, lengths in mm.

    Parameters
    ----------
    motion : Motion
        The motion.
    path : path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written.
    """
    table = csv_columns(motion)
    write_table(path, table, zip(*(_formatted(column) for column in table.values()), strict=True))


def write_table(path: str | os.PathLike[str], header: Iterable[str], rows: Iterable[Iterable[str]]) -> None:
    """Write a table as a CSV file.

    Parameters
    ----------
    path : path
        Where to write it.
    header : iterable of str
        Names of the columns.
    rows : iterable of iterable of str
        The rows.

    Raises
    ------
    InputError
        If it can't be written.
    """
    try:
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(header)
            writer.writerows(rows)
    except OSError as error:
        raise InputError(f"{os.fspath(path)} can't be written: {error.strerror or error}") from None


def _formatted(column: Shaped[np.ndarray, "..."]) -> list[str]:
    """Format numbers to a nanometre or a microdegree, without digits of rounding noise."""
    if column.dtype.kind != "f":
        return [str(value) for value in column.tolist()]
    return [f"{value + 0.0:.6f}" for value in np.round(column, 6).tolist()]


def motion_to_dataset(motion: Motion) -> xarray.Dataset:
    """Return a motion as a labelled `xarray.Dataset` in SI units (needs the extra ``data``).

    Reach is a flag variable of the CF conventions: `flag_values` and `flag_meanings` name its codes. The data set can
    be written to netCDF and Zarr as it is (``.to_netcdf``, ``.to_zarr``).

    Parameters
    ----------
    motion : Motion
        The motion.

    Raises
    ------
    InputError
        If xarray is not installed.

    Notes
    -----
    NetCDF Climate and Forecast (CF) Metadata Conventions 1.11, section 3.5: flags.
    """
    try:
        import xarray
    except ImportError:
        raise InputError("motion_to_dataset needs xarray: pip install 'tarsus[data]'") from None
    per_leg = ("time", "leg")
    return xarray.Dataset(
        {
            "angles": ((*per_leg, "joint"), motion.angles, {"units": "rad"}),
            "feet": ((*per_leg, "axis"), motion.feet, {"units": "m", "frame": "ground"}),
            "contacts": (per_leg, motion.contacts),
            "reach": (per_leg, motion.reach, _reach_flags()),
            "body_position": (("time", "axis"), motion.body.position, {"units": "m", "frame": "ground"}),
            "body_rotation": (("time", "axis", "body_axis"), motion.body.rotation),
            "margin": (("time",), motion.margin, {"units": "m"}),
        },
        coords={
            "time": ("time", motion.time, {"units": "s"}),
            "leg": labels(motion.robot.leg_codes),
            "joint": labels(JOINTS),
            "axis": labels("xyz"),
            "body_axis": labels("xyz"),
        },
        attrs={
            "Conventions": "CF-1.11",
            "robot": motion.robot.name,
            "gait": motion.gait.name,
            **{name: getattr(motion, name) for name in _NUMBERS},
        },
    )


def labels(texts: Iterable[str]) -> Shaped[np.ndarray, "n"]:
    """Return the labels of an axis as an array of variable-length strings: Zarr 3 specifies no fixed-length ones."""
    return np.array(list(texts), dtype=object)


def _reach_flags() -> dict[str, Any]:
    """Return the attributes that name the codes of `Reach`."""
    return {
        "long_name": "whether the leg reaches its foot, and if not, why",
        "flag_values": np.array([int(code) for code in Reach], dtype=np.int8),
        "flag_meanings": " ".join(code.name.lower() for code in Reach),
    }


def save_motion(motion: Motion, path: str | os.PathLike[str]) -> None:
    """Write a motion and its robot to one compressed file (``.npz``); `load_motion` reads it.

    Parameters
    ----------
    motion : Motion
        The motion.
    path : path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written.
    """
    about = {
        "format": _FORMAT,
        "robot": robot_text(motion.robot),
        "gait": dataclasses.asdict(motion.gait),
        "assumed": motion.assumed,
        **{name: getattr(motion, name) for name in _NUMBERS},
    }
    arrays = {name: getattr(motion, name) for name in _ARRAYS}
    try:
        with open(path, "wb") as file:
            np.savez_compressed(
                file,
                about=np.array(json.dumps(about)),
                rotation=motion.body.rotation,
                position=motion.body.position,
                **arrays,
            )
    except OSError as error:
        raise InputError(f"{path} can't be written: {error.strerror}") from None


def load_motion(path: str | os.PathLike[str]) -> Motion:
    """Read a motion that `save_motion` wrote.

    Parameters
    ----------
    path : path
        Where it is.

    Raises
    ------
    InputError
        If the file does not exist, or is not a motion.
    """
    where = Path(path)
    try:
        with open(where, "rb") as raw, np.load(raw, allow_pickle=False) as file:
            about = json.loads(str(file["about"]))
            if about["format"] != _FORMAT:
                raise InputError(f"{where} has the format {about['format']!r}; this version reads {_FORMAT!r}")
            numbers: dict[str, Any] = {name: float(about[name]) for name in _NUMBERS}
            return Motion(
                robot=robot_from_text(about["robot"], where=f"the robot in {where}"),
                gait=Gait(**about["gait"]),
                body=Pose(file["rotation"], file["position"]),
                assumed=tuple(about["assumed"]),
                **{name: file[name] for name in _ARRAYS},
                **numbers,
            )
    except OSError as error:
        raise InputError(f"{where} can't be read: {error.strerror or error}") from None
    except TarsusError:
        raise
    except Exception as error:  # zipfile, zlib, NumPy and json raise various errors on damaged files
        raise InputError(f"{where} is not a motion file of Tarsus: {error}") from None
