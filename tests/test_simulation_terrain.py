"""Terrain: its height is that of the ground in physics, it is a value, and what cannot be is refused."""

import math
import re
import sys

import mujoco
import numpy as np
import pytest
from PIL import Image

from tarsus.errors import InputError, TarsusError
from tarsus.simulation.terrain import Blocks, Box, Flat, Gaps, HeightField, Ramp, Smooth, Stairs, Step, Terrain
from tarsus.simulation.terrain.solids import terrain_solids

GRID = np.random.default_rng(0).random((7, 5)) * 0.05
TERRAINS = [
    Flat(),
    Ramp(slope=0.2),
    Ramp(slope=-0.3, start=-0.2, length=0.7),
    Step(rise=0.03),
    Step(rise=-0.04, start=0.1),
    Stairs(rise=0.03),
    Stairs(rise=-0.02, tread=0.1, steps=7, start=0.0),
    Gaps(),
    Blocks(clear=0.2),
    Box(length=0.5, width=1.0, start=-0.2, aside=0.4),
    Box(rise=0.3, length=1.5, width=0.7, yaw=-0.6),
    Smooth(clear=0.3),
    Smooth(seed=3, amplitude=0.05, wavelength=0.8),
    HeightField(heights=GRID, size=(3.0, 2.0)),
    HeightField(heights=np.full((2, 3), -0.02), size=(1.0, 2.0)),
    HeightField(heights=GRID, size=(99.0, 99.9)),
]


def world(terrain):
    spec = mujoco.MjSpec()
    terrain.add_to(spec)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def ground_at(model, data, x, y):
    """The height of the ground, as a ray from above finds it."""
    hit = np.zeros(1, np.int32)
    distance = mujoco.mj_ray(model, data, np.array([x, y, 5.0]), np.array([0.0, 0, -1]), None, 1, -1, hit, None)
    return 5.0 - distance


@pytest.mark.parametrize("terrain", TERRAINS, ids=lambda each: type(each).__name__)
def test_the_height_is_that_of_the_ground_in_physics(terrain):
    model, data = world(terrain)
    x, y = np.random.default_rng(1).uniform(-2.5, 2.5, (2, 200))
    found = [ground_at(model, data, *place) for place in zip(x, y, strict=True)]
    assert terrain.height(x, y) == pytest.approx(np.array(found), abs=1e-7)
    assert terrain.height(x[:, None], y[:3]).shape == (200, 3)
    assert terrain.height(0.3, 0.2).shape == ()
    assert isinstance(terrain, Terrain)
    assert model.geom_friction[:, 0] == pytest.approx(terrain.friction)


@pytest.mark.parametrize("terrain", TERRAINS, ids=lambda each: type(each).__name__)
def test_a_terrain_is_a_value(terrain):
    values = {name: getattr(terrain, name) for name in terrain.__dataclass_fields__}
    same = type(terrain)(**values)
    assert same == terrain
    assert hash(same) == hash(terrain)
    assert terrain != 1
    assert (
        type(terrain)(**{n: getattr(terrain, n) for n in terrain.__dataclass_fields__} | {"friction": 0.1}) != terrain
    )


@pytest.mark.parametrize("kind", [Blocks, Smooth])
def test_random_terrain_follows_its_seed(kind):
    x, y = np.random.default_rng(0).uniform(-1.9, 1.9, (2, 100))
    assert (kind(seed=1).height(x, y) == kind(seed=1).height(x, y)).all()
    assert (kind(seed=1).height(x, y) != kind(seed=2).height(x, y)).any()


def test_blocks_are_as_high_as_they_may_be_and_leave_the_start_clear():
    terrain = Blocks(rise=0.05, clear=0.4)
    assert 0.045 < terrain.heights.max() <= 0.05
    angle = np.linspace(0, 2 * math.pi, 50)
    assert (terrain.height(0.39 * np.cos(angle), 0.39 * np.sin(angle)) == 0).all()
    assert terrain.height(2.5, 0.0) == 0


