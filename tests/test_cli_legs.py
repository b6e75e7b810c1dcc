"""`tarsus fk`, `tarsus ik` and `tarsus handbook`: numbers match Python; one leg or all; both frames."""

import numpy as np
import pytest

from robots import plain_hexapod
from sample_commands import run, run_json
from tarsus import (
    compare_with_statics,
    coxa_frames,
    forward_kinematics,
    handbook,
    inverse_kinematics,
    load_robot,
    save_robot,
)

STRIDER = load_robot("strider")
# With millimetres and degrees to 6 decimal places.
ROUNDING = 1e-6


def angles_of_all():
    return np.random.default_rng(1).uniform((-40, 0, -120), (40, 60, -60), (6, 3)).round(2)


def test_fk_of_all_legs_is_forward_kinematics():
    degrees = angles_of_all()
    code, document = run_json("fk", "strider", *degrees.ravel())
    points = forward_kinematics(STRIDER, np.radians(degrees))
    assert code == 0
    assert document["legs"] == list(STRIDER.leg_codes)
    np.testing.assert_allclose(document["body_frame_mm"], points * 1000, atol=ROUNDING)
    np.testing.assert_allclose(document["feet_mm"], points[:, 3] * 1000, atol=ROUNDING)
    in_coxa = coxa_frames(STRIDER).inverse() @ points[:, 3]
    np.testing.assert_allclose(np.array(document["coxa_frame_mm"])[:, 3], in_coxa * 1000, atol=ROUNDING)


@pytest.mark.parametrize("leg", ["RM", "middle right", "rm"])
def test_fk_of_one_leg_prints_its_points_in_both_frames(leg):
    degrees = np.tile([10, 40, -100], (6, 1))
    points = forward_kinematics(STRIDER, np.radians(degrees))
    printed = run("fk", "strider", "--leg", leg, 10, 40, -100)
    assert printed.exit_code == 0
    (foot,) = [line for line in printed.stdout.splitlines() if line.strip().startswith("foot")]
    in_coxa = (coxa_frames(STRIDER).inverse() @ points[:, 3])[4]
    expected = np.concatenate([points[4, 3], in_coxa]) * 1000
    np.testing.assert_allclose([float(text) for text in foot.split()[1:]], expected, atol=0.0051)
    assert "body frame B: origin of the body, x forward, y left, z up" in printed.stdout


def test_fk_names_angles_beyond_their_limits():
    code, document = run_json("fk", "strider", "--all", "70,40,-100")
    assert code == 1
    assert document["problems"] == ["all legs: coxa angle 70 deg is outside its limits, -60 to 60 deg"]
    code, document = run_json("fk", "strider", "--leg", "LM", 70, 40, -100)
    assert document["problems"] == ["middle left: coxa angle 70 deg is outside its limits, -60 to 60 deg"]


def test_ik_takes_what_fk_prints_and_gives_the_angles_back(tmp_path):
    degrees = angles_of_all()
    file = tmp_path / "feet.json"
    file.write_text(run("fk", "strider", *degrees.ravel(), "--json").stdout, encoding="utf-8")
    code, document = run_json("ik", "strider", "--file", file)
    assert code == 0
    np.testing.assert_allclose(document["angles_deg"], degrees, atol=1e-5)
    assert set(document["reach"]) == {"OK"}


def test_ik_in_the_coxa_frame_is_that_in_the_body_frame():
    target = np.array([170.0, 20.0, -110.0])
    _, document = run_json("ik", "strider", "--all", "170,20,-110", "--frame", "coxa")
    feet = coxa_frames(STRIDER) @ np.tile(target / 1000, (6, 1))
    expected = np.degrees(inverse_kinematics(STRIDER, feet).require().angles)
    np.testing.assert_allclose(document["angles_deg"], expected, atol=ROUNDING)
    x, y, z = feet[2] * 1000
    _, one = run_json("ik", "strider", "--leg", "LR", f"{x:.9f}", f"{y:.9f}", z)
    np.testing.assert_allclose(one["angles_deg"], [expected[2]], atol=ROUNDING)


def test_ik_says_why_a_foot_cannot_reach_a_point_in_the_frame_of_the_point():
    code, document = run_json("ik", "strider", "--leg", "LF", "--frame", "coxa", 400, 0, 0)
    assert code == 1
    assert document["reach"] == ["TOO_FAR"]
    assert document["problems"] == [
        (
            "front left can't reach its target: the target is 332.0 mm from the femur axis, and femur and tibia are "
            "279.0 mm long: 53.0 mm too far. In the coxa frame C of the leg the target is (400.0, 0.0, 0.0) mm, the "
            "nearest reachable point (347.0, 0.0, 0.0) mm, 53.0 mm away"
        )
    ]
    printed = run("ik", "strider", "--leg", "LF", 500, 0, 0)
    assert printed.stdout.splitlines()[3].strip().endswith("too far")
    assert "In the body frame B the target is (500.0, 0.0, 0.0) mm" in printed.stdout
    assert "coxa frame" not in printed.stdout


