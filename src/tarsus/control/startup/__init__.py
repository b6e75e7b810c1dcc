"""Planning of motion sequences: standing up, sitting down, folding, and the order of switching the joints off.

The public names are those listed in ``__all__``; everything else is private to the package.
"""

from tarsus.control.startup.planner import fold, sit_down, stand_up
from tarsus.control.startup.power_off import PowerOffOrder, power_off_order

__all__ = ["PowerOffOrder", "fold", "power_off_order", "sit_down", "stand_up"]
