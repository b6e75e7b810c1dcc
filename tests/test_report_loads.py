"""The pictures, tables and page of a walk's loads show the loads, and ask no other place for anything."""

import base64
import html
import math
import re
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from sample_loads import sample_loads
from tarsus.load.loads import joint_loads
from tarsus.load.sizing import size_servos
from tarsus.load.supply import supply_load
from tarsus.load.verdict import joint_verdicts
from tarsus.report.loads_files import write_loads
from tarsus.report.loads_page import loads_page
from tarsus.report.loads_speed import plot_torque_speed
from tarsus.report.loads_summary import length_advice, loads_summary, worst_of_each
from tarsus.report.loads_table import LOAD_COLUMNS, load_bar, load_rows, loads_lines, loads_verdict
from tarsus.report.loads_torque import plot_torques, servo_limits
from tarsus.robot.servo import Servo

PLOTS = (plot_torques, plot_torque_speed)


def bare():
    """The strider without servos."""
    found = sample_loads()
    return joint_loads(found.robot.replace(servos=()), found.motion)


def speedless():
    """The strider on servos whose speed is unknown."""
    found = sample_loads()
    return joint_loads(found.robot.replace(servos=((Servo(name="slow", stall_torque=9.0),) * 3,) * 6), found.motion)


def summary_of(found):
    return loads_summary(found, supply_load(found))


@pytest.mark.parametrize("plot", PLOTS)
@pytest.mark.parametrize("found", [sample_loads, bare, speedless, lambda: sample_loads("burnt-5kg")])
def test_nothing_is_cut_off_and_every_axis_has_its_unit(plot, found):
    figure = plot(found())
    figure.canvas.draw()
    tight, size = figure.get_tightbbox(), figure.get_size_inches()
    assert tight.x0 >= -0.01
    assert tight.y0 >= -0.01
    assert tight.x1 <= size[0] + 0.01
    assert tight.y1 <= size[1] + 0.01
    for axes in figure.axes:
        assert "(N m)" in axes.get_ylabel() or axes.get_ylabel() == "foot down"


def test_the_torques_of_every_leg_are_drawn_thick_while_its_foot_is_down():
    found = sample_loads()
    figure = plot_torques(found)
    for joint in range(3):
        for leg, code in enumerate(found.robot.leg_codes):
            thick = next(line for line in figure.axes[joint].lines if line.get_label() == code)
            down = found.motion.contacts[:, leg]
            np.testing.assert_array_equal(thick.get_ydata()[down], np.abs(found.torques[down, leg, joint]))
            assert np.isnan(thick.get_ydata()[~down]).all()


def test_limits_in_sight_are_lines_and_the_others_are_named():
    found = sample_loads()
    figure = plot_torques(found)
    stall = found.stall_torque[0, 0]
    assert servo_limits(found, 1) == [
        (f"stall {stall:.2f} N m", stall),
        ("1/3: factor 3", stall / 3),
        ("1/5: lasting", stall / 5),
    ]
    heights = {float(line.get_ydata()[0]) for line in figure.axes[1].lines if len(line.get_ydata()) == 2}
    assert heights == {stall, stall / 3, stall / 5}
    coxa = [text.get_text() for text in figure.axes[0].texts]
    assert any(text.startswith(f"far above: stall {stall:.2f} N m") for text in coxa)
    top = figure.axes[1].get_ylim()[1]
    assert top > max(stall, found.peak[:, 1].max())
    assert servo_limits(bare(), 1) == []
    assert any("no servo in the robot file" in text.get_text() for text in plot_torques(bare()).axes[1].texts)


def test_the_weakest_servo_of_a_kind_is_the_one_drawn():
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


def test_demand_is_torque_over_speed_in_its_direction():
    found = sample_loads()
    axes = plot_torque_speed(found).axes[1]
    for leg, code in enumerate(found.robot.leg_codes):
        dots = next(line for line in axes.lines if line.get_label() == code)
        np.testing.assert_array_equal(dots.get_ydata(), np.abs(found.torques[:, leg, 1]))
        speed = np.degrees(found.speeds[:, leg, 1] * np.sign(found.torques[:, leg, 1]))
        np.testing.assert_allclose(dots.get_xdata(), speed)


def test_a_servo_without_speed_has_a_flat_line_and_is_said():
    axes = plot_torque_speed(speedless()).axes[1]
    assert axes.texts[-1].get_text() == "slow: speed unknown"
    assert not any(len(line.get_xdata()) == 3 for line in axes.lines)
    assert plot_torque_speed(bare()).axes[1].texts[-1].get_text() == "no servo in the robot file"


# Numbers and words


@given(share=st.floats(0, 1))
def test_a_bar_is_as_long_as_its_share(share):
    bar = load_bar(share, width=10)
    eighths = sum(8 if c == "█" else " ▏▎▍▌▋▊▉".index(c) for c in bar)
    assert eighths == math.ceil(share * 80)


