"""Contacts of feet, taken in with what is usual besides them."""

from tarsus.control.contact.footing import Footing

FEET = [0.27 + 0.15j, 0.31j, -0.27 + 0.15j, -0.27 - 0.15j, -0.31j, 0.27 - 0.15j]
STANDING = Footing(FEET, [True] * 6, 0j, 0.1)


def take_in(contacts, readings, down, dt, *, count=1, lands=None, leaving=None, rests=False, carried=False):
    """Take in contacts of feet none of which lifts off soon or passes an obstacle, of a robot that walks."""
    lands, leaving = down if lands is None else lands, [False] * len(down) if leaving is None else leaving
    lands = [on and not carried for on in lands]
    contacts.step(readings, down, dt, count=count, lands=lands, leaving=leaving, rests=rests)


def find_open(contacts, footing, tilt, dt, *, low=None, depths=None):
    """Find switches that stay open: the feet that should stand may lift the body, the one without contact first."""
    contacts.find_open(footing, tilt, dt, low=low or footing.down, depths=depths or contacts._without)
