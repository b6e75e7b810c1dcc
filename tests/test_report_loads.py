"""Figures, tables and the self-contained page of joint loads."""

import base64
import html
import math
import re
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from sample_loads import sample_loads
from tarsus.load.loads import joint_loads
from tarsus.load.sizing import size_servos
from tarsus.load.supply import supply_load
from tarsus.load.verdict import CLASSES, joint_verdicts, severity_of
from tarsus.report.loads_files import write_loads
from tarsus.report.loads_page import loads_page
from tarsus.report.loads_speed import plot_torque_speed
from tarsus.report.loads_summary import length_advice, loads_summary, worst_of_each
from tarsus.report.loads_table import (
    LEGEND,
    LOAD_COLUMNS,
    SEVERITY_STYLES,
    load_bar,
    load_rows,
    loads_lines,
    loads_verdict,
)
from tarsus.report.loads_torque import plot_torques, servo_limits
from tarsus.report.style import SEVERITY_COLOURS
from tarsus.robot.servo import Servo


def bare():
    """The strider without servos."""
    found = sample_loads()
    return joint_loads(found.robot.replace(servos=()), found.motion)


def speedless():
    """The strider with servos of unknown no-load speed."""
    found = sample_loads()
    return joint_loads(found.robot.replace(servos=((Servo(name="slow", stall_torque=9.0),) * 3,) * 6), found.motion)


def summary_of(found):
    return loads_summary(found, supply_load(found))


@pytest.mark.parametrize(
    ("plot", "found"),
    [
        (plot_torques, sample_loads),
        (plot_torques, bare),
        (plot_torques, lambda: sample_loads("burnt-5kg")),
        (plot_torque_speed, sample_loads),
        (plot_torque_speed, speedless),
    ],
)
def test_figures_fit_and_axes_have_units(plot, found):
    figure = plot(found())
    figure.canvas.draw()
    tight, size = figure.get_tightbbox(), figure.get_size_inches()
    assert tight.x0 >= -0.01
    assert tight.y0 >= -0.01
    assert tight.x1 <= size[0] + 0.01
    assert tight.y1 <= size[1] + 0.01
    for axes in figure.axes:
        assert "(N m)" in axes.get_ylabel() or axes.get_ylabel() == "contact"


def test_torques_are_drawn_thick_in_stance():
    found = sample_loads()
    figure = plot_torques(found)
    for joint in range(3):
        for leg, code in enumerate(found.robot.leg_codes):
            thick = next(line for line in figure.axes[joint].lines if line.get_label() == code)
            down = found.motion.contacts[:, leg]
            np.testing.assert_array_equal(thick.get_ydata()[down], np.abs(found.torques[down, leg, joint]))
            assert np.isnan(thick.get_ydata()[~down]).all()


def test_visible_limits_are_drawn_and_others_listed():
    found = sample_loads()
    figure = plot_torques(found)
    stall = found.stall_torque[0, 0]
    assert servo_limits(found, 1) == [
        (f"stall {stall:.2f} N m", stall),
        ("1/3 (factor 3)", stall / 3),
        ("1/5 (continuous)", stall / 5),
    ]
    heights = {float(line.get_ydata()[0]) for line in figure.axes[1].lines if len(line.get_ydata()) == 2}
    assert heights == {stall, stall / 3, stall / 5}
    coxa = [text.get_text() for text in figure.axes[0].texts]
    assert any(text.startswith(f"beyond the axis: stall {stall:.2f} N m") for text in coxa)
    top = figure.axes[1].get_ylim()[1]
    assert top > max(stall, found.peak[:, 1].max())
    assert servo_limits(bare(), 1) == []
    assert any("no servo in the robot file" in text.get_text() for text in plot_torques(bare()).axes[1].texts)


