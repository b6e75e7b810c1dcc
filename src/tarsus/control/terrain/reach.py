"""How low and how high each foot may stand on its stroke, and how high it may swing, straight on or swung out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tarsus.control.walk_state import TickState
from tarsus.gait.foot_plane import FootPlane
from tarsus.gait.stance.reachable_heights import STROKE_PLACES, reachable_heights
from tarsus.gait.stance.stance_geometry import SWING_HEIGHT
from tarsus.robot.robot import Robot

if TYPE_CHECKING:
    from jaxtyping import Complex

__all__ = ["Reach"]

# Step in which strokes change before heights are computed again [m]; lever arm that turns a rotation into a stroke [m].
_STROKE_STEP, _TURNING_ARM = 0.01, 0.2
# Distance from its least height within which a foot hangs [m]; how far below that its ground is then expected [m].
_HANGING, _LOWER = 0.002, 0.03
# Room for the swing between the ground and a leg's greatest height, over the swing height; the same while a foot hangs.
_CLEARANCE, _HANGING_CLEARANCE = 1.5, 0.75
# How far at most a foot swings out across its stroke, where its leg reaches higher [m].
_BOW = 0.03
# Length of femur and tibia together from which on the lengths and speeds of felt walks apply without reduction [m].
_USUAL_LEG = 0.19
# Length below which a stroke has no direction [m]; decimals of the distance of a coxa from the line of a stroke [m].
_NO_STROKE, _DECIMALS = 1e-9, 6


class Reach:
    """The heights at which each leg reaches its stroke, computed again when stroke, posture or rest footholds change.

    Parameters
    ----------
    robot : Robot
        A single robot.

    Attributes
    ----------
    lowest, highest : list of float
        Least and greatest height at which each foot reaches its whole stroke, in the heading frame [m].
    bows : complex array, shape (legs,)
        How far each foot may swing out across its stroke, in the heading frame [m].
    rest, strokes : complex array, shape (legs,)
        Rest foothold and stroke of each foot, in the heading frame [m].
    stroke, scale : float
        Half the longest stroke [m]; factor by which lengths and speeds are reduced on short legs, 0 to 1.
    """

    def __init__(self, robot: Robot) -> None:
        self.lowest, self.highest, self.stroke = [0.0] * robot.legs, [0.0] * robot.legs, 0.0
        self.rest: Complex[np.ndarray, "legs"] = np.zeros(robot.legs, dtype=complex)
        self.bows = self.strokes = self.rest
        # Greatest height of each foot at the places of its stroke, straight on and swung out [m].
        self._tops = self._bowed = [(0.0,) * len(STROKE_PLACES)] * robot.legs
        self.scale = min(float((robot.femur + robot.tibia).mean()) / _USUAL_LEG, 1.0)
        self._robot, self._mounts = robot, robot.mount_position[:, 0] + 1j * robot.mount_position[:, 1]
        self._key: tuple[float, ...] = ()

    def update(self, tick: TickState, rest: Complex[np.ndarray, "legs"], stance_time: float) -> None:
        """Update the heights.

        Parameters
        ----------
        tick : TickState
            Posture of the body, and the twist that is followed.
        rest : complex array, shape (legs,)
            Rest footholds in the heading frame [m].
        stance_time : float
            Duration of a stance [s].
        """
        (vx, vy, wz), posture, step = tick.twist.tolist(), tick.gait.posture.value, self.scale * _STROKE_STEP
        x, y, arc = (round(speed * stance_time / step) * step for speed in (vx, vy, wz * _TURNING_ARM))
        key = (x, y, arc, *posture[:SWING_HEIGHT].round(3).tolist())
        if key != self._key or rest is not self.rest:
            self._key, self.rest, strokes = key, rest, complex(x, y) + 1j * arc / _TURNING_ARM * rest
            self.stroke, self.strokes = float(np.abs(strokes).max()) / 2, strokes
            # Feet swing out across the stroke, away from the coxa; not at all where that is in line with the stroke.
            along = strokes / np.maximum(np.abs(strokes), _NO_STROKE)
            aside = np.sign(((rest - self._mounts) * along.conj()).imag.round(_DECIMALS))
            # A robot that stops keeps its bows, and so the height of its body.
            self.bows = np.where(strokes == 0, self.bows, self.scale * _BOW * 1j * along * aside)
            heights = reachable_heights(self._robot, posture, np.array([rest, rest + self.bows]), strokes)
            (lowest, lowest_beside), (highest, highest_beside) = heights
            # Ends of strokes beyond the limits of the coxa are not walked; a leg that reaches none keeps its heights.
            walked = lowest < highest
            kept = ~walked.any(axis=0)
            least = lowest.max(axis=0, where=walked, initial=-np.inf)
            most = highest.min(axis=0, where=walked, initial=np.inf)
            self.lowest = np.where(kept, self.lowest, least).tolist()
            self.highest = np.where(kept, self.highest, most).tolist()
            tops = np.where(walked, highest, self.highest)
            bowed = np.where(lowest_beside < highest_beside, np.maximum(highest_beside, tops), tops)
            self._tops, self._bowed = ([tuple(leg) for leg in heights.T.tolist()] for heights in (tops, bowed))

    def highest_on_way(self, leg: int, start: complex, end: complex) -> tuple[float, float]:
        """Return the greatest heights of a foot on a way, straight on and swung out [m].

        Front legs reach higher ahead, rear legs behind.

        Parameters
        ----------
        leg : int
            The leg.
        start, end : complex
            Where the way begins and ends, in the heading frame [m].
        """
        (straight, bowed), (straight_end, bowed_end) = self._highest_at(leg, start), self._highest_at(leg, end)
        return min(straight, straight_end), min(bowed, bowed_end)

    def _highest_at(self, leg: int, place: complex) -> tuple[float, float]:
        """Return the same at one place, from its distances along and beside the stroke [m]."""
        stroke, bow = complex(self.strokes[leg]), complex(self.bows[leg])
        off = place - complex(self.rest[leg])
        ahead = (off * stroke.conjugate()).real / abs(stroke) ** 2 if stroke else 0.0
        beside = min(max((off * bow.conjugate()).real / abs(bow) ** 2, 0.0), 1.0) if bow else 0.0
        straight, bowed = (_along(tops[leg], ahead) for tops in (self._tops, self._bowed))
        return straight + beside * (bowed - straight), bowed

    def highest_stand(self, swing_height: float, *, hangs: bool = False) -> list[float]:
        """Return the greatest height of each foot on the ground that leaves room for its swing [m].

        Parameters
        ----------
        swing_height, hangs : float, bool
            The swing height [m]; whether any foot hangs, for which the body has to be lowered.
        """
        room = (_HANGING_CLEARANCE if hangs else _CLEARANCE) * swing_height
        # A foot that stands is not swung out.
        return [min(min(out) - room, highest) for out, highest in zip(self._bowed, self.highest, strict=True)]

    def hangs(self, leg: int, height: float) -> bool:
        """Return whether a leg is at the end of its reach with its foot at this height in the heading frame [m]."""
        return height < self.lowest[leg] + self.scale * _HANGING

    def rises(self, plane: FootPlane, over: list[float], *, bears: list[int], hanging: list[int]) -> list[float]:
        """Return the height of the ground under each leg, as far as known, over that of the plane at the origin [m].

        Parameters
        ----------
        plane : FootPlane
            The plane of the standing feet.
        over, bears : list of float, list of int
            Height of each foot [m]; legs whose feet bear load.
        hanging : list of int
            Legs at the end of their reach whose feet should stand and have no contact: with the body lower they may
            find ground.
        """
        known = [over[leg] if leg in bears else plane.at(place) for leg, place in enumerate(self.rest.tolist())]
        for leg in hanging:
            known[leg] = self.lowest[leg] - self.scale * _LOWER
        return [height - plane.height for height in known]


def _along(tops: tuple[float, ...], ahead: float) -> float:
    """Return the greatest height [m] at a place of a stroke, `ahead` of its middle as a fraction of its length."""
    rear, middle, front = tops
    return middle + min(2 * abs(ahead), 1.0) * ((front if ahead > 0 else rear) - middle)
