"""Robots for other software: URDF and MJCF.

::

    from tarsus import load_robot
    from tarsus.export import to_mjcf, to_urdf

    urdf = to_urdf(load_robot("strider"))
    mjcf = to_mjcf(load_robot("strider"))
"""

from __future__ import annotations

from tarsus.export.mjcf import to_mjcf
from tarsus.export.urdf import to_urdf

__all__ = ["to_mjcf", "to_urdf"]
