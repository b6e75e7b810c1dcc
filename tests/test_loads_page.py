"""docs/loads.md: the table matches the functions, and the code runs."""

import re
from pathlib import Path

import numpy as np
import pytest

from sample_loads import sample_loads, sample_motion
from tarsus.load.loads import joint_loads
from tarsus.load.torque import joint_torques
from tarsus.load.verdict import class_of
from tarsus.robot.robot import JOINTS

PAGE = Path(__file__).parents[1] / "docs" / "loads.md"
TEXT = PAGE.read_text(encoding="utf-8")
OUTCOMES = {
    "burnt-mg996r": "femur servos dead in days",
    "burnt-5kg": "burnt while standing",
    "phantomx": "alive",
    "strider": "alive",
}


def _worst(factor):
    joint = JOINTS[int(np.argmin(factor.min(0)))]
    return f"{factor.min():.2f} ({joint})"


def six_feet(name):
    """Smallest factor when standing on all feet, at the start of the walk."""
    motion = sample_motion(name)
    start = motion.body[0]
    torques, _ = joint_torques(motion.robot, motion.angles[0], start, np.ones(6, dtype=bool))
    stall = np.array([[servo.stall_torque for servo in leg] for leg in motion.robot.servos])
    with np.errstate(divide="ignore"):
        return stall / np.abs(torques)


def known_robots():
    """Rows of the table."""
    lines = [
        "| robot | outcome | tripod walk | class | thermal load | 30 mm higher | class | on six feet | class |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, outcome in OUTCOMES.items():
        walk = sample_loads(name)
        motion = sample_motion(name, body_height=walk.motion.body_height + 0.03)
        high, standing = joint_loads(motion.robot, motion).factor, six_feet(name)
        thermal_load = (5 * walk.rms / walk.stall_torque).max()
        cells = [name, outcome, _worst(walk.factor), class_of(walk.factor.min())]
        cells += [
            f"{thermal_load * 100:.0f} %",
            _worst(high),
            class_of(high.min()),
            _worst(standing),
            class_of(standing.min()),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def test_table_of_known_robots():
    block = re.search(r"<!-- table: known robots -->\n(.*?)<!-- end -->", TEXT, flags=re.DOTALL)
    assert block[1].splitlines() == known_robots()


def test_statements_about_the_phantomx():
    walk = sample_loads("phantomx")
    assert walk.factor.min() < 1.5
    motion, high = sample_motion("phantomx"), sample_motion("phantomx", body_height=0.12)
    out, nearer = (
        np.linalg.norm((walk.feet[0] - walk.body.position[0] - walk.robot.mount_position)[1, :2])
        for walk in (motion, high)
    )
    words = " ".join(TEXT.split())
    assert f"{out * 1000:.0f} mm from the coxa axis" in words
    assert f"At a body height of 120 mm the distance is {nearer * 1000:.0f} mm" in words
    assert nearer - motion.robot.coxa[1] < (out - motion.robot.coxa[1]) / 2
    short = sample_motion("phantomx", stroke=0.02)
    assert (
        f"instead of {motion.stroke * 1000:.0f} mm the factor is {joint_loads(short.robot, short).factor.min():.2f}"
        in TEXT
    )
    fraction = walk.forces[..., 2].max() / walk.weight
    assert f"a middle leg carries {fraction:.0%}".replace("%", " %") in TEXT
    assert walk.worst(1) in (1, 4)


@pytest.mark.parametrize("block", re.findall(r"```python\n(.*?)```", TEXT, flags=re.DOTALL))
def test_code_runs(block, capsys):
    exec(compile(block, str(PAGE), "exec"), {})
    assert capsys.readouterr().out