def test_limits_are_those_of_the_weakest_servo():
    found = sample_loads()
    rows = [list(row) for row in found.robot.servos]
    rows[3][1] = Servo(name="weak", stall_torque=1.0, no_load_speed=4.0)
    mixed = joint_loads(found.robot.replace(servos=rows), found.motion)
    assert servo_limits(mixed, 1)[0] == ("stall 1.00 N m", 1.0)
    axes = plot_torque_speed(mixed).axes[1]
    assert axes.texts[-1].get_text() == "weak"
    line = next(line for line in axes.lines if len(line.get_xdata()) == 3)
    np.testing.assert_allclose(line.get_xdata()[1:], [0, math.degrees(4.0)])
    np.testing.assert_allclose(line.get_ydata(), [1.0, 1.0, 0.0])


def test_torque_over_speed():
    found = sample_loads()
    axes = plot_torque_speed(found).axes[1]
    for leg, code in enumerate(found.robot.leg_codes):
        dots = next(line for line in axes.lines if line.get_label() == code)
        np.testing.assert_array_equal(dots.get_ydata(), np.abs(found.torques[:, leg, 1]))
        speed = np.degrees(found.speeds[:, leg, 1] * np.sign(found.torques[:, leg, 1]))
        np.testing.assert_allclose(dots.get_xdata(), speed)


def test_servo_with_unknown_no_load_speed():
    axes = plot_torque_speed(speedless()).axes[1]
    assert axes.texts[-1].get_text() == "slow: no-load speed unknown"
    assert not any(len(line.get_xdata()) == 3 for line in axes.lines)
    assert plot_torque_speed(bare()).axes[1].texts[-1].get_text() == "no servo in the robot file"
    too_high = plot_torque_speed(sample_loads(supply=12.0)).axes[1]
    assert too_high.texts[-1].get_text() == "no ratings at this supply"


# Numbers and text


@given(fraction=st.floats(0, 1))
def test_bar_length(fraction):
    bar = load_bar(fraction, width=10)
    eighths = sum(8 if c == "█" else " ▏▎▍▌▋▊▉".index(c) for c in bar)
    assert eighths == math.ceil(fraction * 80)


def test_bar_above_stall():
    assert load_bar(1.2, width=4) == "███▶"
    assert load_bar(None) == ""


def test_load_rows():
    summary = summary_of(sample_loads())
    rows = load_rows(summary)
    assert len(rows) == 18
    assert all(len(row) == len(LOAD_COLUMNS) for row in rows)
    assert rows[4][0] == "LM femur"
    assert rows[4][2] == f"{summary['joints'][4]['peak_nm']:.3f}"
    unknown = dict(zip(LOAD_COLUMNS, load_rows(summary_of(bare()))[4], strict=True))
    assert (unknown["servo"], unknown["of stall"], unknown["factor"]) == ("none", "", "")
    assert (unknown["utilisation"], unknown["thermal"]) == ("unknown", "unknown")


def test_rows_that_are_the_same_for_all_legs_become_one():
    summary = summary_of(sample_loads())
    alike = [row | {"leg": leg} for leg in ("LF", "LM", "LR") for row in summary["joints"][:2]]
    alike[3] = alike[3] | {"peak_nm": 9.0}
    rows = load_rows({**summary, "joints": alike})
    assert [row[0] for row in rows] == ["all legs coxa", "LF femur", "LM femur", "LR femur"]
    assert rows[0][1:] == load_rows(summary)[0][1:]


def test_one_scale_of_colours_for_report_and_studio():
    theme = (Path(__file__).parents[1] / "web" / "src" / "app" / "theme.css").read_text(encoding="utf-8")
    studio = {name: re.search(rf"--{name}: (#\w+);", theme)[1] for name in ("good", "warn", "bad")}
    assert {"good": studio["good"], "warning": studio["warn"], "bad": studio["bad"]} == SEVERITY_COLOURS
    assert [severity_of(name) for _, name in CLASSES] == ["bad", "bad", "warning", "good"]
    assert severity_of("unknown") == "warning"
    assert set(SEVERITY_STYLES) == set(SEVERITY_COLOURS)


