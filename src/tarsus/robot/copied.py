"""Copies of robot files under another name, with their comments."""

from __future__ import annotations

import os
import re

from tarsus.errors import RobotFileError
from tarsus.robot.file import file_text, robot_from_text, robot_text
from tarsus.robot.writer import toml_string

__all__ = ["copied_text"]

# Lines of a copy whose masses are unknown; the numbers are those of the template.
_MASSES = """\
# The masses are not known; without them there are no torques. Weigh the body with its battery, and the links of one leg
# with the servos mounted on them; then put your numbers here and remove the # at the start of the line.
"""
_BODY_MASS = "# mass_kg = 1.2\n"
_LINK_MASS = "# mass_kg = { coxa = 0.07, femur = 0.08, tibia = 0.06 }\n"


def copied_text(name_or_path: str | os.PathLike[str], name: str) -> str:
    """Return the text of a robot file with another name for the robot, with places for masses that are unknown.

    Parameters
    ----------
    name_or_path : str or path
        A preset, or the path of a robot file.
    name : str
        Name of the copy.

    Raises
    ------
    RobotFileError
        If there is no such robot, or its file or the name is not valid.
    """
    text = file_text(name_or_path)
    robot = robot_from_text(text, where=str(name_or_path)).replace(name=name)
    # The schema's path is relative to the preset's folder.
    text = re.sub(r"\A#:schema [^\n]*\n", "", text)
    text = re.sub(r"^name\s*=[^\n]*", lambda _: f"name = {toml_string(name)}", text, count=1, flags=re.MULTILINE)
    try:
        written_by_hand = robot_from_text(text, where=name) == robot
    except RobotFileError:
        written_by_hand = False
    # Where the name could not be replaced, as it is written over several lines for example, the comments are lost.
    text = text if written_by_hand else robot_text(robot)
    if robot.link_mass is None:
        text = _insert(text, "[leg]", _MASSES * (robot.body_mass is not None) + _LINK_MASS)
    if robot.body_mass is None:
        text = _insert(text, "[body]", _MASSES + _BODY_MASS)
    return text


def _insert(text: str, header: str, lines: str) -> str:
    """Return the text with lines below a table's header; a missing header is inserted before [leg] or [[legs]]."""
    if not re.search(rf"^{re.escape(header)}", text, flags=re.MULTILINE):
        before = r"^(?=((#[^\n]*\n)*)\[leg\]|\[\[legs\]\])"
        return re.sub(before, lambda _: f"{header}\n{lines}\n", text, count=1, flags=re.MULTILINE)
    return re.sub(rf"^{re.escape(header)}[^\n]*\n", lambda found: found[0] + lines, text, count=1, flags=re.MULTILINE)
