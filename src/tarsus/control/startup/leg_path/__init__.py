"""Paths of single legs through the air, with no point of the leg below the ground."""

from tarsus.control.startup.leg_path.free_space import LegFreeSpace
from tarsus.control.startup.leg_path.lift_off import lifts_off
from tarsus.control.startup.leg_path.paths import leg_paths

__all__ = ["LegFreeSpace", "leg_paths", "lifts_off"]
