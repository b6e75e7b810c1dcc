"""Draw the figures of the documentation: `make figures`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import tarsus
from draw_felt_feet import plot_felt_feet
from draw_films import draw_films
from draw_hill import plot_hill
from draw_states import plot_states
from draw_terrains import plot_terrains
from tarsus.hardware.bringup.reference_pose import reference_angles
from tarsus.report.angles import plot_angles
from tarsus.report.animation import animate
from tarsus.report.footpaths import plot_footpaths
from tarsus.report.gait_diagram import plot_gait
from tarsus.report.skeleton import plot_robot
from tarsus.report.style import save_figure
from tarsus.report.timeline import plot_timeline
from tarsus.scenario.file import load_scenario
from tarsus.scenario.runner import run_scenario
from tarsus.simulation import compare
from tarsus.simulation.terrain import Blocks
from tarsus.simulation.truth.as_motion import trace_motion

FIGURES = Path(__file__).parent / "figures"


def standing(robot: tarsus.Robot) -> tuple[Any, tarsus.Pose]:
    body_height = tarsus.default_body_height(robot)
    feet = tarsus.default_stance(robot) + np.array([0, 0, body_height])
    body = tarsus.Pose(position=np.array([0, 0, body_height]))
    return tarsus.inverse_kinematics(robot, feet, body).require().angles, body


def animate_physics(robot: tarsus.Robot) -> None:
    """A planned walk over blocks, as physics makes it; small, as it is the first that readers load."""
    blocks = Blocks(rise=0.03, size=0.1, clear=0.3, seed=3)
    gait, path = tarsus.Gait.named("tripod"), tarsus.straight_path(0.7)
    plan = tarsus.plan_walk(robot, gait, path, swing_height=0.045, body_height=0.12)
    truth = compare(plan, terrain=blocks)
    motion = trace_motion(truth.trace, plan)
    animate(motion, FIGURES / "physics.gif", max_duration=4.5, size=(500, 390), height=blocks.height)


def main() -> None:
    FIGURES.mkdir(exist_ok=True)
    strider = tarsus.load_robot("strider")
    tripod = tarsus.Gait.named("tripod")
    walk = tarsus.plan_walk(strider, tripod, tarsus.straight_path(1.0))
    animate_physics(strider)
    draw_films()
    save_figure(plot_angles(walk), FIGURES / "angles.png")
    save_figure(plot_gait(walk), FIGURES / "gait.png")
    curve = tarsus.plan_walk(strider, tarsus.Gait.named("ripple"), tarsus.curved_path(np.pi / 2, (0, 0.4)))
    save_figure(plot_footpaths(curve), FIGURES / "footpaths.png")
    for name in tarsus.list_robots():
        robot = tarsus.load_robot(name)
        angles, body = standing(robot)
        save_figure(plot_robot(robot, angles, body=body), FIGURES / f"robot-{name}.png")
    save_figure(plot_robot(strider, reference_angles(strider)), FIGURES / "reference-pose.png")
    day = load_scenario(FIGURES.parents[1] / "examples" / "whole-day.toml")
    save_figure(plot_timeline(run_scenario(day)), FIGURES / "timeline.png")
    save_figure(plot_hill(), FIGURES / "hill.png")
    save_figure(plot_felt_feet(), FIGURES / "felt-feet.png")
    save_figure(plot_states(), FIGURES / "states.png")
    save_figure(plot_terrains(), FIGURES / "terrains.png")
    limp = np.radians(np.tile([0.0, 20.0, -60.0], (6, 1)))
    limp[:3] = np.radians([0.0, -30.0, -30.0])
    rest = tarsus.resting_pose(strider, limp)
    save_figure(
        plot_robot(strider, limp, body=rest.body, contacts=rest.contacts, title=rest.describe()), FIGURES / "rest.png"
    )
    print(f"drew {len(list(FIGURES.glob('*')))} figures into {FIGURES}")


if __name__ == "__main__":
    main()