def test_smooth_ground_has_its_amplitude_and_starts_level():
    terrain = Smooth(amplitude=0.04, clear=0.3)
    assert np.abs(terrain.field.heights).max() == pytest.approx(0.04)
    assert np.abs(terrain.height(*np.random.default_rng(0).uniform(-0.2, 0.2, (2, 50)))).max() == 0
    assert terrain.height(3.0, 0.0) == 0


def test_stairs_and_gaps_are_where_they_are_said_to_be():
    stairs = Stairs(rise=0.03, tread=0.2, steps=2, start=0.5)
    assert stairs.height([0.4, 0.6, 0.8, 5.0], 0.0) == pytest.approx([0, 0.03, 0.06, 0.06])
    gaps = Gaps(width=0.1, spacing=0.3, count=2, depth=0.2, start=0.5)
    assert gaps.height([0.45, 0.55, 0.65, 0.85, 0.95], 1.0) == pytest.approx([0, -0.2, 0, -0.2, 0])
    assert Ramp(slope=math.atan(0.5), start=1.0, length=2.0).height([1, 2, 3, 4], 0.0) == pytest.approx([0, 0.5, 1, 1])


@pytest.mark.parametrize(("mode", "white"), [("L", 255), ("I;16", 65535)])
def test_a_picture_is_a_height_field_with_up_along_y(tmp_path, mode, white):
    grey = np.array([[0, white], [0, 0], [0, 0]], dtype=np.uint8 if white == 255 else np.uint16)
    Image.fromarray(grey).save(tmp_path / "hill.png")
    terrain = HeightField.from_png(tmp_path / "hill.png", size=(2.0, 4.0), rise=0.3, friction=0.5)
    assert terrain.heights == pytest.approx(np.array([[0, 0], [0, 0], [0, 0.3]]))
    assert terrain.height(0.999999, 1.999999) == pytest.approx(0.3, abs=1e-5)
    assert terrain.friction == 0.5


def test_a_picture_that_cannot_be_read_is_refused(tmp_path, monkeypatch):
    (tmp_path / "note.png").write_text("no picture")
    with pytest.raises(InputError, match="can't be read as a picture"):
        HeightField.from_png(tmp_path / "note.png", size=(1, 1), rise=0.1)
    monkeypatch.setitem(sys.modules, "PIL", None)
    with pytest.raises(TarsusError, match=r"pip install 'tarsus\[plots\]'"):
        HeightField.from_png(tmp_path / "note.png", size=(1, 1), rise=0.1)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Flat(friction=0), "friction is 0"),
        (lambda: Flat(friction=math.nan), "friction is nan"),
        (lambda: Ramp(slope=0.0), "slope is 0 deg; it must be between -60 and 60 deg, and not 0"),
        (lambda: Ramp(slope=1.5), "slope is 85.9"),
        (lambda: Ramp(slope=0.1, length=0), "length is 0"),
        (lambda: Step(rise=0.0), "rise is 0 m"),
        (lambda: Step(rise=math.nan), "rise is nan m"),
        (lambda: Stairs(rise=math.inf), "rise is inf m"),
        (lambda: Stairs(rise=0.1, steps=0), "steps is 0; there must be at least 1"),
        (lambda: Stairs(rise=0.1, steps=1.5), "steps is 1.5; there must be at least 1, and a whole number of them"),
        (lambda: Stairs(rise=0.1, steps=math.nan), "steps is nan"),
        (lambda: Stairs(rise=0.1, steps=200), "the stairs go from 0.5 to 50.25 m; the ground goes from -50 to 50 m"),
        (lambda: Stairs(rise=0.1, start=math.nan), "the stairs go from nan to nan m"),
        (lambda: Ramp(slope=0.1, start=math.nan), "the ramp goes from nan to nan m"),
        (lambda: Ramp(slope=0.1, length=60), "the ramp goes from 0.5 to 60.5 m; the ground goes from -50 to 50 m"),
        (lambda: Gaps(count=0), "count is 0; there must be at least 1"),
        (lambda: Gaps(count=1.5), "count is 1.5; there must be at least 1, and a whole number of them"),
        (lambda: Gaps(count=200), "the gaps go from 0.5 to 80.15 m; the ground goes from -50 to 50 m"),
        (lambda: Gaps(start=math.nan), "the gaps go from nan to nan m"),
        (lambda: Step(rise=0.1, start=-50), "the step goes from -50 to -50 m; the ground goes from -50 to 50 m"),
        (lambda: Step(rise=0.1, start=math.nan), "the step goes from nan to nan m"),
        (lambda: Gaps(width=0.4, spacing=0.4), "width is 0.4 m; it must be less than the spacing, 0.4 m"),
        (lambda: Box(rise=0.0), "rise is 0"),
        (lambda: Box(yaw=math.inf), "yaw is inf deg; it must be a finite number"),
        (lambda: Box(length=60), "the box goes from 0.5 to 60.5 m; the ground goes from -50 to 50 m"),
        (lambda: Box(aside=50), "the box goes sideways from 49.97 to 50.03 m; the ground goes from -50 to 50 m"),
        (lambda: Blocks(size=0.01), "takes 160000 blocks of 0.01 m; there may be 1 to 4096"),
        (lambda: Blocks(size=9.0), "takes 0 blocks"),
        (lambda: Blocks(clear=-1), "clear is -1"),
        (lambda: Smooth(wavelength=0.01), "wavelength is 0.01 m; on an extent of 2 m it must be at least 0.064 m"),
        (lambda: HeightField(heights=np.zeros(3), size=(1, 1)), "heights has shape (3,)"),
        (lambda: HeightField(heights=np.full((2, 2), np.nan), size=(1, 1)), "not a finite number"),
        (lambda: HeightField(heights=np.zeros((2, 2)), size=(1, -1)), "size is -1"),
        (lambda: HeightField(heights=GRID, size=(3, 120)), "size is 120 m; it must be less than 100 m"),
        (lambda: Smooth(extent=50, wavelength=5), "extent is 50 m; it must be less than 50 m"),
    ],
)
def test_a_terrain_that_cannot_be_is_refused(make, message):
    with pytest.raises(InputError, match=re.escape(message)):
        make()


