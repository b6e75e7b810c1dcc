"""The command line: parse, call, print. One command a file; nothing heavy is imported before a command runs.

Exit codes: 0 where all that was asked for is possible, 1 where it isn't, 2 where it was asked for wrongly, 70 for a
bug, 130 where it was interrupted.
"""

from __future__ import annotations

try:
    import click
except ImportError:  # the package without its extra: say which
    raise SystemExit("the command line needs click and rich: pip install 'tarsus[cli]'") from None

from tarsus import __version__
from tarsus.cli.drive import drive
from tarsus.cli.group import TarsusGroup
from tarsus.cli.loads import loads
from tarsus.cli.pose import pose
from tarsus.cli.rest import rest
from tarsus.cli.robots import robots
from tarsus.cli.servos import servos
from tarsus.cli.studio import studio
from tarsus.cli.values import examples
from tarsus.cli.walk import walk

__all__ = ["main"]


@click.group(
    "tarsus",
    cls=TarsusGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog=examples(
        "tarsus walk strider --out walk",
        "tarsus pose strider --pitch 5",
        "tarsus rest strider --all 0,-30,-60",
        "tarsus loads strider",
        "tarsus robots list",
    ),
)
@click.version_option(__version__, prog_name="tarsus")
def main() -> None:
    """Six-legged robots: from a robot file to joint angles, walks and pictures.

    Lengths are in mm, angles in deg, times in s. x is forward, y left, z up; angles are counter-clockwise.

    ROBOT is the name of a robot that comes with Tarsus (see: tarsus robots list) or the path of a robot file.
    """


for command in (studio, walk, drive, pose, rest, loads, servos, robots):
    main.add_command(command)
