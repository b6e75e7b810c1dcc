"""Figures of a walk: data, labels with units, layout."""

import subprocess
import sys

import numpy as np
import pytest
from matplotlib.colors import to_hex

from sample_walks import WALKS, ring_robot, sample_walk
from tarsus.errors import InputError, TarsusError
from tarsus.kinematics.inverse import inverse_kinematics
from tarsus.kinematics.pose import Pose
from tarsus.kinematics.rest import resting_pose
from tarsus.kinematics.stance import default_body_height, default_stance
from tarsus.report.angles import plot_angles
from tarsus.report.footpaths import footholds, plot_footpaths, walking_direction
from tarsus.report.gait_diagram import diagram_rows, plot_gait
from tarsus.report.ground import Ground
from tarsus.report.sample import touching_points
from tarsus.report.skeleton import plot_robot
from tarsus.report.solid import body_outline, body_solid
from tarsus.report.style import decimation, leg_colours, new_figure, save_figure, stance_spans
from tarsus.report.view import View
from tarsus.robot.file import load_robot

PLOTS = (plot_angles, plot_footpaths, plot_gait)


def standing(robot, **tilt):
    height = default_body_height(robot)
    feet = default_stance(robot) + np.array([0, 0, height])
    body = Pose.from_rpy(**tilt, position=(0, 0, height))
    return inverse_kinematics(robot, feet, body).angles, body


def line(axes, label):
    return next(found for found in axes.lines if found.get_label() == label)


# All figures


@pytest.mark.no_cover
@pytest.mark.parametrize(("kind", "plot"), list(zip(WALKS, [*PLOTS, *PLOTS, PLOTS[0]], strict=True)))
def test_figures_fit_and_axes_have_units(plot, kind):
    figure = plot(sample_walk(kind))
    figure.canvas.draw()
    tight, size = figure.get_tightbbox(), figure.get_size_inches()
    assert tight.x0 >= -0.01
    assert tight.y0 >= -0.01
    assert tight.x1 <= size[0] + 0.01
    assert tight.y1 <= size[1] + 0.01
    for axes in figure.axes:
        assert axes.get_ylabel()
        counted = axes.get_ylabel() in ("leg", "contact")
        assert counted or any(unit in axes.get_ylabel() for unit in ("(mm)", "(°)"))
    assert any(unit in figure.axes[-1].get_xlabel() for unit in ("(s)", "(mm)"))


def test_background_is_white():
    assert to_hex(new_figure(width=2, height=1).get_facecolor()) == "#ffffff"


