"""Compliant statics under the conditions of given joint loads, where the servos are known."""

from __future__ import annotations

from tarsus.errors import MissingDataError
from tarsus.load.compliant.compliant_loads import compliant_loads
from tarsus.load.compliant.result import CompliantLoads
from tarsus.load.loads import JointLoads

__all__ = ["compliant_or_missing"]


def compliant_or_missing(loads: JointLoads) -> tuple[CompliantLoads | None, str]:
    """Return compliant statics under the conditions of joint loads, or None and a message on what is missing.

    Parameters
    ----------
    loads : JointLoads
        Loads from vertical forces.
    """
    try:
        return compliant_loads(loads.robot, loads.motion, payload=loads.payload, **loads.conditions), ""
    except MissingDataError as error:
        return None, str(error)
