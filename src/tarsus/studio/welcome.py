"""The first answer of a session: what there is to choose from."""

from __future__ import annotations

from tarsus import __version__
from tarsus.gait.gait import GAITS
from tarsus.robot.catalogue import list_servos
from tarsus.robot.file import list_robots
from tarsus.robot.schema import robot_schema
from tarsus.studio.messages.machine import HardwareOffer, RunOffer
from tarsus.studio.messages.pose import Bounds, Welcome
from tarsus.studio.physics.terrains import physics_offer

__all__ = ["welcome_message"]


def welcome_message(
    bounds: Bounds, *, public: bool, hardware: HardwareOffer, run: RunOffer | None = None, id: int
) -> Welcome:
    """Return presets, gaits, servos, terrains and limits.

    Parameters
    ----------
    bounds : Bounds
        Limits of the session.
    public : bool
        Whether this is a public server.
    hardware : HardwareOffer
        Whether the session has access to servos.
    run : RunOffer, optional
        The run that the server belongs to.
    id : int
        Id of the message that is answered.
    """
    return Welcome(
        type="welcome",
        id=id,
        version=__version__,
        robots=list(list_robots()),
        gaits=list(GAITS),
        servos=list(list_servos()),
        public=public,
        bounds=bounds,
        physics=physics_offer(),
        run=run,
        hardware=hardware,
        robot_schema=robot_schema(),
    )
