"""Paths of single legs through the air, with no point of the leg below the ground."""

from tarsus.kinematics.leg_path.free_space import LegFreeSpace, Path
from tarsus.kinematics.leg_path.lift_off import lifts_off

__all__ = ["LegFreeSpace", "Path", "lifts_off"]
