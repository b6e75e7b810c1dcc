"""Robot files with one mistake each, made from the presets: for the table in docs/robot-check.md and for the tests."""

from __future__ import annotations

import copy
import math
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from tarsus import (
    RobotFileError,
    load_robot,
    plausibility_warnings,
    robot_from_dict,
    robot_to_dict,
)
from tarsus.robot.catalogue import figures_of
from tarsus.robot.document import plain

__all__ = ["MISTAKES", "TEXTS", "Mistake", "answers", "sound", "table", "text_answer"]

Document = dict[str, Any]
JOINTS = ("coxa", "femur", "tibia")
FRONT_RIGHT, FRONT_LEFT, REAR_LEFT, REAR_RIGHT = -1, 0, 2, 3


@dataclass(frozen=True)
class Mistake:
    """A mistake: its group, in words, how it is made, and a word of the cause that must be named.

    `make` changes a document, and returns False where the mistake is none for that robot.
    """

    group: str
    words: str
    make: Callable[[Document], bool | None]
    cause: str

    def of(self, name: str) -> Document | None:
        """Return the preset's document with the mistake; None if it is none there."""
        document = sound(name)
        before = copy.deepcopy(document)
        if self.make(document) is False or document == before:
            return None
        return document


def sound(name: str) -> Document:
    """Return the document of a preset, with masses, a box and a servo where it has none."""
    return copy.deepcopy(_sound(name))


@cache
def _sound(name: str) -> Document:
    document = robot_to_dict(load_robot(name))
    document.setdefault("body", {}).setdefault("mass_kg", 1.2)
    places = [leg["position_mm"] for leg in document["legs"]]
    extent = [max(place[axis] for place in places) - min(place[axis] for place in places) for axis in (0, 1)]
    document["body"].setdefault("size_mm", [*extent, 50])
    document["leg"].setdefault("mass_kg", {"coxa": 0.07, "femur": 0.08, "tibia": 0.06})
    document["leg"].setdefault("foot_radius_mm", 8)
    servo = load_robot(name).servos[0][0] or load_robot("strider").servos[0][0]
    assert servo is not None
    document["leg"]["servo"] = plain(figures_of(servo))
    return document


def answers(document: Document) -> list[str]:
    """Return what is said to a document: why it is refused, or the warnings."""
    try:
        robot = robot_from_dict(document)
    except RobotFileError as error:
        return list(error.problems)
    return [warning.text() for warning in plausibility_warnings(robot)]


def table() -> str:
    """Return the table of mistakes and of what is said, made in the strider's file or in another preset's."""
    lines = ["| what is wrong | in | message |", "|---|---|---|"]
    lines += [f"| {words} | | {_escaped(text_answer(text))} |" for words, (text, _) in TEXTS.items()]
    for mistake in MISTAKES:
        name, document = next(
            (name, made) for name in ("strider", "phoenix", "makeyourpet") if (made := mistake.of(name)) is not None
        )
        said = answers(document)
        shown = next((text for text in said if mistake.cause in text), said[0] if said else "nothing")
        more = f" (and {len(said) - 1} more)" if len(said) > 1 else ""
        lines.append(f"| {mistake.words} | {name} | {_escaped(shown)}{more} |")
    return "\n".join(lines)


