"""Terrain from a line of text, in mm and degrees."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tarsus.errors import InputError, UnknownNameError
from tarsus.simulation.terrain import Blocks, Box, Flat, Gaps, Ramp, Smooth, Stairs, Step
from tarsus.simulation.terrain.from_text import terrain_from_text, terrain_help
from tarsus.simulation.terrain.kinds import TERRAINS, terrain_of, terrain_parameters


@pytest.mark.parametrize(
    ("text", "terrain"),
    [
        ("flat", Flat()),
        ("ramp", Ramp(slope=math.radians(5))),
        ("ramp:slope=-8,start=300", Ramp(slope=math.radians(-8), start=0.3)),
        ("step:rise=15", Step(rise=0.015)),
        ("stairs:rise=10,steps=3,tread=200", Stairs(rise=0.01, steps=3, tread=0.2)),
        ("blocks:rise=20, seed=4", Blocks(rise=0.02, seed=4)),
        ("smooth:amplitude=12,wavelength=500", Smooth(amplitude=0.012, wavelength=0.5)),
        ("box:rise=300,aside=-170,yaw=90", Box(rise=0.3, aside=-0.17, yaw=math.pi / 2)),
        ("gaps:width=30,count=2,friction=0.5", Gaps(width=0.03, count=2, friction=0.5)),
    ],
)
def test_values_are_in_mm_and_degrees(text, terrain):
    assert terrain_from_text(text) == terrain


def test_friction_is_that_of_any_terrain():
    assert terrain_from_text("step:rise=15", friction=0.3).friction == 0.3


def test_a_picture_is_a_height_field(tmp_path):
    path = tmp_path / "hill.PNG"
    Image.fromarray(np.array([[0, 0, 0], [0, 255, 0], [0, 0, 0]], dtype=np.uint8)).save(path)
    found = terrain_from_text(f"{path}:rise=40,length=1000,width=1000")
    assert found.height(0.0, 0.0) == pytest.approx(0.04, abs=1e-3)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("hills", UnknownNameError, "no terrain is called 'hills'"),
        ("blocks:height=20", InputError, "terrain 'blocks' has no parameter 'height'; it has rise, size, extent"),
        ("blocks:rise=tall", InputError, "terrain 'blocks:rise=tall': 'rise=tall' is not of the form NAME=NUMBER"),
        ("blocks:rise=20,rise=30", InputError, "terrain 'blocks:rise=20,rise=30': rise is given twice"),
        ("blocks:rise", InputError, "'rise' is not of the form NAME=NUMBER, such as rise=20"),
        ("blocks:seed=1.5", InputError, "seed is 1.5; it must be a whole number"),
        (
            "blocks:rise=-5,seed=1",
            InputError,
            "terrain 'blocks' with rise -5 mm, seed 1: rise is -0.005 m; it must be a finite number, not negative",
        ),
        ("nosuch.png", InputError, "nosuch.png can't be read as a picture: No such file or directory"),
        ("missing.png:steps=3", InputError, "terrain 'missing.png' has no parameter 'steps'"),
    ],
)
def test_what_is_wrong_is_named(text, error, message):
    with pytest.raises(error) as caught:
        terrain_from_text(text)
    assert message in str(caught.value)


def test_the_help_has_every_kind():
    lines = terrain_help().splitlines()
    assert [line.partition(":")[0] for line in lines] == [*TERRAINS, "FILE.png"]
    assert "box: rise, length, width, start, aside, yaw, friction" in lines
    assert "gaps: width, spacing, count, depth, start, friction" in lines


@pytest.mark.parametrize("kind", TERRAINS)
def test_parameters_have_the_values_of_the_terrain_in_mm_and_degrees(kind):
    parameters = terrain_parameters(kind)
    given = {parameter.name: parameter.default for parameter in parameters}
    assert terrain_of(kind, given) == terrain_of(kind, {}) == terrain_from_text(kind)
    assert {parameter.name for parameter in parameters if parameter.unit == "deg"} <= {"slope", "yaw"}
    assert {parameter.name for parameter in parameters if parameter.whole} <= {"seed", "steps", "count"}


def test_the_documents_have_every_parameter_with_its_default():
    page = (Path(__file__).parents[1] / "docs" / "simulation.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", page, flags=re.MULTILINE))
    for kind in TERRAINS:
        for parameter in terrain_parameters(kind):
            where = rows["Flat" if parameter.name == "friction" else kind.capitalize()]
            assert f"{parameter.name} {parameter.default:g}" in where, (kind, parameter)
