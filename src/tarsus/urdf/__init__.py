"""Robots from URDF files.

::

    from tarsus.urdf import robot_from_urdf

    found = robot_from_urdf("hexapod.urdf")
    print(found.robot, found.remarks)
"""

from __future__ import annotations

from tarsus.urdf.read import DIRECTIONS, ImportedRobot, robot_from_urdf, urdf_robot

__all__ = ["DIRECTIONS", "ImportedRobot", "robot_from_urdf", "urdf_robot"]
