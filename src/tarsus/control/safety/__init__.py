"""The guard: an independent monitor of the joint angles that are sent to the robot.

The package imports nothing else of `tarsus.control`, so that it shares no code with what it monitors. Its public names
are those listed in ``__all__``; everything else is private to the package.
"""

from tarsus.control.safety.bounds import GuardBounds
from tarsus.control.safety.guard import Guard
from tarsus.control.safety.interventions import GuardOutput, GuardState, Intervention, InterventionKind

__all__ = ["Guard", "GuardBounds", "GuardOutput", "GuardState", "Intervention", "InterventionKind"]