def drawn_height(solids, x, y):
    """The height of the drawn ground at a point: the highest box, triangle or cell over it."""
    heights = [0.0] if solids.level else []
    low, high = solids.boxes[:, 0], solids.boxes[:, 1]
    over = (low[:, 0] <= x) & (x <= high[:, 0]) & (low[:, 1] <= y) & (y <= high[:, 1])
    heights += high[over, 2].tolist()
    for corners in solids.triangles:
        edges = np.column_stack([corners[1] - corners[0], corners[2] - corners[0]])
        if abs(np.linalg.det(edges[:2])) > 1e-9:
            u, v = np.linalg.solve(edges[:2], np.array([x, y]) - corners[0, :2])
            if min(u, v, 1 - u - v) >= 0:
                heights.append(float(corners[0, 2] + edges[2] @ (u, v)))
    if solids.field is not None:
        (x0, y0), (x1, y1) = solids.field.corners
        if x0 <= x <= x1 and y0 <= y <= y1:
            same = HeightField(heights=solids.field.heights, size=(x1 - x0, y1 - y0))
            heights.append(float(same.height(x, y)))
    return max(heights)


def test_a_terrain_that_the_engine_refuses_is_an_error():
    with pytest.raises(InputError, match="the physics engine refuses Ramp"):
        terrain_solids(Ramp(slope=0.1, length=1e-9))


@pytest.mark.parametrize("terrain", TERRAINS, ids=lambda each: type(each).__name__)
def test_the_shapes_to_draw_are_those_of_the_physics_engine(terrain):
    solids = terrain_solids(terrain)
    x, y = np.random.default_rng(2).uniform(-2.5, 2.5, (2, 40))
    found = [drawn_height(solids, *place) for place in zip(x, y, strict=True)]
    assert terrain.height(x, y) == pytest.approx(np.array(found), abs=1e-5)
    # Seen from outside: the normals of the triangles point away from the middle of their wedge.
    for wedge in solids.triangles.reshape(-1, 12, 3, 3):
        normals = np.cross(wedge[:, 1] - wedge[:, 0], wedge[:, 2] - wedge[:, 0])
        assert (((wedge.mean(1) - wedge.mean((0, 1))) * normals).sum(1) > 0).all()
