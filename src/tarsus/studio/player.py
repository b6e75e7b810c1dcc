"""Offline player of a walk: the player page of the front end with embedded data."""

from __future__ import annotations

from pathlib import Path

from tarsus.errors import InputError, TarsusError
from tarsus.gait.motion import Motion
from tarsus.studio.loads import loads_message, loads_of
from tarsus.studio.messages.general import PlayerData
from tarsus.studio.messages.motion import LoadsMessage
from tarsus.studio.messages.state import LoadOptions, RobotChoice
from tarsus.studio.robots import robot_message
from tarsus.studio.walks import MOST_SAMPLES, walk_message

__all__ = ["BUILD_HINT", "WEB", "player_data", "player_page", "player_template"]

WEB = Path(__file__).parent / "web_dist"
"""Folder of the built front end."""

BUILD_HINT = "the studio's pages are not built: run `make web` in the project folder (requires Node 20 or newer)"

_PLACE = "__MOTION__"


def player_data(motion: Motion, *, choice: RobotChoice | None = None, options: LoadOptions | None = None) -> PlayerData:
    """Return the data that the player of a walk embeds.

    Parameters
    ----------
    motion : Motion
        The walk.
    choice : RobotChoice, optional
        Selection of the robot.
    options : LoadOptions, optional
        Payload and supply of the loads.

    Raises
    ------
    InputError
        If it has more samples than a page can hold.
    """
    if len(motion.time) > MOST_SAMPLES:
        raise InputError(
            f"the walk has {len(motion.time)} samples; a page holds at most {MOST_SAMPLES}: use a lower rate or a "
            "shorter walk"
        )
    chosen = RobotChoice(preset=None) if choice is None else choice
    return PlayerData(
        robot=robot_message(motion.robot, chosen, id=0),
        walk=walk_message(motion, longest=None, id=0),
        loads=_loads(motion, LoadOptions() if options is None else options),
    )


def _loads(motion: Motion, options: LoadOptions) -> LoadsMessage | None:
    if not motion.robot.has_masses or not motion.contacts.any(1).all():
        return None
    return loads_message(loads_of(motion, options), options, id=0)


def player_page(data: PlayerData) -> str:
    """Return the text of the page.

    Parameters
    ----------
    data : PlayerData
        Data to embed.

    Raises
    ------
    TarsusError
        If the front end has not been built.
    """
    # "<" could end the script element, so it is escaped as JSON allows.
    held = data.model_dump_json().replace("<", "\\u003c")
    return player_template().replace(_PLACE, held, 1)


def player_template() -> str:
    """Return the text of the page without its data.

    Raises
    ------
    TarsusError
        If the front end has not been built.
    """
    try:
        page = (WEB / "player.html").read_text(encoding="utf-8")
    except OSError:
        page = ""
    if _PLACE not in page:
        raise TarsusError(BUILD_HINT)
    return page
