"""`tarsus handbook`: the hand calculation of the joint torques, compared with statics."""

from __future__ import annotations

import click

from tarsus.cli.output import print_json, show
from tarsus.cli.values import examples, json_option, number_option, robot_argument

__all__ = ["handbook"]


@click.command(
    short_help="Hand calculation of joint torques (source 004), and statics.",
    epilog=examples(
        "tarsus handbook strider",
        "tarsus handbook strider --gait wave --factor 2",
        "tarsus handbook strider --as-printed",
        "tarsus handbook phantomx --body-height 130 --json",
    ),
)
@robot_argument
@click.option("--gait", metavar="NAME", help="Gait, which determines the number of feet down.  [default: the robot's]")
@number_option("--factor", "N", "Safety factor on the torques.", default=3.0, show_default=True, above=0)
@number_option("--acceleration", "M/S2", "Acceleration of the body.", default=1.0, show_default=True, above=0)
@number_option("--gravity", "M/S2", "Gravity; 9.8 in the source.", default=9.8, show_default=True, above=0)
@number_option("--body-height", "MM", "Body height of the walk it is compared with.  [default: the robot's]")
@click.option("--as-printed", is_flag=True, help="Reproduce the errors of source 004; without the comparison.")
@json_option
def handbook(
    robot: str,
    gait: str | None,
    factor: float,
    acceleration: float,
    gravity: float,
    body_height: float | None,
    as_printed: bool,
    as_json: bool,
) -> int:
    """Calculate the joint torques by hand, as source 004 does, and compare them with statics.

    Every line is printed as a formula, with its numbers. The comparison is with the torques over a planned walk, which
    follow from the contact forces; use those of tarsus loads for sizing.
    """
    from tarsus.gait.gait import Gait
    from tarsus.load.handbook.method import handbook as calculate
    from tarsus.load.handbook.statics import compare_with_statics
    from tarsus.report.handbook_summary import hand_table, handbook_notes, handbook_summary
    from tarsus.robot.file import load_robot

    loaded = load_robot(robot)
    walked = Gait.named(gait or loaded.gait.name, legs=loaded.legs)
    hand = calculate(
        loaded,
        feet_down=walked.fewest_feet_down,
        gravity=gravity,
        acceleration=acceleration,
        safety_factor=factor,
        corrected=not as_printed,
    )
    comparison = None
    if not as_printed:
        comparison = compare_with_statics(
            loaded,
            gait=walked,
            body_height=None if body_height is None else body_height / 1000,
            gravity=gravity,
            acceleration=acceleration,
            safety_factor=factor,
        )
    summary = handbook_summary(hand, comparison)
    if as_json:
        print_json(summary)
        return 0
    torques, notes = summary["torque_with_factor_nm"], handbook_notes(summary)
    show(summary["title"], hand_table(summary), *notes, *([""] if notes else []))
    show(f"torques with factor {factor:g}: {', '.join(f'{joint} {torques[joint]:.3f} N m' for joint in torques)}")
    if summary["sentences"]:
        show("", f"compared with statics over a walk in the {walked.name} gait:", *summary["sentences"])
    return 0