def text_answer(text: str) -> str:
    """Return what is said to a file with that text."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "my-robot.toml"
        path.write_text(text, encoding="utf-8")
        try:
            load_robot(path)
        except RobotFileError as error:
            return error.problems[0]
    raise AssertionError(text)


def _escaped(text: str) -> str:
    # Two pairs of brackets would be a link.
    return text.replace("[[", "\\[[").replace("\n", " ")


def _legs(document: Document) -> Iterator[Document]:
    yield document["leg"]
    yield from document["legs"]


def _scale(factor: float, *keys: str) -> Callable[[Document], None]:
    """Multiply keys such as ``leg.femur_mm`` or ``legs.position_mm``."""

    def make(document: Document) -> None:
        for key in keys:
            table, _, name = key.partition(".")
            holders = list(_legs(document)) if table == "leg" else document[table]
            for holder in holders if isinstance(holders, list) else [holders]:
                if name in holder:
                    holder[name] = _scaled(holder[name], factor)

    return make


def _scaled(value: Any, factor: float) -> Any:
    if isinstance(value, dict):
        return {key: _scaled(item, factor) for key, item in value.items()}
    if isinstance(value, list):
        return [_scaled(item, factor) for item in value]
    return float(f"{value * factor:.6g}")


_LINKS = ("leg.coxa_mm", "leg.femur_mm", "leg.tibia_mm", "leg.com_mm")
_LENGTHS = (*_LINKS, "leg.foot_radius_mm", "legs.position_mm", "body.size_mm", "body.com_mm")
_ALL_LENGTHS = (*_LENGTHS, "gait.body_height_mm", "gait.swing_height_mm")


def _limits(change: Callable[[float, float], tuple[float, float]], *joints: str) -> Callable[[Document], bool]:
    """Change the limits of joints that don't turn all the way round; clip at 180 deg as a file must."""

    def make(document: Document) -> bool:
        changed = False
        for leg in _legs(document):
            for joint, (low, high) in list(leg.get("limits_deg", {}).items()):
                if joint in joints and high - low < 300:
                    limits = [float(f"{angle:.6g}") for angle in sorted(change(low, high))]
                    changed |= limits != [low, high]
                    leg["limits_deg"][joint] = limits
        return changed

    return make


def _clipped(*limits: float) -> tuple[float, float]:
    low, high = (min(max(limit, -180.0), 180.0) for limit in limits)
    return low, high


def _yaw(change: Callable[[float, Document], float]) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        for leg in document["legs"]:
            leg["yaw_deg"] = change(leg["yaw_deg"], leg)

    return make


def _one(index: int, key: str, change: Callable[[Any], Any]) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        document["legs"][index][key] = change(document["legs"][index][key])

    return make


def _positions(change: Callable[[float, float], tuple[float, float]]) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        for leg in document["legs"]:
            x, y, z = leg["position_mm"]
            leg["position_mm"] = [*change(x, y), z]

    return make


def _rename(*pair: str) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        for leg in document["legs"]:
            for old, new in (pair, pair[::-1]):
                if old in leg["name"]:
                    leg["name"] = leg["name"].replace(old, new)
                    break

    return make


def _exchange(key: str, one: int, other: int) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        legs = document["legs"]
        legs[one][key], legs[other][key] = legs[other][key], legs[one][key]

    return make


def _set(way: str, value: Any) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        table, _, name = way.partition(".")
        document.setdefault(table, {})[name] = value

    return make


def _in_reverse(document: Document) -> None:
    document["legs"] = document["legs"][::-1]


def _swap_two(document: Document) -> None:
    legs = document["legs"]
    legs[1], legs[2] = legs[2], legs[1]


def _limits_reversed(document: Document) -> None:
    for leg in _legs(document):
        for limits in leg.get("limits_deg", {}).values():
            limits.reverse()


def _coxa_of_the_left(document: Document) -> bool:
    """Give each right leg the coxa limits of the left leg opposite."""
    limits = [leg.get("limits_deg", {}).get("coxa") for leg in document["legs"]]
    if None in limits or max(abs(sum(pair)) for pair in limits) < 30:
        return False
    for right, left in ((3, 2), (4, 1), (5, 0)):
        document["legs"][right]["limits_deg"]["coxa"] = limits[left]
    return True


def _coxa_from_ahead(document: Document) -> None:
    """Count the coxa limits of the left legs and of the front right one from x, those behind within a turn."""
    shared = document["leg"].get("limits_deg", {}).pop("coxa", None)
    for leg in document["legs"]:
        low, high = leg.setdefault("limits_deg", {}).get("coxa", shared)
        leg["limits_deg"]["coxa"] = list(_clipped(low + leg["yaw_deg"], high + leg["yaw_deg"]))


def _all_coxa(low: float, high: float) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        for leg in _legs(document):
            leg.get("limits_deg", {}).pop("coxa", None)
        document["leg"]["limits_deg"]["coxa"] = [low, high]

    return make


def _servo_range(document: Document) -> None:
    for leg in _legs(document):
        leg.pop("limits_deg", None)
    document["leg"]["limits_deg"] = {joint: [0, 180] for joint in JOINTS}