@pytest.mark.no_cover
def test_pyplot_is_not_imported():
    code = (
        "import sys, tarsus\n"
        "from tarsus.report.skeleton import plot_robot\n"
        "plot_robot(tarsus.load_robot('strider'), [[0, 0.6, -1.6]] * 6)\n"
        "print('matplotlib.figure' in sys.modules, 'matplotlib.pyplot' in sys.modules)"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.split() == ["True", "False"]


def test_extension_determines_the_format(tmp_path):
    save_figure(plot_gait(sample_walk("straight")), tmp_path / "gait.svg")
    assert b"<svg" in (tmp_path / "gait.svg").read_bytes()


@pytest.mark.parametrize("name", ["nowhere/gait.png", "gait.nonsense"])
def test_unwritable_figure(tmp_path, name):
    with pytest.raises(InputError, match="can't be written"):
        save_figure(new_figure(width=1, height=1), tmp_path / name)


def test_missing_matplotlib(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(TarsusError, match=r"pip install 'tarsus\[plots\]'"):
        plot_angles(sample_walk("straight"))


def test_leg_colours():
    robot = load_robot("strider")
    colours = leg_colours(robot)
    assert len(set(colours)) == 6
    blue, red = (np.array([int(colour[i : i + 2], 16) for colour in colours]) for i in (5, 1))
    assert (blue[:3] > red[:3]).all()
    assert (red[3:] > blue[3:]).all()
    assert len(set(leg_colours(ring_robot(8)))) == 8
    assert all(leg_colours(ring_robot(12)))


# Joint angles


def test_angle_curves_are_thick_in_stance():
    motion = sample_walk("straight")
    figure = plot_angles(motion)
    for joint in range(3):
        for leg, code in enumerate(motion.robot.leg_codes):
            thick = line(figure.axes[joint], code)
            thin = next(
                found
                for found in figure.axes[joint].lines
                if found.get_color() == thick.get_color() and found.get_linewidth() < thick.get_linewidth()
            )
            angles = np.degrees(motion.angles[:, leg, joint])
            np.testing.assert_allclose(thin.get_ydata(), angles)
            shown = np.isfinite(thick.get_ydata())
            np.testing.assert_array_equal(shown, motion.contacts[:, leg])
            np.testing.assert_allclose(thick.get_ydata()[shown], angles[shown])


def test_limits_are_drawn_if_approached():
    motion = sample_walk("straight")
    assert not plot_angles(motion).axes[0].texts
    near = motion.robot.limits.copy()
    highest = motion.angles[:, 1, 0].max()
    near[1, 0, 1] = highest + np.radians(3)
    robot = motion.robot.replace(limits=near)
    changed = type(motion)(**{name: getattr(motion, name) for name in motion.__dataclass_fields__} | {"robot": robot})
    (text,) = plot_angles(changed).axes[0].texts
    assert text.get_text() == f"limit {np.degrees(highest) + 3:.5g}° of LM"


# Foot paths


@pytest.mark.parametrize("kind", ["straight", "round", "turning"])
def test_foot_paths_and_footholds(kind):
    motion = sample_walk(kind)
    top = plot_footpaths(motion).axes[0]
    for leg, code in enumerate(motion.robot.leg_codes):
        trail = line(top, code)
        np.testing.assert_allclose(np.column_stack(trail.get_data()), motion.feet[:, leg, :2] * 1000)
        dots = next(
            found for found in top.lines if found.get_marker() == "o" and found.get_color() == trail.get_color()
        )
        np.testing.assert_allclose(np.column_stack(dots.get_data()), footholds(motion, leg)[:, :2] * 1000)
    assert {text.get_text() for text in top.texts} >= set(motion.robot.leg_codes)
    np.testing.assert_allclose(np.column_stack(line(top, "body").get_data()), motion.body.position[:, :2] * 1000)


def test_one_foothold_for_each_stance():
    motion = sample_walk("straight")
    for leg in range(6):
        assert len(footholds(motion, leg)) == len(stance_spans(motion, leg))
    lifted = sum(len(footholds(motion, leg)) for leg in range(6)) - motion.contacts[0].sum()
    assert lifted == motion.steps


def test_body_outline_at_start_and_end():
    motion = sample_walk("turning")
    top = plot_footpaths(motion).axes[0]
    for patch, moment in zip(top.patches[::2], (0, -1), strict=False):
        corners = (motion.body[moment] @ body_outline(motion.robot))[:, :2] * 1000
        np.testing.assert_allclose(patch.get_xy()[: len(corners)], corners)


def test_top_view_is_to_scale():
    assert plot_footpaths(sample_walk("round")).axes[0].get_aspect() == 1


def test_side_view_is_along_the_walking_direction():
    straight, sideways, turning = (sample_walk(kind) for kind in ("straight", "sideways", "turning"))
    np.testing.assert_allclose(walking_direction(straight), [1, 0], atol=1e-12)
    np.testing.assert_allclose(walking_direction(sideways), [0.5, -np.sqrt(0.75)], atol=1e-12)
    np.testing.assert_allclose(walking_direction(turning), [1, 0])
    figure = plot_footpaths(sideways)
    assert "-60° from x" in figure.axes[2].get_xlabel()
    trail = line(figure.axes[1], "LF")
    along = sideways.feet[:, 0, :2] @ walking_direction(sideways) * 1000
    np.testing.assert_allclose(
        np.column_stack(trail.get_data()), np.column_stack([along, sideways.feet[:, 0, 2] * 1e3])
    )


# Gait diagram


@pytest.mark.parametrize("kind", ["straight", "sideways", "eight legs"])
def test_bars_are_stances(kind):
    motion = sample_walk(kind)
    above = plot_gait(motion).axes[0]
    rows = diagram_rows(motion.robot)
    assert [label.get_text() for label in above.get_yticklabels()] == [motion.robot.leg_codes[leg] for leg in rows]
    for bars, leg in zip(above.collections, rows, strict=True):
        spans = [(path.vertices[:, 0].min(), np.ptp(path.vertices[:, 0])) for path in bars.get_paths()]
        np.testing.assert_allclose(spans, stance_spans(motion, leg))
        standing_time = sum(duration for _, duration in spans)
        assert standing_time == pytest.approx(motion.contacts[:, leg].mean() * motion.duration, abs=0.2)


def test_order_of_the_rows():
    assert [load_robot("strider").leg_codes[leg] for leg in diagram_rows(load_robot("strider"))] == [
        *("LF", "LM", "LR"),
        *("RF", "RM", "RR"),
    ]


def test_minimum_of_the_margin_is_labelled():
    motion = sample_walk("tips over")
    below = plot_gait(motion).axes[1]
    np.testing.assert_allclose(below.lines[0].get_ydata(), motion.margin * 1000)
    (text,) = below.texts
    worst = int(np.argmin(motion.margin))
    assert text.get_text() == f"minimum: {motion.margin[worst] * 1000:.1f} mm at {motion.time[worst]:.2f} s"
    low, high = below.get_ylim()
    assert low < motion.margin.min() * 1000 < 0
    assert high > motion.margin.max() * 1000


def test_margin_has_a_gap_without_a_foot_on_the_ground():
    motion = sample_walk("straight")
    fields = {name: getattr(motion, name) for name in motion.__dataclass_fields__}
    flying = type(motion)(**fields | {"contacts": np.zeros_like(motion.contacts)})
    below = plot_gait(flying).axes[1]
    assert np.isnan(below.lines[0].get_ydata()).all()
    assert not below.texts


def test_decimation_of_a_long_motion():
    motion = sample_walk("straight")
    assert len(motion.time[decimation(motion)]) == len(motion.time)
    fields = {name: getattr(motion, name) for name in motion.__dataclass_fields__}
    many = 60
    changes = {name: np.concatenate([fields[name]] * many) for name in ("feet", "contacts", "angles", "reach")}
    changes["time"] = np.arange(len(changes["feet"])) / 50
    position = np.concatenate([motion.body.position] * many)
    changes["body"] = Pose(np.concatenate([motion.body.rotation] * many), position)
    long = type(motion)(**fields | changes)
    assert 4000 <= len(long.time[decimation(long)]) <= 8000


# The robot


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["strider", "phoenix", "mithi", "freenove"])
def test_links_are_drawn_at_their_projection(name):
    robot = load_robot(name)
    angles, body = standing(robot, pitch=0.05)
    view = View(azimuth=-40, elevation=35)
    figure = plot_robot(robot, angles, body=body, view=view)
    axes = figure.axes[0]
    from tarsus.kinematics.leg import forward_kinematics

    flat = view.project(body @ forward_kinematics(robot, angles)) * 1000
    drawn = [np.column_stack(found.get_data()) for found in axes.lines if len(found.get_xdata()) == 2]
    for leg in range(robot.legs):
        for link in range(3):
            assert any(np.allclose(ends, flat[leg, link : link + 2]) for ends in drawn)
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert (flat > [left, low]).all()
    assert (flat < [right, high]).all()
    assert {text.get_text() for text in [*axes.texts, *figure.texts]} >= {*robot.leg_codes, name}


def test_contact_feet_are_filled():
    robot = load_robot("strider")
    angles, _ = standing(robot)
    lifted = np.array(angles)
    lifted[0, 1] += 0.3
    axes = plot_robot(robot, lifted, title="one foot up").axes[0]
    size = max(found.get_markersize() for found in axes.lines if found.get_marker() == "o")
    faces = [
        to_hex(found.get_markerfacecolor())
        for found in axes.lines
        if found.get_marker() == "o" and found.get_markersize() == size
    ]
    assert faces == ["#ffffff", *(colour.lower() for colour in leg_colours(robot)[1:])]
    assert "one foot up" in {text.get_text() for text in axes.figure.texts}


def test_no_margin_without_ground_contact():
    robot = load_robot("strider")
    angles, body = standing(robot)
    axes = plot_robot(robot, angles, body=body, contacts=np.zeros(6, dtype=bool)).axes[0]
    assert any("no ground contact" in text.get_text() for text in axes.figure.texts)


@pytest.mark.parametrize("angles", [(0.0, 80.0, 0.0), (0.0, -30.0, -60.0)])
def test_support_of_a_resting_robot(angles):
    robot = load_robot("strider")
    radians = np.radians(np.tile(angles, (6, 1)))
    radians[0] = np.radians([0, 90, 0])
    rest = resting_pose(robot, radians)
    points = touching_points(rest, radians)
    assert len(points) >= 3
    np.testing.assert_allclose(points[:, 2], 0, atol=1e-8)
    figure = plot_robot(robot, radians, body=rest.body, contacts=rest.contacts, support=points)
    assert any(f"margin {rest.margin * 1000:.1f} mm" in text.get_text() for text in figure.texts)


def test_view_projection_and_depth():
    view = View(azimuth=-70, elevation=20)
    np.testing.assert_allclose(view.axes @ view.axes.T, np.eye(3), atol=1e-15)
    picture = np.array([[3.0, -2.0], [0.5, 7.0]])
    ground = view.ground_under(picture)
    np.testing.assert_allclose(view.project(ground), picture, atol=1e-12)
    np.testing.assert_array_equal(ground[:, 2], 0)
    assert view.depth(np.array([0.0, -1.0, 0.0])) > view.depth(np.array([0.0, 1.0, 0.0]))
    assert view.project(np.array([0.0, 0.0, 1.0]))[1] > 0


@pytest.mark.parametrize("name", ["strider", "phoenix"])
def test_body_faces_point_outwards(name):
    robot = load_robot(name)
    solid = body_solid(robot)
    middle = solid.corners.mean(0)
    for face in solid.faces:
        a, b, c = solid.corners[list(face[:3])]
        assert np.cross(b - a, c - b) @ (a - middle) > 0
    if robot.body_size is not None:
        np.testing.assert_allclose(np.ptp(solid.corners, axis=0), robot.body_size)


@pytest.mark.parametrize("width", [500.0, 50_000.0])
def test_grid_covers_the_view_with_a_bounded_number_of_lines(width):
    axes = new_figure(width=3, height=2, manual_layout=True).add_axes((0, 0, 1, 1))
    axes.set_xlim(-width / 2, width / 2)
    axes.set_ylim(-width / 3, width / 3)
    Ground(axes, View()).update()
    segments = axes.collections[0].get_segments()
    assert 4 <= len(segments) <= 2 * 81
    ends = np.concatenate(segments)
    assert ends[:, 0].min() < -width / 2
    assert ends[:, 0].max() > width / 2
