import inspect

import pytest

from tarsus import errors
from tarsus.errors import (
    InputError,
    RobotFileError,
    StrokeError,
    TarsusError,
    UnknownNameError,
    UnreachableError,
    nearest_name,
)

GAITS = ("tripod", "tetrapod", "ripple", "wave")


def test_every_error_is_a_tarsus_error_and_is_exported_and_drawn_in_the_tree():
    classes = {name for name, c in inspect.getmembers(errors, inspect.isclass) if issubclass(c, TarsusError)}
    assert classes == {name for name in errors.__all__ if name[0].isupper()}
    assert all(name in errors.__doc__ for name in classes)


def test_bad_input_is_also_a_value_error():
    assert issubclass(InputError, ValueError)


def test_a_stroke_error_is_caught_as_unreachable_and_carries_the_longest():
    with pytest.raises(UnreachableError, match="too long") as caught:
        raise StrokeError("the stroke is too long", 0.04)
    assert isinstance(caught.value, StrokeError)
    assert caught.value.longest == 0.04


@pytest.mark.parametrize(
    ("problems", "text"),
    [(["a"], "x.toml: 1 problem\n  a"), (["a", "b"], "x.toml: 2 problems\n  a\n  b"), ([], "x.toml: 0 problems")],
)
def test_a_robot_file_error_lists_every_problem(problems, text):
    error = RobotFileError("x.toml", problems)
    assert str(error) == text
    assert error.problems == tuple(problems)


def test_an_unknown_name_lists_the_known_and_suggests_the_nearest():
    error = UnknownNameError.of("gait", "Tripd", iter(GAITS))
    assert str(error) == ("no gait is called 'Tripd'. Did you mean 'tripod'? There are: tripod, tetrapod, ripple, wave")


def test_a_dissimilar_name_gets_no_suggestion():
    assert str(UnknownNameError.of("gait", "zzz", GAITS)) == (
        "no gait is called 'zzz'. There are: tripod, tetrapod, ripple, wave"
    )


@pytest.mark.parametrize(
    ("name", "nearest"),
    [
        ("WAVE", "wave"),
        ("riple", "ripple"),
        ("tetra pod", "tetrapod"),
        ("qqq", None),
        ("rapid", None),
        ("wave-like", "wave"),
        ("", None),
    ],
)
def test_nearest_name(name, nearest):
    assert nearest_name(name, GAITS) == nearest


def test_nearest_name_keeps_the_known_spelling():
    assert nearest_name("ds3225", ["DS3225", "MX-28"]) == "DS3225"
    assert nearest_name("anything", []) is None
