"""Draw the figures of the documentation: `make figures`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import tarsus
from draw_hill import plot_hill
from draw_states import plot_states
from tarsus.report.angles import plot_angles
from tarsus.report.animation import animate
from tarsus.report.footpaths import plot_footpaths
from tarsus.report.gait_diagram import plot_gait
from tarsus.report.skeleton import plot_robot
from tarsus.report.style import save_figure
from tarsus.report.timeline import plot_timeline
from tarsus.scenario.file import load_scenario
from tarsus.scenario.runner import run_scenario

FIGURES = Path(__file__).parent / "figures"


def standing(robot: tarsus.Robot) -> tuple[Any, tarsus.Pose]:
    body_height = tarsus.default_body_height(robot)
    feet = tarsus.default_stance(robot) + np.array([0, 0, body_height])
    body = tarsus.Pose(position=np.array([0, 0, body_height]))
    return tarsus.inverse_kinematics(robot, feet, body).require().angles, body


def main() -> None:
    FIGURES.mkdir(exist_ok=True)
    strider = tarsus.load_robot("strider")
    tripod = tarsus.Gait.named("tripod")
    walk = tarsus.plan_walk(strider, tripod, tarsus.straight_path(1.0))
    animate(walk, FIGURES / "walk.gif", max_duration=6.0)
    save_figure(plot_angles(walk), FIGURES / "angles.png")
    save_figure(plot_gait(walk), FIGURES / "gait.png")
    curve = tarsus.plan_walk(strider, tarsus.Gait.named("ripple"), tarsus.curved_path(np.pi / 2, (0, 0.4)))
    save_figure(plot_footpaths(curve), FIGURES / "footpaths.png")
    for name in tarsus.list_robots():
        robot = tarsus.load_robot(name)
        angles, body = standing(robot)
        save_figure(plot_robot(robot, angles, body=body), FIGURES / f"robot-{name}.png")
    day = load_scenario(FIGURES.parents[1] / "examples" / "whole-day.toml")
    save_figure(plot_timeline(run_scenario(day)), FIGURES / "timeline.png")
    save_figure(plot_hill(), FIGURES / "hill.png")
    save_figure(plot_states(), FIGURES / "states.png")
    limp = np.radians(np.tile([0.0, 20.0, -60.0], (6, 1)))
    limp[:3] = np.radians([0.0, -30.0, -30.0])
    rest = tarsus.resting_pose(strider, limp)
    save_figure(
        plot_robot(strider, limp, body=rest.body, contacts=rest.contacts, title=rest.describe()), FIGURES / "rest.png"
    )
    print(f"drew {len(list(FIGURES.glob('*')))} figures into {FIGURES}")


if __name__ == "__main__":
    main()