def test_worst_of_each_joint_has_the_smallest_factor():
    verdicts = joint_verdicts(sample_loads())
    for number, worst in enumerate(worst_of_each(verdicts)):
        assert worst.factor == min(verdict.factor for verdict in verdicts[number::3])
    nameless = joint_verdicts(bare())
    assert worst_of_each(nameless)[1].peak == max(verdict.peak for verdict in nameless[1::3])


def test_lines_of_a_tipping_robot():
    found = sample_loads()
    off = summary_of(replace(found, margin=np.full_like(found.margin, -np.inf)))
    assert "the robot loses contact" in loads_lines(off)
    tips = summary_of(replace(found, margin=np.full_like(found.margin, -0.0123)))
    assert "the robot tips: the load is 12.3 mm outside the support polygon" in loads_lines(tips)
    assert str(loads_verdict(tips)).startswith("not carried: the robot tips")


def test_unloaded_joints_are_good():
    found = sample_loads()
    idle = summary_of(replace(found, torques=np.zeros_like(found.torques)))
    assert idle["class"] == "good"
    assert str(loads_verdict(idle)) == "good: LF coxa (with estimated leg.servo)"


def test_lines_with_current_and_battery_life():
    lines = loads_lines(loads_summary(sample_loads("burnt-5kg"), supply_load(sample_loads("burnt-5kg"), capacity=2.0)))
    assert any(line.startswith("current: ") and "battery life" in line for line in lines)
    warning = supply_load(sample_loads("burnt-5kg")).warning
    assert (f"supply: {warning}" in lines) == (warning is not None)


def test_length_advice():
    found = sample_loads()
    sizing = size_servos(found.robot, found)
    change = {
        "coxa": np.array([0.0, -8.0, -4.0]),
        "femur": np.array([0.0, 0.01, 0.0]),
        "tibia": np.array([0, 1.0, 5.0]),
    }
    advice = length_advice(replace(sizing, sensitivity=change))
    assert advice[0] == "coxa 10 mm longer: femur -0.080 N m, tibia -0.040 N m"
    assert advice[1] == "femur 10 mm shorter: negligible change"
    assert advice[2] == "tibia 10 mm shorter: femur -0.010 N m, tibia -0.050 N m"
    nan = {"coxa": np.full(3, np.nan)}
    assert length_advice(replace(sizing, sensitivity=nan)) == [
        "coxa: no result, as a foot is out of reach with another length, or the length is 0"
    ]


# The page


@pytest.mark.no_cover
def test_page_is_self_contained_and_complete(tmp_path):
    found = sample_loads("burnt-mg996r", payload=0.2)
    summary = summary_of(found)
    files = write_loads(found, summary, tmp_path)
    page = files[-1].read_text(encoding="utf-8")
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!data:)", page)
    assert "http" not in page
    assert "<script" not in page
    assert "@import" not in page
    figures = re.findall(r'src="data:image/png;base64,([^"]+)"', page)
    assert len(figures) == 2
    for data, file in zip(figures, files[1:3], strict=True):
        assert base64.b64decode(data) == file.read_bytes()
        with Image.open(BytesIO(base64.b64decode(data))) as picture:
            assert min(picture.size) > 400
    text = html.unescape(page)
    for row in load_rows(summary):
        assert f"<td>{row[0]}</td>" in text
    for line in loads_lines(summary):
        assert f"<li>{line}</li>" in text
    assert str(loads_verdict(summary)) in text
    assert "payload 0.2 kg" in text
    assert 'class="verdict bad"' in page
    assert "; ".join(LEGEND) in text


def test_names_are_escaped():
    found = sample_loads()
    named = replace(found, robot=found.robot.replace(name="<b>&"))
    page = loads_page(summary_of(named), [])
    assert "<b>&" not in page
    assert "&lt;b&gt;&amp;" in page
    # The strider is marginal: amber, as in the studio and in the terminal.
    assert 'class="verdict warning"' in page
    assert '<td class="warning">marginal</td>' in page
    assert loads_verdict(summary_of(found)).style == "bold yellow"
    assert "with inertia" in page
    assert "quasi-static" in loads_page(summary_of(sample_loads(inertial=False)), [])
