"""The animation: real time, the robot where the motion has it, a small file."""

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


def test_a_walk_becomes_a_gif_in_real_time(tmp_path):
    motion, shares = sample_walk("straight"), []
    count = animate(motion, tmp_path / "walk.gif", longest=1.0, size=SMALL, progress=shares.append)
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
    assert shares[-1] == 1
    assert shares == sorted(shares)
    assert len(shares) == count


def test_the_default_walk_is_less_than_three_megabytes(tmp_path):
    motion = plan_walk(ring_robot(6), Gait.named("tripod"), straight_path(0.1))
    count = animate(motion, tmp_path / "walk.gif", longest=0.6)
    per_frame = (tmp_path / "walk.gif").stat().st_size / count
    # A walk of six seconds has about a hundred frames.
    assert per_frame < 30_000


def test_only_the_beginning_of_a_long_walk_is_shown():
    motion = sample_walk("straight")
    times, duration = frame_times(motion, longest=0.5)
    assert duration == 60
    assert times[-1] == 0.5
    times, _ = frame_times(motion)
    assert times[-1] == motion.duration
    assert (np.diff(times) > 0).all()


def test_a_longer_walk_has_fewer_frames_a_second():
    strider = sample_walk("straight").robot
    times, duration = frame_times(plan_walk(strider, Gait.named("wave"), straight_path(0.4), rate=20))
    assert times[-1] > 8
    assert duration == 80


@pytest.mark.parametrize("longest", [0.0, -1.0, float("nan")])
def test_a_length_that_is_none_is_refused(tmp_path, longest):
    with pytest.raises(InputError, match="longest"):
        animate(sample_walk("straight"), tmp_path / "walk.gif", longest=longest)


def test_a_film_that_can_not_be_written_says_so(tmp_path):
    with pytest.raises(InputError, match="can't be written"):
        animate(sample_walk("straight"), tmp_path / "no" / "walk.gif", longest=0.05, size=SMALL)


@pytest.mark.parametrize("kind", ["straight", "round", "tips over", "eight legs"])
def test_every_frame_shows_the_whole_robot_its_time_and_its_feet(kind):
    motion, view = sample_walk(kind), View()
    film = Film(motion, view=view, size=SMALL)
    for moment in (0, len(motion.time) // 2, len(motion.time) - 1):
        picture = film.frame(moment)
        assert picture.size == SMALL
        assert picture.getpixel((1, SMALL[1] - 1)) == (255, 255, 255)
        (left, right), (low, high) = film.axes.get_xlim(), film.axes.get_ylim()
        feet = view.project(motion.feet[moment] * 1000)
        assert (feet > [left, low]).all()
        assert (feet < [right, high]).all()
        words = film.words.get_text()
        assert f"{motion.time[moment]:.2f} s" in words
        assert f"{motion.contacts[moment].sum()} feet down" in words
        assert f"{motion.margin[moment] * 1000:.0f} mm" in words


def test_the_picture_moves_on_with_the_robot():
    motion = sample_walk("straight")
    film = Film(motion, view=View(), size=SMALL)
    film.frame(0)
    before = np.mean(film.axes.get_xlim())
    film.frame(len(motion.time) - 1)
    moved = View().project(motion.body.position[-1] * [1000, 1000, 0])[0]
    assert np.mean(film.axes.get_xlim()) - before == pytest.approx(moved)


def test_in_the_air_the_margin_is_none():
    motion = sample_walk("straight")
    fields = {name: getattr(motion, name) for name in motion.__dataclass_fields__}
    film = Film(type(motion)(**fields | {"contacts": np.zeros_like(motion.contacts)}), view=View(), size=SMALL)
    film.frame(3)
    assert "margin none" in film.words.get_text()