def test_a_bar_beyond_the_stall_says_so():
    assert load_bar(1.2, width=4) == "███▶"
    assert load_bar(None) == ""


def test_rows_are_the_summary():
    summary = summary_of(sample_loads())
    rows = load_rows(summary)
    assert len(rows) == 18
    assert all(len(row) == len(LOAD_COLUMNS) for row in rows)
    assert rows[4][0] == "LM femur"
    assert rows[4][2] == f"{summary['joints'][4]['peak_nm']:.3f}"
    unknown = dict(zip(LOAD_COLUMNS, load_rows(summary_of(bare()))[4], strict=True))
    assert (unknown["servo"], unknown["of stall"], unknown["factor"]) == ("none named", "", "")
    assert (unknown["line used"], unknown["heat"]) == ("unknown", "unknown")


def test_the_worst_of_each_kind_is_the_one_with_the_least_factor():
    verdicts = joint_verdicts(sample_loads())
    for number, worst in enumerate(worst_of_each(verdicts)):
        assert worst.factor == min(verdict.factor for verdict in verdicts[number::3])
    nameless = joint_verdicts(bare())
    assert worst_of_each(nameless)[1].peak == max(verdict.peak for verdict in nameless[1::3])


def test_what_lifts_off_or_tips_is_said():
    found = sample_loads()
    off = summary_of(replace(found, margin=np.full_like(found.margin, -np.inf)))
    assert "the robot lifts off the ground" in loads_lines(off)
    tips = summary_of(replace(found, margin=np.full_like(found.margin, -0.0123)))
    assert "the robot tips: its load is 12.3 mm outside its feet" in loads_lines(tips)
    assert str(loads_verdict(tips)).startswith("not carried: the robot tips")


def test_joints_that_bear_nothing_are_good():
    found = sample_loads()
    idle = summary_of(replace(found, torques=np.zeros_like(found.torques)))
    assert idle["class"] == "good"
    assert str(loads_verdict(idle)) == "good: LF coxa"


def test_peaks_at_once_are_told_with_the_battery():
    lines = loads_lines(loads_summary(sample_loads("burnt-5kg"), supply_load(sample_loads("burnt-5kg"), capacity=2.0)))
    assert any(line.startswith("current: ") and "the battery lasts" in line for line in lines)
    together = supply_load(sample_loads("burnt-5kg")).warning
    assert (f"supply: {together}" in lines) == (together is not None)


def test_advice_says_which_way_a_length_helps():
    found = sample_loads()
    sizing = size_servos(found.robot, found)
    change = {
        "coxa": np.array([0.0, -8.0, -4.0]),
        "femur": np.array([0.0, 0.01, 0.0]),
        "tibia": np.array([0, 1.0, 5.0]),
    }
    said = length_advice(replace(sizing, sensitivity=change))
    assert said[0] == "coxa 10 mm longer: femur less by 0.080 N m, tibia less by 0.040 N m"
    assert said[1] == "femur 10 mm shorter: hardly any change"
    assert said[2] == "tibia 10 mm shorter: femur less by 0.010 N m, tibia less by 0.050 N m"
    nan = {"coxa": np.full(3, np.nan)}
    assert length_advice(replace(sizing, sensitivity=nan)) == [
        "coxa: its length can't be changed with the feet where they are, or it has none"
    ]


# The page


def test_the_page_has_pictures_and_every_joint_and_asks_nobody(tmp_path):
    found = sample_loads("burnt-mg996r", payload=0.2)
    summary = summary_of(found)
    files = write_loads(found, summary, tmp_path)
    page = files[-1].read_text(encoding="utf-8")
    assert not re.search(r"(?:src|href)\s*=\s*[\"'](?!data:)", page)
    assert "http" not in page
    assert "<script" not in page
    assert "@import" not in page
    pictures = re.findall(r'src="data:image/png;base64,([^"]+)"', page)
    assert len(pictures) == 2
    for data, file in zip(pictures, files[1:3], strict=True):
        assert base64.b64decode(data) == file.read_bytes()
        with Image.open(BytesIO(base64.b64decode(data))) as picture:
            assert min(picture.size) > 400
    text = html.unescape(page)
    for row in load_rows(summary):
        assert f"<td>{row[0]}</td>" in text
    for line in loads_lines(summary):
        assert f"<li>{line}</li>" in text
    assert str(loads_verdict(summary)) in text
    assert "with 0.2 kg of payload" in text
    assert 'class="verdict not-carried"' in page


def test_names_from_files_are_escaped():
    found = sample_loads()
    named = replace(found, robot=found.robot.replace(name="<b>&"))
    page = loads_page(summary_of(named), [])
    assert "<b>&" not in page
    assert "&lt;b&gt;&amp;" in page
    assert 'class="verdict carried"' in page
    assert "with inertia" in page
    assert "statics alone" in loads_page(summary_of(sample_loads(inertial=False)), [])
