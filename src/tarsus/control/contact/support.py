"""Support: whether the feet that bear load hold the robot, and how fast the walk may go on."""

from __future__ import annotations

from tarsus.control.contact.footing import Footing

__all__ = ["HALTING", "Support"]

# Rates at which the pace falls and rises [1/s].
_FALL, _RISE = 10.0, 6.0
# Fraction of a swing time over which the pace falls to 0 while feet that are due have to wait.
_PATIENCE = 0.3
# Time without support after which the pace falls, and over which it falls to 0; a third of it before feet that wait
# slow the walk [s].
_GRACE = 0.15
# Time of waiting after which feet in the air are put down: they may hang, as the walk no longer lowers them [s].
_PUTS_DOWN = 1.0
# Time of waiting after which fewer feet lift off than are due [s].
_LONG = 2.5
# Speed at which the body shifts over feet that do not hold it yet [m/s]; how far it shifts at most [m].
_SHIFTS, _FARTHEST = 0.05, 0.08
HALTING = 0.5
"""Below this pace the robot waits for support."""


class Support:
    """Decides whether feet may lift off, and at which pace the walk goes on.

    Attributes
    ----------
    pace : float
        Rate of steps and twist, 0 to 1.
    waits, held : bool
        Whether feet that are due stay on the ground; whether the feet that bear load hold the robot.
    stay : list of int
        Legs whose feet miss their step, so that others can lift off.
    shift : complex
        Velocity of the body over its feet, in the heading frame [m/s].
    """

    def __init__(self) -> None:
        self.pace, self.waits = 1.0, False
        self._waited = self._unsupported = 0.0
        self._bearing, self.held, self.stay = list[int](), False, list[int]()
        self.shift, self._shifted = 0j, 0.0

    @property
    def halts(self) -> bool:
        """Whether the robot waits until its feet hold it."""
        return self.pace < HALTING

    def puts_down(self, *, refuses: bool) -> bool:
        """Return whether a robot that waits has to put down feet in the air: at once where the motion is refused."""
        return self.halts and (refuses or max(self._waited, self._unsupported) > _PUTS_DOWN)

    def holds(self, legs: list[int], footing: Footing, *, anew: bool) -> bool:
        """Return whether feet hold the robot; computed again only for other feet, or when asked to.

        Parameters
        ----------
        legs, footing, anew : list of int, Footing, bool
            Legs whose feet bear load; all feet; whether to compute it again for the same feet.
        """
        if anew or legs != self._bearing:
            self._bearing, self.held = legs, footing.held_by(legs)
        return self.held

    def shift_over(self, legs: list[int], footing: Footing, dt: float, *, scale: float) -> None:
        """Shift the body over feet that do not hold it yet: with all feet at rest, it would otherwise wait for ever.

        Parameters
        ----------
        legs, footing, dt : list of int, Footing, float
            Legs whose feet stay while others lift off, none for no shift; all feet; time since the last call [s].
        scale : float
            Factor by which lengths and speeds are reduced on short legs, 0 to 1.
        """
        self.shift, self._shifted = 0j, self._shifted * bool(legs)
        if legs and self.halts and self._shifted < scale * _FARTHEST:
            way = sum(footing.places[leg] for leg in legs) / len(legs) - footing.centre
            self.shift = scale * _SHIFTS * way / max(abs(way), 1e-9)
            self._shifted += abs(self.shift) * dt

    def lift_fewer(self, bearing: list[int], due: list[int], footing: Footing) -> None:
        """After a long wait, let those feet lift off without which the others hold the robot; the rest miss a step.

        Parameters
        ----------
        bearing, due, footing : list of int, list of int, Footing
            Legs whose feet bear load; legs whose feet are due to lift off, none for no change; all feet.
        """
        self.stay = []
        if due and self._waited > _LONG:
            for leg in due:
                left = [other for other in bearing if other != leg]
                if footing.held_by(left):
                    bearing = left
            self.stay = [leg for leg in due if leg in bearing]
            self.waits = len(self.stay) == len(due)

    def step(self, *, stays: bool, lifts: bool, dt: float, swing_time: float, most: float = 1.0) -> None:
        """Decide for a tick.

        Parameters
        ----------
        stays : bool
            Whether the feet that bear load and are not due to lift off hold the robot.
        lifts, dt : bool, float
            Whether any foot is due to lift off; length of the tick [s].
        swing_time, most : float
            Duration of a swing [s]; the greatest pace.
        """
        self.waits = lifts and not stays
        self._waited = self._waited + dt if self.waits else 0.0
        self._unsupported = 0.0 if stays or lifts else self._unsupported + dt
        late = max((self._waited - _GRACE / 3) / (_PATIENCE * swing_time), (self._unsupported - _GRACE) / _GRACE)
        wanted = min(1 - min(max(late, 0.0), 1.0), most)
        self.pace += min(max(wanted - self.pace, -_FALL * dt), _RISE * dt)