def _servo(key: str, change: Callable[[float], float]) -> Callable[[Document], bool]:
    def make(document: Document) -> bool:
        servo = document["leg"]["servo"]
        if key not in servo:
            return False
        servo[key] = float(f"{change(servo[key]):.6g}")
        return True

    return make


def _link_mass(joint: str, factor: float) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        document["leg"]["mass_kg"][joint] *= factor

    return make


def _link_com(document: Document) -> None:
    femur = document["leg"]["femur_mm"]
    document["leg"].setdefault("com_mm", {})["femur"] = femur * 5


def _together(*steps: Callable[[Document], bool | None]) -> Callable[[Document], bool]:
    def make(document: Document) -> bool:
        return sum(step(document) is not False for step in steps) > 0

    return make


def _first_legs(count: int) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        document["legs"] = document["legs"][:count]

    return make


def _move(key: str, table: str) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        document[key] = document[table].pop(key)

    return make


def _without(table: str, key: str) -> Callable[[Document], None]:
    def make(document: Document) -> None:
        del document[table][key]

    return make


def _misspelt(document: Document) -> None:
    document["leg"]["femmur_mm"] = document["leg"].pop("femur_mm")


def _same_name(document: Document) -> None:
    document["legs"][1]["name"] = document["legs"][0]["name"]


TEXTS = {
    "an empty file": ("", "the file is empty"),
    "prose": ("This is a robot.", "not valid TOML"),
    "JSON": ('{"name": "strider", "legs": []}', "a robot file is TOML"),
    "a decimal comma": ('name = "strider"\n[leg]\ncoxa_mm = 68,5\n', "a decimal comma; write 68.5"),
    "a unit after a number": ('name = "strider"\n[leg]\ncoxa_mm = 68 mm\n', "a unit after the number"),
    "a string without its closing quote": ('name = "strider\n[leg]\n', "a quote is missing"),
    "a key given twice": ('name = "strider"\nname = "rider"\n', "cannot overwrite a value"),
}
"""Texts that are no robot file, and words of what is said."""

