"""Motion sequences: timed motions of the whole robot from rest to rest, and their playback.

The public names are those listed in ``__all__``. `tarsus.control.startup` builds sequences from `stage`; everything
else is private to the package.
"""

from tarsus.control.sequence.player import SequencePlayer
from tarsus.control.sequence.sequence import MotionSequence, SequenceSample

__all__ = ["MotionSequence", "SequencePlayer", "SequenceSample"]
