"""Command line, with one module per command; heavy packages are imported only when a command runs.

Exit codes: 0 if the request is possible, 1 if it is not, 2 for a usage error, 70 for a bug, 130 if interrupted.
"""

from __future__ import annotations

try:
    import click
except ImportError:  # installed without the extra
    raise SystemExit("the command line needs click and rich: pip install 'tarsus[cli]'") from None

from tarsus import __version__
from tarsus.cli.bring_up import bring_up
from tarsus.cli.calibration import calibration
from tarsus.cli.check_servos import check_servos
from tarsus.cli.drive import drive
from tarsus.cli.export import export
from tarsus.cli.fk import fk
from tarsus.cli.group import TarsusGroup
from tarsus.cli.handbook import handbook
from tarsus.cli.ik import ik
from tarsus.cli.loads import loads
from tarsus.cli.pose import pose
from tarsus.cli.rest import rest
from tarsus.cli.robots import robots
from tarsus.cli.run import run
from tarsus.cli.servos import servos
from tarsus.cli.simulate import simulate
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
        "tarsus ik strider --leg LF 230 130 -110",
        "tarsus rest strider --all 0,-30,-60",
        "tarsus loads strider",
        "tarsus robots list",
    ),
)
@click.version_option(__version__, prog_name="tarsus")
def main() -> None:
    """Six-legged robots: from a robot file to joint angles, walks and servo loads.

    Lengths are in mm, angles in deg, times in s. x is forward, y left, z up; angles are counter-clockwise.

    ROBOT is the name of a robot that comes with Tarsus (see: tarsus robots list) or the path of a robot file.
    """


for command in (
    studio,
    walk,
    drive,
    simulate,
    run,
    bring_up,
    check_servos,
    pose,
    fk,
    ik,
    rest,
    loads,
    servos,
    handbook,
    robots,
    calibration,
    export,
):
    main.add_command(command)