MISTAKES = (
    Mistake("keys", "a key misspelt", _misspelt, "did you mean 'femur_mm'?"),
    Mistake("keys", "a key in the wrong table", _move("femur_mm", "leg"), "it belongs to [leg]"),
    Mistake("keys", "a key missing", _without("leg", "tibia_mm"), "every leg needs it"),
    Mistake("keys", "the mass of one link only", _set("leg.mass_kg", {"femur": 0.1}), "or of none"),
    Mistake("keys", "a number in quotes", _set("leg.coxa_mm", "68"), "without quotes"),
    Mistake("keys", "a number with its unit", _set("leg.coxa_mm", "68 mm"), "without a unit"),
    Mistake("keys", "a negative length", _scale(-1, "leg.femur_mm"), "must be from 0.001"),
    Mistake("keys", "one limit only", _set("leg.limits_deg", {joint: [60] for joint in JOINTS}), "a list of 2 numbers"),
    Mistake("keys", "a servo that is not in the catalogue", _set("leg.servo", "MG-996"), "did you mean 'MG996R'?"),
    Mistake("keys", "a gait that does not exist", _set("gait.name", "tripd"), "did you mean 'tripod'?"),
    Mistake("keys", "two legs", _first_legs(2), "there must be at least 4"),
    Mistake("keys", "two legs of the same name", _same_name, "has the same name"),
    Mistake("units", "all lengths in cm", _scale(0.1, *_ALL_LENGTHS), "cm"),
    Mistake("units", "all lengths in m", _scale(0.001, *_ALL_LENGTHS), " m instead"),
    Mistake("units", "all lengths in inches", _scale(1 / 25.4, *_ALL_LENGTHS), "inches"),
    Mistake("units", "lengths of the legs in cm", _scale(0.1, *_LINKS), "cm"),
    Mistake("units", "positions of the coxa axes in cm", _scale(0.1, "legs.position_mm"), "cm"),
    Mistake("units", "positions of the coxa axes in m", _scale(0.001, "legs.position_mm"), " m instead"),
    Mistake("units", "size of the body in cm", _scale(0.1, "body.size_mm"), "cm"),
    Mistake("units", "body height in cm", _scale(0.1, "gait.body_height_mm"), "cm"),
    Mistake("units", "swing height in cm", _scale(0.1, "gait.swing_height_mm"), "cm"),
    Mistake("units", "all masses in g", _scale(1000, "body.mass_kg", "leg.mass_kg"), "in g"),
    Mistake("units", "mass of the body in g", _scale(1000, "body.mass_kg"), "in g"),
    Mistake("units", "masses of the links in g", _scale(1000, "leg.mass_kg"), "in g"),
    Mistake("units", "mass of the femur in g", _link_mass("femur", 1000), "femur is in g"),
    Mistake("units", "yaw in radians", _yaw(lambda yaw, _: round(math.radians(yaw), 4)), "radians"),
    Mistake(
        "units", "all limits in radians", _limits(lambda a, b: (a * math.pi / 180, b * math.pi / 180), *JOINTS), "rad"
    ),
    Mistake(
        "units", "coxa limits in radians", _limits(lambda a, b: (a * math.pi / 180, b * math.pi / 180), "coxa"), "rad"
    ),
    Mistake(
        "units", "limits in tenths of a degree", _limits(lambda a, b: (10 * a, 10 * b), *JOINTS), "tenths of a degree"
    ),
    Mistake(
        "units",
        "limits as pulse widths",
        _limits(lambda a, b: (1500 + a * 1000 / 99.1, 1500 + b * 1000 / 99.1), *JOINTS),
        "pulse widths",
    ),
    Mistake("units", "stall torque in kg cm", _servo("stall_torque_nm", lambda v: v / 0.0980665), "kg cm"),
    Mistake("units", "no-load speed in rpm", _servo("no_load_rad_s", lambda v: v * 30 / math.pi), "rpm"),
    Mistake(
        "units",
        "no-load speed as seconds for 60 degrees",
        _servo("no_load_rad_s", lambda v: math.pi / 3 / v),
        "60 degrees",
    ),
    Mistake("units", "mass of the servo in kg", _servo("mass_g", lambda v: v / 1000), "kg instead of g"),
    Mistake(
        "signs", "yaw of the front right leg positive", _one(FRONT_RIGHT, "yaw_deg", lambda yaw: -yaw), "sign is wrong"
    ),
    Mistake("signs", "yaw clockwise", _yaw(lambda yaw, _: -yaw), "clockwise"),
    Mistake(
        "signs", "yaw of the right legs as on the left", _yaw(lambda yaw, _: abs(yaw)), "right legs have the angles of"
    ),
    Mistake("signs", "y positive to the right", _positions(lambda x, y: (x, -y)), "y points right"),
    Mistake("signs", "x positive backward", _positions(lambda x, y: (-x, y)), "x points backward"),
    Mistake(
        "signs",
        "y of the front right leg positive",
        _one(FRONT_RIGHT, "position_mm", lambda p: [p[0], -p[1], p[2]]),
        "wrong sign",
    ),
    Mistake(
        "signs",
        "x of the front left leg negative",
        _one(FRONT_LEFT, "position_mm", lambda p: [-p[0], p[1], p[2]]),
        "wrong sign",
    ),
    Mistake(
        "signs",
        "tibia positive for a bent knee",
        _limits(lambda a, b: (-a, -b), "tibia"),
        "positive angles bend the knee",
    ),
    Mistake(
        "signs",
        "femur and tibia positive downward",
        _limits(lambda a, b: (-a, -b), "femur", "tibia"),
        "positive angles bend the knee",
    ),
    Mistake(
        "signs", "femur positive downward", _limits(lambda a, b: (-a, -b), "femur"), "positive angles lower the foot"
    ),
    Mistake("signs", "coxa limits of the left legs copied to the right", _coxa_of_the_left, "copied"),
    Mistake("order", "x and y of all legs exchanged", _positions(lambda x, y: (y, x)), "x and y are exchanged"),
    Mistake("order", "x to the right and y forward", _positions(lambda x, y: (-y, x)), "x points right and y forward"),
    Mistake("order", "limits with the upper one first", _limits_reversed, "reversed"),
    Mistake("order", "legs listed clockwise", _in_reverse, "clockwise"),
    Mistake("order", "two legs exchanged in the list", _swap_two, "must be listed counter-clockwise"),
    Mistake(
        "order", "names of left and right exchanged", _rename("left", "right"), "left and right legs are exchanged"
    ),
    Mistake(
        "order", "names of front and rear exchanged", _rename("front", "rear"), "front and rear legs are exchanged"
    ),
    Mistake(
        "order", "yaw of front left and rear left exchanged", _exchange("yaw_deg", FRONT_LEFT, REAR_LEFT), "exchanged"
    ),
    Mistake("order", "size of the body as height, width, length", lambda d: d["body"]["size_mm"].reverse(), "order"),
    Mistake("zeros", "yaw measured from the left", _yaw(lambda yaw, _: yaw - 90), "measured from the left"),
    Mistake(
        "zeros",
        "yaw from the foot to the body",
        _yaw(lambda yaw, _: yaw - math.copysign(180, yaw)),
        "from the foot to the body",
    ),
    Mistake("zeros", "yaw of all legs 0", _yaw(lambda _, leg: 0.0 * leg["yaw_deg"]), "own direction"),
    Mistake(
        "zeros",
        "tibia measured from the right angle",
        _limits(lambda a, b: _clipped(a + 90, b + 90), "tibia"),
        "right angle",
    ),
    Mistake(
        "zeros",
        "tibia as the angle inside the knee",
        _limits(lambda a, b: _clipped(a + 180, b + 180), "tibia"),
        "inside the knee",
    ),
    Mistake(
        "zeros",
        "limits of the Phoenix firmware",
        _together(_limits(lambda a, b: (-a, -b), "femur"), _limits(lambda a, b: _clipped(a + 90, b + 90), "tibia")),
        "right angle",
    ),
    Mistake(
        "zeros",
        "femur measured from straight down",
        _limits(lambda a, b: _clipped(a + 90, b + 90), "femur"),
        "straight down",
    ),
    Mistake(
        "zeros",
        "femur measured from straight up",
        _limits(lambda a, b: _clipped(a - 90, b - 90), "femur"),
        "straight up",
    ),
    Mistake("zeros", "limits of the servo, 0 to 180", _servo_range, "0 to 180"),
    Mistake("zeros", "coxa limits as 0 to 180", _all_coxa(0, 180), "0 to 180"),
    Mistake("zeros", "coxa limits measured from x", _coxa_from_ahead, "forward direction"),
    Mistake("magnitudes", "femur ten times as long", _scale(10, "leg.femur_mm"), "digit"),
    Mistake("magnitudes", "tibia a tenth as long", _scale(0.1, "leg.tibia_mm"), "digit"),
    Mistake("magnitudes", "coxa ten times as long", _scale(10, "leg.coxa_mm"), "digit"),
    Mistake(
        "magnitudes",
        "tibia of one leg ten times as long",
        lambda d: d["legs"][1].update(tibia_mm=d["leg"]["tibia_mm"] * 10),
        "digit",
    ),
    Mistake(
        "magnitudes",
        "x of the front left leg ten times as large",
        _one(FRONT_LEFT, "position_mm", lambda p: [p[0] * 10, *p[1:]]),
        "digit",
    ),
    Mistake(
        "magnitudes",
        "y of the rear right leg without a digit",
        _one(REAR_RIGHT, "position_mm", lambda p: [p[0], p[1] / 10, p[2]]),
        "digit",
    ),
    Mistake(
        "magnitudes",
        "yaw of the front left leg without a digit",
        _one(FRONT_LEFT, "yaw_deg", lambda yaw: yaw / 10),
        "digit",
    ),
    Mistake("magnitudes", "body height ten times as large", _scale(10, "gait.body_height_mm"), "digit"),
    Mistake("magnitudes", "swing height ten times as large", _scale(10, "gait.swing_height_mm"), "digit"),
    Mistake("magnitudes", "radius of the feet ten times as large", _scale(10, "leg.foot_radius_mm"), "digit"),
    Mistake("magnitudes", "centre of mass 500 mm ahead", _set("body.com_mm", [500, 0, 0]), "another origin"),
    Mistake("magnitudes", "centre of mass of the femur off the link", _link_com, "digit"),
)
