"""Exported files: the walk as CSV, the robot file, joint angles, and the offline player."""

from __future__ import annotations

import csv
import io
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tarsus.gait.motion import Motion
from tarsus.gait.storage import motion_to_csv
from tarsus.robot.file import robot_text
from tarsus.robot.robot import JOINTS, Robot
from tarsus.studio.messages.general import FileMessage

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["angles_csv", "file_name", "text_file", "toml_of", "walk_csv"]

_MIME = {"csv": "text/csv", "toml": "application/toml", "html": "text/html"}


def text_file(name: str, text: str, *, id: int) -> FileMessage:
    """Return a file as a message.

    Parameters
    ----------
    name : str
        Name of the file; its extension determines the MIME type.
    text : str
        Content.
    id : int
        Id of the message that is answered.
    """
    return FileMessage(type="file", id=id, name=name, mime=_MIME[name.rpartition(".")[2]], text=text)


def file_name(robot: Robot, content: str, extension: str) -> str:
    """Return a file name that is valid on every file system.

    Parameters
    ----------
    robot : Robot
        A single robot, with whose name the file name starts.
    content : str
        Content of the file; may be empty.
    extension : str
        Extension, such as ``"csv"``.
    """
    plain = re.sub(r"[^A-Za-z0-9]+", "-", robot.name)[:60].strip("-") or "robot"
    return f"{'-'.join(part for part in (plain, content) if part)}.{extension}"


def walk_csv(motion: Motion) -> str:
    """Return a walk as CSV.

    Parameters
    ----------
    motion : Motion
        The walk.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.csv"
        motion_to_csv(motion, path)
        return path.read_bytes().decode()


def angles_csv(robot: Robot, angles: Float[np.ndarray, "legs 3"]) -> str:
    """Return the joint angles of one pose as CSV.

    Parameters
    ----------
    robot : Robot
        A single robot.
    angles : array, shape (legs, 3)
        Joint angles [rad].
    """
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(["leg", *(f"{joint}_deg" for joint in JOINTS)])
    for code, row in zip(robot.leg_codes, np.degrees(angles).tolist(), strict=True):
        writer.writerow([code, *(f"{round(value, 6) + 0.0:.6f}" for value in row)])
    return text.getvalue()


def toml_of(robot: Robot) -> str:
    """Return the text of the robot file.

    Parameters
    ----------
    robot : Robot
        A single robot.
    """
    return robot_text(robot)
