"""Contacts of the feet over time: which bear load and for how long, and which have left the ground."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

from tarsus.control.contact.footing import Footing, sunk_at
from tarsus.control.readings import RollPitch
from tarsus.control.sensing.contact_estimator import ContactEstimator, Contacts

__all__ = ["FootContacts"]

# One flag for each foot.
_Feet: TypeAlias = Sequence[bool]

# Time without contact after which a foot has left the ground, or has lost it [s].
_LOST = 0.03
# A foot still counts as support this long after its contact is lost [s].
_GRACE = 0.1
# How long a foot that is about to lift off still stands without contact: its load may be gone before [s].
_LEAVES = 0.15
# How long a foot that should stand searches for the ground, and the body is lowered for it [s].
_SEARCH = 1.5
# Time in contact after which a foot has stood, and may lose contact for a while and still be support [s].
_SETTLED = 0.05
# Least rise of the body at a foot for its switch to be taken as stuck open; the same where the other feet do not hold
# the robot [m].
_LIFTS, _LIFTS_ALONE = 0.003, 0.008
# How long other feet lose contact, while a foot that should stand has none, before its switch is taken as stuck open
# [s]; greatest factor by which that time counts more where the foot lifts the body more.
_OPEN_AFTER, _MOST_LIFT = 0.4, 4.0
# Factor by which time counts more where a leg holds up a foot that has never touched the ground.
_HELD_UP = 2.0
# How long the robot stays up on feet that do not hold it before another foot is taken to hold it [s]; how far it moves
# at that foot if it tips instead [m].
_UNHELD, _TIPS = 0.15, 0.012
# Least time without contact of that foot: the switch of a foot that has just lost contact works [s].
_NEVER = 0.3
# How far a robot that does not tip may sink at a foot without contact, besides how much deeper ground may be [m].
_SINKS = 0.01
# How fast it may sink besides, over the age of the contacts, at a foot whose switch is taken as stuck open [m/s].
_FALLS = 0.4
# Swings in a row, or retreats from an obstacle, without loss of contact after which a switch is taken as stuck closed.
_STAYS_CLOSED = 3
# Landings without contact after which a switch is surely stuck open: a shin does not rest on an edge for that long.
_SURELY_OPEN = 2
# Fewer feet cannot bear the robot: something else holds it.
_FEWEST = 2


class FootContacts:
    """What the estimated contacts tell of each foot.

    Parameters
    ----------
    legs, scale : int, float
        Number of legs; factor by which lengths are reduced on short legs, 0 to 1.

    Attributes
    ----------
    estimator : ContactEstimator
        Estimates the contacts.
    lifted : list of bool
        Whether a swinging foot has been without contact since it lifted off.
    standing : list of bool
        Whether each foot that should stand does; the shortest interruptions do not count.
    age, estimated : float, bool
        Age of the contacts, or by how much the joints lag more than usual where that is longer [s]; whether contacts
        are estimated by joint angles.
    sunk : list of float
        How far the body has sunk by its tilt at each foot since that foot lost contact [m].
    hovering : list of int
        Legs whose feet have landed above the ground because their switches are stuck closed: they bear no load.
    """

    def __init__(self, legs: int, *, scale: float = 1.0) -> None:
        self.estimator = ContactEstimator(legs)
        self.lifted, self.standing, self.age = [False] * legs, [True] * legs, 0.0
        self.hovering = list[int]()
        # Which feet were to stand; in how many swings in a row each switch has stayed closed; how often each foot has
        # landed since its switch was taken as stuck open.
        self._down: _Feet = [True] * legs
        self._closed, self._landings = [_STAYS_CLOSED] * legs, [0] * legs
        self.estimated, self._scale, self._unheld, self._tilt = False, scale, 0.0, (0.0, 0.0)
        # The last tilt that was measured, and that of each foot when it lost its contact [rad].
        self._last: RollPitch | None = None
        self._tilts, self.sunk = [(0.0, 0.0)] * legs, [0.0] * legs
        # Which feet have touched the ground since the start.
        self._touched = [False] * legs
        # By foot: time without contact, evidence of a switch stuck open, time in contact, time of search [s].
        self._without, self._evidence, self._settled, self._searched = ([0.0] * legs for _ in range(4))

    def step(
        self, readings: Contacts, down: _Feet, dt: float, *, count: int, lands: _Feet, leaving: _Feet, rests: bool
    ) -> None:
        """Take in the contacts of one tick, or of several in which they are the same.

        Parameters
        ----------
        readings : Contacts
            Which feet touch the ground, as measured.
        down : sequence of bool
            Which feet should stand.
        dt, count : float, int
            Time since the last tick [s]; number of ticks.
        lands : sequence of bool
            Which of them search for the ground: not those on their way past an obstacle, and none of a carried robot.
        leaving : sequence of bool
            Which feet are to lift off soon: those that have stood are not lowered where others take their load.
        rests : bool
            Whether the robot stands still, held by the feet that bear load: feet that have stood then stay.
        """
        self.estimator.step(readings, dt, count=count)
        for leg, (on, leaves) in enumerate(zip(down, leaving, strict=True)):
            if self.estimator.known[leg] and not self.estimator.touching[leg]:
                # A foot on the ground has lost contact in the last of the ticks: before that, all was as planned.
                self._without[leg] += dt / count if on and not self._without[leg] else dt
            else:
                self._without[leg], self._evidence[leg], self._landings[leg] = 0.0, 0.0, 0
                self._settled[leg] += dt
                self._touched[leg] |= self.estimator.known[leg] and self.estimator.reads(leg)
            if not on:
                self._settled[leg] = 0.0
                if self.is_open(leg):
                    self._tilts[leg] = self._last or (0.0, 0.0)
            if on and not self._down[leg]:
                self._landings[leg] += self.is_open(leg)
                self._closed[leg] += not self.lifted[leg]
            if self._without[leg] > _LOST:
                self._closed[leg] = 0
            self.lifted[leg] = not on and (self.lifted[leg] or self._without[leg] > _LOST)
            stays = rests or (leaves and self._without[leg] < _LEAVES)
            self.standing[leg] = self._bears(leg) or (stays and self._settled[leg] > _SETTLED)
            # Feet of a robot that rests are hardly lowered: they wait, and do not search.
            searches = lands[leg] and not (rests or self.standing[leg])
            self._searched[leg] = (self._searched[leg] + dt) * searches
        self._down = down

    def find_open(
        self, footing: Footing, tilt: RollPitch | None, dt: float, *, low: list[bool], depths: Sequence[float]
    ) -> None:
        """Find a switch that is stuck open: its foot pushes on the ground and lifts the body off other feet.

        Parameters
        ----------
        footing : Footing
            The feet that should stand.
        tilt, dt : (roll, pitch) or None, float
            Measured, off the attitude to keep [rad], None where it is not; time since the last tick [s].
        low, depths : list of bool, sequence of float
            Which feet may bear load that is not felt. Where one of those that should stand may not, only a foot that
            lifts a body which the others do not hold is found. How far below the expected ground the feet are [m]: the
            deepest is the one that lifts the body.
        """
        self._follow(footing.places, tilt)
        alone = self._lifting_alone(footing._replace(down=low), tilt)
        footing = footing._replace(down=low if low == footing.down else [False] * len(low))
        if lifts := alone or self._lifting(footing.down, tilt):
            leg = max(lifts, key=depths.__getitem__)
            self._evidence[leg] += dt * lifts[leg]
        if tilt is not None:
            self._balance(footing, tilt, dt)

    def _follow(self, places: Sequence[complex], tilt: RollPitch | None) -> None:
        """Find how far the body has sunk at each foot since that foot lost contact."""
        first, self._last = self._last is None, tilt or self._last
        last = self._last or (0.0, 0.0)
        for leg, place in enumerate(places):
            if first or self._without[leg] <= 0.0:
                self._tilts[leg] = last
            self.sunk[leg] = sunk_at(place, last, self._tilts[leg])

    def _lifting(self, down: Sequence[bool], tilt: RollPitch | None) -> dict[int, float]:
        """Return the weight of evidence, by leg, that a foot without contact lifts the body as others lose theirs."""
        if not any(on and 0.0 < time <= _GRACE for on, time in zip(down, self._without, strict=True)):
            return {}
        legs = [leg for leg, on in enumerate(down) if on and self._without[leg] > _GRACE]
        if tilt is None:
            return dict.fromkeys(legs, 1.0)
        lifts = {leg: -self.sunk[leg] / (self._scale * _LIFTS) for leg in legs}
        return {leg: min(lift, _MOST_LIFT) for leg, lift in lifts.items() if lift >= 1.0}

    def _lifting_alone(self, footing: Footing, tilt: RollPitch | None) -> dict[int, float]:
        """Return the same for feet that lift a body which the others do not hold without, but would with that foot."""
        bears = [leg for leg, on in enumerate(footing.down) if on and self._bears(leg)]
        without = [leg for leg, on in enumerate(footing.down) if on and not self._bears(leg)]
        least = self._scale * _LIFTS_ALONE
        # A robot that sinks at one foot without contact is not held up by another one.
        sinks = any(self.sunk[leg] > least / 2 for leg in without)
        if tilt is None or not without or sinks or footing.held_by(bears):
            return {}
        lifts = [leg for leg in without if min(-self.sunk[leg], -sunk_at(footing.places[leg], tilt)) > least]
        holding = [leg for leg in lifts if self._without[leg] > _UNHELD and footing.held_by([*bears, leg])]
        return dict.fromkeys(holding, _MOST_LIFT)

    def _balance(self, footing: Footing, tilt: RollPitch, dt: float) -> None:
        """Find a switch that is stuck open: a robot that does not tip stands on a foot that it does not feel."""
        missing = [leg for leg, on in enumerate(footing.down) if on and not self.standing[leg]]
        standing = [leg for leg, on in enumerate(footing.down) if on and self.standing[leg]]
        if not missing or footing.held_by(standing):
            self._unheld = 0.0
        elif len(standing) >= _FEWEST:
            longest = max(missing, key=self._without.__getitem__)
            if self._unheld <= 0.0 or abs(sunk_at(footing.places[longest], tilt, self._tilt)) > self._scale * _TIPS:
                self._unheld, self._tilt = 0.0, tilt
            self._unheld += dt
            if self._unheld > _UNHELD and self._without[longest] > _NEVER:
                self._evidence[longest], self.standing[longest] = math.inf, True

    def held_up(self, leg: int, dt: float) -> None:
        """Take note that a leg holds its foot up for a time [s]: if it has never touched, its switch is stuck open."""
        self._evidence[leg] += _HELD_UP * dt * (not self._touched[leg])

    def tips(self, footing: Footing, deeper: float) -> int | None:
        """Return the leg at whose foot the robot tips, if it does: it sinks there, and the other feet do not hold it.

        Parameters
        ----------
        footing, deeper : Footing, float
            The feet that should stand; how much deeper ground may be than expected [m].
        """
        most = deeper + self._scale * _SINKS
        legs = [leg for leg, on in enumerate(footing.down) if on]
        for leg in legs:
            # A robot does not sink at a foot that stands: the switch is not stuck, but a shin rests on an edge.
            unsure = self.is_open(leg) and self._landings[leg] < _SURELY_OPEN
            if unsure and self.sunk[leg] > most + _FALLS * self.age:
                self._evidence[leg] = 0.0
        sinks = [leg for leg in legs if not self._bears(leg) and self.sunk[leg] > most and self.is_known(leg)]
        bears = [leg for leg in legs if self._bears(leg)]
        tips = sinks and bears and not footing.held_by(bears)
        return max(sinks, key=self.sunk.__getitem__) if tips else None

    def forget_open(self) -> None:
        """Forget which switches are taken as stuck open: a robot that is carried is tilted by what carries it."""
        self._evidence, self._landings, self._unheld = [0.0] * len(self._evidence), [0] * len(self._landings), 0.0

    def is_open(self, leg: int) -> bool:
        """Return whether a switch is taken as stuck open: other feet, or its leg, tell of a contact."""
        return self._evidence[leg] > _OPEN_AFTER

    def is_known(self, leg: int) -> bool:
        """Return whether a foot's contact is measured, by a switch that works."""
        return self.estimator.known[leg] and not (self.is_open(leg) or self.is_closed(leg))

    def stands(self, leg: int) -> bool:
        """Return whether a foot that should stand does, as far as is known."""
        return self.standing[leg] and leg not in self.hovering

    def has_opened(self, leg: int) -> bool:
        """Return whether a switch has opened since the foot last lifted off, or in the swing before."""
        return self._closed[leg] == 0

    def is_closed(self, leg: int) -> bool:
        """Return whether a switch is taken as stuck closed: its contact does not cease while the foot swings."""
        return self._closed[leg] >= _STAYS_CLOSED

    def draws_back(self, leg: int) -> None:
        """Take note of a foot that draws back from an obstacle: contact ceases then, unless its switch is stuck."""
        self._closed[leg] = min(self._closed[leg] + 1, _STAYS_CLOSED)

    def _bears(self, leg: int) -> bool:
        """Return whether a foot bears load; the shortest interruptions do not count."""
        return self._without[leg] <= _LOST or self.is_open(leg)

    def is_in_contact(self, leg: int) -> bool:
        """Return whether a foot's contact is measured now; True where nothing is known."""
        return self._without[leg] <= 0.0 and leg not in self.hovering

    def touches(self, leg: int) -> bool:
        """Return whether a foot bears load now, also where its switch is taken as stuck open."""
        return self.is_in_contact(leg) or (self.is_open(leg) and leg not in self.hovering)

    def feels(self, leg: int) -> bool:
        """Return whether a foot touches the side of an obstacle, or rests on it: estimated contacts do not tell."""
        return self.estimator.touching[leg] and not self.estimated

    def seeks(self, leg: int) -> bool:
        """Return whether a foot that should stand does not, and has not searched for the ground for long."""
        return not self.standing[leg] and self._searched[leg] < _SEARCH

    def supports(self, leg: int) -> bool:
        """Return whether a foot that should stand counts as support."""
        grace = _GRACE if self._settled[leg] > _SETTLED else 0.0
        return (self._without[leg] <= grace or self.is_open(leg)) and leg not in self.hovering
