"""Commands without a bus: tables of a walk and a pose, and a cycle for firmware."""

import csv
import dataclasses
import re
import subprocess

import numpy as np
import pytest

import tarsus
from sample_commands import run, run_json
from sample_loads import sample_motion
from tarsus.errors import InputError
from tarsus.hardware import Calibration, new_calibration, nominal_calibration
from tarsus.hardware.pulses.gait_cycle import GaitCycle, gait_cycle, gait_cycle_header
from tarsus.hardware.pulses.table import whole_commands

STRIDER = tarsus.load_robot("strider")


def write(kind="pca9685"):
    made = nominal_calibration(STRIDER, "strider", kind=kind)
    made.save("c.toml")
    return made


def rows(path="pulses.csv"):
    with open(path, encoding="utf-8", newline="") as file:
        head, *found = csv.reader(file)
    return head, np.array(found, dtype=float)


@pytest.mark.parametrize(("kind", "unit", "worst"), [("pca9685", "us", 0.08), ("feetech-sts", "ticks", 0.05)])
def test_a_walk_becomes_commands_that_convert_back(kind, unit, worst, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = write(kind)
    assert run("walk", "strider", "--distance", "300", "--rate", "50", "--pulses", "c.toml").exit_code == 0
    head, found = rows()
    assert head[:3] == ["time_s", f"LF_coxa_{unit}", f"LF_femur_{unit}"]
    motion = sample_motion()
    np.testing.assert_allclose(found[:, 0], motion.time, atol=1e-4)
    angles = made.angles(found[:, 1:].reshape(-1, 6, 3))
    assert np.degrees(np.abs(angles - motion.angles)).max() < worst
    np.testing.assert_array_equal(found[:, 1:], found[:, 1:].round())


def table(text, name):
    return [
        [int(n) for n in re.findall(r"\d+", row)] for row in re.findall(r"\{([\d, ]+)\}", text.split(f"{name}[")[1])
    ]


@pytest.mark.no_cover
@pytest.mark.parametrize(
    "path", [("--distance", "300"), ("--curve", "40", "--centre", "0,300"), ("--twist", "20,5,4", "--duration", "2")]
)
def test_a_cycle_for_firmware_repeats_and_walks_like_the_plan(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = write()
    assert run("walk", "strider", *path, "--out", "w", "--no-animation", "--pulses", "c.toml").exit_code == 0
    text = (tmp_path / "w" / "gait_cycle.h").read_text(encoding="ascii")
    cycle = np.array(table(text, "gait_cycle")).reshape(-1, 6, 3)
    frames, frame = (int(re.search(rf"{name} (\d+)", text)[1]) for name in ("GAIT_FRAMES", "GAIT_FRAME_US"))
    assert len(cycle) == frames
    angles = made.angles(cycle)
    steps = np.abs(np.diff(np.concatenate([angles, angles[:1]]), axis=0)).max(axis=(1, 2))
    # From the last frame to the first is no greater step than within the cycle.
    assert steps[-1] <= steps[:-1].max() + 0.01
    feet = tarsus.forward_kinematics(STRIDER, angles)[..., 3, :]
    swing = feet[..., 2] > feet[..., 2].min() + 0.003
    assert (swing.sum(axis=0) > 0.3 * frames).all()
    assert frame == pytest.approx(20_000, rel=0.05)
    assert table(text, "gait_numbers")[0] == [*range(18)]


def test_the_header_compiles_and_holds_the_same_numbers(tmp_path):
    made = nominal_calibration(STRIDER, "strider", kind="servo2040")
    motion = tarsus.plan_walk(STRIDER, tarsus.Gait.named("tripod"), tarsus.straight_path(1.5), rate=50)
    cycle = gait_cycle(motion)
    (tmp_path / "gait_cycle.h").write_text(gait_cycle_header(made, cycle, title="a title"), encoding="ascii")
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "gait_cycle.h"\nint main(void) { for (int i = 0; i < GAIT_FRAMES; i++)'
        ' for (int j = 0; j < GAIT_SERVOS; j++) printf("%u ", gait_cycle[i][j]); return gait_numbers[0]; }'
    )
    compiler = ["cc", "-std=c99", "-Wall", "-Werror", "main.c", "-o", "main"]
    subprocess.run(compiler, cwd=tmp_path, check=True)
    printed = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    expected = whole_commands(made, cycle.angles)
    np.testing.assert_array_equal(np.array(printed.split(), dtype=int).reshape(expected.shape), expected)


def test_servos_of_two_boards_have_the_number_of_theirs():
    made = nominal_calibration(STRIDER, "strider", kind="ssc32")
    other = dataclasses.replace(made.buses[0], name="other")
    rows = [
        [dataclasses.replace(joint, bus="other", number=joint.number - 9) if leg > 2 else joint for joint in row]
        for leg, row in enumerate(made.joints)
    ]
    made = made.replace(buses=(made.buses[0], other), joints=tuple(map(tuple, rows)))
    text = gait_cycle_header(made, GaitCycle(0.02, sample_motion().angles[:3]), title="two boards")
    assert table(text, "gait_boards")[0] == [0] * 9 + [1] * 9
    assert table(text, "gait_numbers")[0] == [*range(9), *range(9)]


def test_a_walk_without_a_constant_speed_has_no_cycle():
    with pytest.raises(InputError, match=r"no two cycles of .* at constant speed"):
        gait_cycle(sample_motion())


def test_a_pose_becomes_commands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = write()
    code, found = run_json("pose", "strider", "--z", "20", "--pulses", "c.toml")
    assert code == 0
    assert found["files"] == ["pulses.csv"]
    angles = made.angles(np.array(found["commands"]))
    feet = tarsus.forward_kinematics(STRIDER, angles)[..., 3, 2]
    np.testing.assert_allclose(feet, -0.130, atol=5e-4)
    np.testing.assert_array_equal(rows()[1][0, 1:], np.ravel(found["commands"]))
    shown = run("pose", "strider", "--z", "20", "--pulses", "c.toml").stdout
    assert f"front left    {found['commands'][0][0]} us" in shown
    assert "wrote pulses.csv" in shown
    assert run("pose", "strider", "--z", "200", "--pulses", "c.toml").exit_code == 1


def test_commands_beyond_the_limits_are_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = write().with_joint(4, 2, soft_limits=(-1.0, 0.0))
    made.save("c.toml")
    result = run("walk", "strider", "--pulses", "c.toml")
    assert result.exit_code == 2
    assert re.search(
        r"at \d\.\d\d s the middle right tibia is at .* deg; the calibration allows -57.3 to", result.stderr
    )
    with pytest.raises(InputError, match="front left coxa is at nan deg"):
        whole_commands(made, np.full((6, 3), np.nan))
    result = run("walk", "mithi", "--pulses", "c.toml")
    assert "c.toml is the calibration of strider, which is not the robot 'mithi'" in result.stderr
    new_calibration(STRIDER, "strider").save("n.toml")
    for command in (["pose", "strider"], ["walk", "strider", "--distance", "1e9"]):
        assert "not calibrated yet; tarsus bring-up" in run(*command, "--pulses", "n.toml").stderr
    assert Calibration.load("c.toml").joints == made.joints


def test_whole_commands_stay_within_limits_that_are_no_whole_numbers():
    made = nominal_calibration(STRIDER, "strider", kind="servo2040").with_joint(0, 0, limits=(1400.6, 1599.4))
    ends = made.limits.transpose(2, 0, 1)
    commands = whole_commands(made, ends)
    assert set(commands[:, 0, 0].tolist()) == {1401, 1599}
    assert (commands >= made.command_limits[..., 0]).all()
    assert (commands <= made.command_limits[..., 1]).all()
