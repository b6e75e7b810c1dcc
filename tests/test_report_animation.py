"""Animation: frame times, contents of the frames, file size."""

import numpy as np
import pytest
from PIL import Image

from sample_walks import ring_robot, sample_walk
from tarsus.errors import InputError
from tarsus.gait.gait import Gait
from tarsus.gait.path import straight_path
from tarsus.gait.plan import plan_walk
from tarsus.report.animation import animate, frame_times
from tarsus.report.film import Film
from tarsus.report.view import View

SMALL = (200, 160)


@pytest.mark.no_cover
def test_gif_in_real_time(tmp_path):
    motion, fractions = sample_walk("straight"), []
    count = animate(motion, tmp_path / "walk.gif", max_duration=1.0, size=SMALL, progress=fractions.append)
    with Image.open(tmp_path / "walk.gif") as film:
        assert film.format == "GIF"
        assert film.size == SMALL
        assert film.n_frames == count
        durations = []
        for number in range(film.n_frames):
            film.seek(number)
            durations.append(film.info["duration"])
    assert sum(durations[:-1]) / 1000 == pytest.approx(1.0, abs=0.06)
    assert set(durations[:-1]) == {60}
    assert durations[-1] == 1000
    assert fractions[-1] == 1
    assert fractions == sorted(fractions)
    assert len(fractions) == count


@pytest.mark.no_cover
def test_default_walk_is_below_3_megabytes(tmp_path):
    motion = plan_walk(ring_robot(6), Gait.named("tripod"), straight_path(0.1))
    count = animate(motion, tmp_path / "walk.gif", max_duration=0.6)
    per_frame = (tmp_path / "walk.gif").stat().st_size / count
    # A walk of six seconds has about a hundred frames.
    assert per_frame < 30_000


def test_animation_is_limited_to_the_maximum_duration():
    motion = sample_walk("straight")
    times, duration = frame_times(motion, max_duration=0.5)
    assert duration == 60
    assert times[-1] == 0.5
    times, _ = frame_times(motion)
    assert times[-1] == motion.duration
    assert (np.diff(times) > 0).all()


def test_longer_walks_have_a_lower_frame_rate():
    strider = sample_walk("straight").robot
    times, duration = frame_times(plan_walk(strider, Gait.named("wave"), straight_path(0.4), rate=20))
    assert times[-1] > 8
    assert duration == 80


@pytest.mark.parametrize("max_duration", [0.0, -1.0, float("nan")])
def test_invalid_maximum_duration(tmp_path, max_duration):
    with pytest.raises(InputError, match="max_duration"):
        animate(sample_walk("straight"), tmp_path / "walk.gif", max_duration=max_duration)


def test_unwritable_file(tmp_path):
    with pytest.raises(InputError, match="can't be written"):
        animate(sample_walk("straight"), tmp_path / "no" / "walk.gif", max_duration=0.05, size=SMALL)


@pytest.mark.parametrize("kind", ["straight", "round", "tips over", "eight legs"])
def test_frames_show_the_whole_robot_with_time_and_contacts(kind):
    motion, view = sample_walk(kind), View()
    film = Film(motion, view=view, size=SMALL)
    for sample in (0, len(motion.time) // 2, len(motion.time) - 1):
        picture = film.frame(sample)
        assert picture.size == SMALL
        assert picture.getpixel((1, SMALL[1] - 1)) == (255, 255, 255)
        (left, right), (low, high) = film.axes.get_xlim(), film.axes.get_ylim()
        feet = view.project(motion.feet[sample] * 1000)
        assert (feet > [left, low]).all()
        assert (feet < [right, high]).all()
        caption = film.caption.get_text()
        assert f"{motion.time[sample]:.2f} s" in caption
        assert f"{motion.contacts[sample].sum()} feet on the ground" in caption
        assert f"{motion.margin[sample] * 1000:.0f} mm" in caption


def test_view_follows_the_robot():
    motion = sample_walk("straight")
    film = Film(motion, view=View(), size=SMALL)
    film.frame(0)
    before = np.mean(film.axes.get_xlim())
    film.frame(len(motion.time) - 1)
    shift = View().project(motion.body.position[-1] * [1000, 1000, 0])[0]
    assert np.mean(film.axes.get_xlim()) - before == pytest.approx(shift)


def test_no_margin_without_a_foot_on_the_ground():
    motion = sample_walk("straight")
    fields = {name: getattr(motion, name) for name in motion.__dataclass_fields__}
    film = Film(type(motion)(**fields | {"contacts": np.zeros_like(motion.contacts)}), view=View(), size=SMALL)
    film.frame(3)
    assert "margin none" in film.caption.get_text()
