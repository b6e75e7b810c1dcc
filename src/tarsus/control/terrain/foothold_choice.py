"""Foothold choice: where feet in the air are put down on ground that is known."""

from __future__ import annotations

import numpy as np

from tarsus.control.terrain.ground_map import GroundMap
from tarsus.control.terrain.reach import Reach
from tarsus.control.transition.foothold_transfer import FootholdTransfer
from tarsus.control.walk.state import GaitState
from tarsus.gait.foot_polygons import NORMALS_CONJUGATE
from tarsus.gait.ground_heights import TRIED, better_foothold, on_way
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT

__all__ = ["FootholdChoice"]

# Least share of the distance at which a foot may be put down that is kept for its stroke.
_STROKE_SHARE = 0.65
# How far the body would be lowered to reach deep ground, and depth from which on ground is a hole even if legs reach
# it, both over the body height.
_LOWERED, _DEEPEST = 0.35, 1.2
# Swing phase up to which a foothold is chosen, and up to which one in a hole is replaced.
_CHOOSING, _CHOOSING_AGAIN = 0.3, 0.45
_ALONG_TRIED = (NORMALS_CONJUGATE * TRIED[:, None]).real


class FootholdChoice:
    """Chooses footholds beside those of the steps, on ground that is even and within the legs' reach.

    Parameters
    ----------
    ground : GroundMap
        The ground, as far as it is known.

    Attributes
    ----------
    beside : dict of int to complex
        By leg, offset from the foothold of its step at which a foot in the air is put down, in the heading frame [m].
    holes : dict of int to complex
        By leg, the foothold of a foot in the air that would be put down into a hole, in the heading frame [m].
    crossing : set of int
        Legs whose feet in the air cross a hole on their way.
    """

    def __init__(self, ground: GroundMap) -> None:
        self._ground = ground
        self.beside, self.holes, self.crossing = dict[int, complex](), dict[int, complex](), set[int]()

    def step(self, state: GaitState, reach: Reach, footholds: FootholdTransfer) -> None:
        """Choose footholds for feet that have lifted off, once in each swing, and again in place of a hole.

        Parameters
        ----------
        state, reach : GaitState, Reach
            The gait state; strokes, and the heights between which legs reach them.
        footholds : FootholdTransfer
            How far from their rest footholds feet may be put down.
        """
        ground = self._ground
        if not ground.given:
            return
        height, swing_height = state.posture.value[[2, SWING_HEIGHT]].tolist()
        ground.deepest = min(_LOWERED * height - max(reach.lowest), _DEEPEST * height)
        highest = reach.highest_stand(swing_height)
        for leg, (down, phase) in enumerate(zip(state.down.tolist(), state.swing_phase.tolist(), strict=True)):
            if down:
                self.beside.pop(leg, None)
                self.holes.pop(leg, None)
                self.crossing.discard(leg)
                continue
            start, end = (state.in_heading(complex(at[leg])) for at in (state.foot, state.foothold))
            again = leg in self.beside and phase < _CHOOSING_AGAIN and (leg in self.holes or ground.is_hole(end))
            if again or (leg not in self.beside and 0 < phase < _CHOOSING):
                # A hole that is found only later in a swing is not reported: the foot goes down soon.
                held, end = leg in self.holes or leg not in self.beside, end - self.beside.get(leg, 0j)
                self.holes.pop(leg, None)
                room = (reach.lowest[leg], highest[leg], reach.highest[leg])
                # A foot keeps room for its stroke within its workspace.
                kept = np.abs((NORMALS_CONJUGATE * reach.strokes[leg]).real) / 2
                slack = footholds.placement_bounds[leg] - kept.clip(_STROKE_SHARE * footholds.placement_radii[leg])
                allowed = (slack.clip(0.0) >= _ALONG_TRIED).all(axis=1)
                better = better_foothold(ground.lies, ground.plane.at, start, end, allowed=allowed, reach=room)
                self.beside[leg], place = better, end + better
                if held and ground.is_hole(place):
                    self.holes[leg] = end
                if on_way(ground.lies, start, place).min() < ground.floor(np.array(place)):
                    self.crossing.add(leg)