def test_ik_says_where_the_other_knee_reaches():
    code, document = run_json("ik", "strider", "--all", "170,0,-110", "--frame", "coxa", "--knee", "down")
    assert code == 1
    assert len(document["problems"]) == 2
    assert document["problems"][0].startswith("no leg can reach its target: the femur angle would be ")
    assert document["problems"][1] == "all legs: reachable with the knee up"
    assert run_json("ik", "mithi", "--all", "150,0,-80", "--frame", "coxa", "--knee", "down")[0] == 0


def test_a_knee_that_the_limits_exclude_is_named(tmp_path):
    (problem,) = run_json("ik", "makeyourpet", "--leg", "LF", 150, 100, -60, "--knee", "down")[1]["problems"]
    assert problem.startswith("front left: the knee can't be down, as the tibia's limits are -161.4 and -41.4 deg")
    limits = np.tile(np.deg2rad([[-60, 60], [-100, 80], [30, 150]]), (6, 1, 1))
    femur, below = np.deg2rad([-70, 20])
    reach = 68 + 98 * np.cos(femur) + 181 * np.cos(below), 98 * np.sin(femur) + 181 * np.sin(below)
    save_robot(plain_hexapod(limits=limits), tmp_path / "down.toml")
    code, document = run_json(
        "ik", tmp_path / "down.toml", "--all", "{:.3f},0,{:.3f}".format(*reach), "--frame", "coxa"
    )
    assert code == 0
    assert document["assumed"] == [
        (
            "all legs: the knee can't be up, as the tibia's limits are 30.0 and 150.0 deg; the angles are those "
            "with the knee down"
        )
    ]
    assert "assumed: all legs: the knee can't be up" in run("pose", tmp_path / "down.toml").stdout


@pytest.mark.parametrize(
    ("args", "text"),
    [
        (("ik", "strider", 1, 2, 3), "strider needs 18: x, y, z of LF, LM, LR, RR, RM, RF; for one leg, name it with"),
        (("fk", "strider", "--leg", "LF", 1, 2), "2 angles; strider needs 3: coxa, femur, tibia of LF"),
        (("ik", "strider", "--leg", "XX", 1, 2, 3), "no leg is called 'XX'. "),
        (("ik", "strider", "--leg", "LF"), "give the coordinates either as arguments, with --all, or with --file"),
        (("fk", "strider", "--leg", "LF", "a", 2, 3), "'a' is not an angle; expected a number"),
        (("ik", "strider", "--leg", "LF", "nan", 2, 3), "'nan' is not a coordinate; expected a number"),
    ],
)
def test_wrong_arguments(args, text):
    result = run(*args)
    assert result.exit_code == 2
    assert text in result.stderr


# The hand calculation


def test_handbook_has_the_lines_of_the_calculation_and_the_comparison():
    code, document = run_json("handbook", "strider", "--gait", "wave", "--factor", 2, "--acceleration", 0.5)
    hand = handbook(STRIDER, feet_down=5, safety_factor=2, acceleration=0.5)
    comparison = compare_with_statics(STRIDER, gait="wave", safety_factor=2, acceleration=0.5)
    assert code == 0
    assert [line["key"] for line in document["lines"]] == [line.key for line in hand.lines]
    assert document["torque_with_factor_nm"]["femur"] == pytest.approx(2 * hand.value("stance.femur"), abs=ROUNDING)
    assert document["sentences"] == list(comparison.sentences)
    ratios = {(row.case, row.quantity): row.ratio for row in comparison.rows}
    for row in document["statics"]:
        if row["hand_over_statics"] is not None:
            assert row["hand_over_statics"] == pytest.approx(ratios[row["case"], row["joint"]], abs=ROUNDING)


def test_handbook_prints_formulas_with_numbers_and_numbered_notes():
    printed = run("handbook", "strider").stdout
    assert "W_leg = W_tot / n_down" in printed
    assert "= 21.8148 / 3" in printed
    assert "(2) the source uses the coxa's lever arm instead of the femur's" in printed
    assert "compared with statics over a walk in the tripod gait:" in printed
    # Errors and all, as printed; another robot has no printed numbers.
    source = run("handbook", "strider", "--as-printed").stdout
    assert f"{handbook(STRIDER, corrected=False).value('stance.tibia'):.4f}"[:5] in source
    assert "compared with statics" not in source
    assert "source 004" not in run("handbook", "phantomx", "--as-printed").stdout.partition("(1)")[0]


def test_handbook_needs_masses():
    result = run("handbook", "mithi")
    assert result.exit_code == 1
    assert "mass" in result.stderr
