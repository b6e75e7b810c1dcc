"""Scenarios as values, files and text: every form says the same, and what is wrong is reported with its place."""

import dataclasses
import os
import re
import tomllib
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus.control.pose.admittance import Admittance
from tarsus.errors import InputError, TarsusError, UnknownNameError
from tarsus.scenario.commands import (
    COMMANDS,
    BodyHeight,
    CycleTime,
    FootTarget,
    FootVelocity,
    Force,
    GaitChange,
    SwingHeight,
    Walk,
)
from tarsus.scenario.file import load_scenario, save_scenario, scenario_from_dict, scenario_from_text, scenario_to_dict
from tarsus.scenario.quantities import UNITS
from tarsus.scenario.scenario import Scenario
from tarsus.scenario.settings import ADMITTANCE, LEVELLINGS, STARTS
from tarsus.scenario.timed_command import GAIT_NAMES, quantities

# Names that need quotes, and escapes, are names too.
LEGS = st.one_of(st.sampled_from(["RF", "front left", "L1", '"', "a;b#c\n", "Bein-ü"]), st.text(min_size=1, max_size=8))
MOMENTS = st.one_of(st.sampled_from([0.0, 0.5, 2.0]), st.floats(0, 900))


@st.composite
def commands(draw):
    """Any command with any values within their bounds."""
    kind = COMMANDS[draw(st.sampled_from(sorted(COMMANDS)))]
    values = {}
    for name, each in quantities(kind).items():
        low, high = (UNITS[each.unit].to_si(Decimal(str(bound))) for bound in (each.low, each.high))
        # The bounds hold for the number in the file's unit: a last digit within them.
        number = st.floats(low * (1 - 1e-12), high * (1 - 1e-12)).filter(lambda v, low=low: v >= low)
        values[name] = draw(st.one_of(number, st.sampled_from(each.words)) if each.words else number)
    for name, names in (("leg", LEGS), ("gait", st.sampled_from(GAIT_NAMES))):
        if name in {field.name for field in dataclasses.fields(kind)}:
            values[name] = draw(names)
    return kind(draw(MOMENTS), **values)


@st.composite
def admittances(draw):
    """Any way of giving way within its bounds."""
    values = {}
    for each in ADMITTANCE:
        low, high = (UNITS[each.unit].to_si(Decimal(str(bound))) for bound in (each.low, each.high))
        values[each.name] = draw(st.floats(low * (1 + 1e-12), high * (1 - 1e-12)))
    return Admittance(**values)


@st.composite
def scenarios(draw):
    """Any scenario."""
    rate = draw(st.floats(40, 1000))
    return Scenario(
        tuple(draw(st.lists(commands(), max_size=6))),
        name=draw(st.text(max_size=10)),
        robot=draw(st.text(max_size=10)),
        rate=rate,
        jitter=draw(st.floats(0, 0.9)) / rate,
        seed=draw(st.integers(0, 2**53)),
        start=draw(st.sampled_from(STARTS)),
        duration=draw(st.none() | st.floats(0.1, 100)),
        gait=draw(st.sampled_from(["", *GAIT_NAMES])),
        levelling=draw(st.sampled_from(["", *LEVELLINGS])),
        body_height=draw(st.none() | st.floats(0.001, 0.9)),
        swing_height=draw(st.none() | st.floats(0, 0.9)),
        admittance=draw(st.none() | admittances()),
    )


@given(scenario=scenarios())
def test_every_scenario_comes_back_from_its_document_to_the_bit(scenario):
    assert scenario_from_dict(scenario_to_dict(scenario)) == scenario


@given(scenario=scenarios())
def test_every_scenario_comes_back_from_its_file_to_the_bit(scenario, tmp_path_factory):
    path = tmp_path_factory.getbasetemp() / "scenario.toml"
    save_scenario(scenario, path)
    assert load_scenario(path) == scenario


@given(scenario=scenarios())
def test_the_timeline_says_the_same_as_the_commands(scenario):
    assert scenario_from_text(scenario.timeline).commands == scenario.commands
    document = {**scenario_to_dict(scenario), "timeline": scenario.timeline}
    document.pop("at", None)
    assert scenario_from_dict(document) == scenario


def test_text_and_tables_of_the_same_commands_are_the_same():
    text = scenario_from_text(
        """
        at 500 ms: stand_up                 # a remark
        at 2.0 s: walk 0.1 m/s; gait wave
        at 5s: walk speed 10cm/s heading 90 deg turn -5 deg/s; body z -1 cm pitch 5 deg
        body_height 90 mm; swing_height 0.03 m; stance_width 5 mm; cycle_time 900 ms; sway z 2 mm
        at 6 s: foot_target RF x 250 mm y -.12e3 mm z +60. mm; ground "front left" 10 mm; tilt roll 3 deg
        foot_velocity RF vx 2 cm/s vz -10 mm/s; force RF -2.5 N; cycle_time auto
        at 7 s: foot_release RF; stop; body; sit; fold; power_off
        """
    )
    tables = scenario_from_dict(
        {
            "at": [
                {"time_s": 0.5, "do": "stand_up"},
                {"time_s": 2, "walk": {"vx_mm_s": 100}},
                {"time_s": 2, "gait": "wave"},
                {"time_s": 5, "walk": {"vy_mm_s": 100, "turn_deg_s": -5}},
                {"time_s": 5, "body": {"z_mm": -10, "pitch_deg": 5}},
                {"time_s": 5, "body_height_mm": 90},
                {"time_s": 5, "swing_height_mm": 30},
                {"time_s": 5, "stance_width_mm": 5},
                {"time_s": 5, "cycle_time_s": 0.9},
                {"time_s": 5, "sway": {"z_mm": 2}},
                {"time_s": 6, "foot_targets_mm": {"RF": [250, -120, 60]}},
                {"time_s": 6, "ground_mm": {"front left": 10}},
                {"time_s": 6, "tilt": {"roll_deg": 3}},
                {"time_s": 6, "foot_velocities_mm_s": {"RF": [20, 0, -10]}},
                {"time_s": 6, "force_n": {"RF": -2.5}},
                {"time_s": 6, "cycle_time_s": "auto"},
                {"time_s": 7, "foot_targets_mm": {"RF": "release"}},
                {"time_s": 7, "do": "stop"},
                {"time_s": 7, "body": {}},
                {"time_s": 7, "do": "sit"},
                {"time_s": 7, "do": "fold"},
                {"time_s": 7, "do": "power_off"},
            ]
        }
    )
    assert text == tables
    assert {type(command) for command in text.commands} == set(COMMANDS.values())


def test_tables_hold_several_commands_of_a_moment():
    several = scenario_from_dict(
        {"at": [{"time_s": 1, "gait": "wave", "walk": {"speed_mm_s": 50}, "swing_height_mm": 20}]}
    )
    assert several == scenario_from_text("at 1 s: gait wave; walk 50 mm/s; swing_height 20 mm")


def test_timeline_and_tables_of_one_document_are_put_in_the_order_of_their_times():
    both = scenario_from_dict({"timeline": "at 0 s: stop; at 9 s: stop", "at": [{"time_s": 3, "gait": "wave"}]})
    assert [command.at for command in both.commands] == [0, 3, 9]


def test_straight_to_the_left_is_not_a_little_forward():
    (walk,) = scenario_from_text("at 0 s: walk 60 mm/s heading 90 deg").commands
    assert (walk.vx, walk.vy) == (0.0, 0.06)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("walk 1 m/s", "line 1 of the timeline: the first command needs a time"),
        ("at 2: stop", "line 1 of the timeline: at 2 has no unit; it must have s or ms"),
        ("at 2 mm: stop", "at 2 has the unit 'mm'; it must have s or ms"),
        ("at -1 s: stop", "at = -1 s: must be from 0 to 3600 s"),
        ("at: stop", "at needs a number with its unit, s or ms, not ':'"),
        ("at 1 s stop", "a colon must follow the time"),
        ("at 1 s:", "a command is missing; known: stand_up, walk"),
        ("\n\nat 1 s: wlak", "line 3 of the timeline: no command is called 'wlak'. Did you mean 'walk'? There are: "),
        ("at 1 s: walk 5", "speed 5 has no unit; it must have mm/s or cm/s or m/s"),
        ("at 1 s: walk 5 deg", "speed 5 has the unit 'deg'; it must have mm/s"),
        ("at 1 s: walk 1e9 m/s", "speed = 1e9 m/s: must be from -10000 to 10000 mm/s"),
        ("at 1 s: walk vx", "vx needs a number with its unit"),
        ("at 1 s: walk vx 5 mm/s vx 6 mm/s", "vx is given twice"),
        ("at 1 s: walk vx 5 mm/s speed 6 mm/s", "speed and heading are the same as vx and vy"),
        ("at 1 s: walk heading 6 deg", "heading needs speed"),
        ("at 1 s: walk trun 6 deg/s", "no number of walk is called 'trun'. Did you mean 'turn'?"),
        ("at 1 s: body 5 mm", "5 has no name; give its name: x, y, z, roll, pitch, yaw"),
        ("at 1 s: stop 5 mm", "5 has no name; stop takes no numbers"),
        ("at 1 s: stop now", "unexpected 'now': stop takes no numbers"),
        ("at 1 s: gait", "a gait is missing; known: tripod"),
        ("at 1 s: gait wavy", "no gait is called 'wavy'. Did you mean 'wave'?"),
        ("at 1 s: swing_height", "swing_height needs swing_height (mm)"),
        ("at 1 s: foot_target", "foot_target needs a leg, such as RF"),
        ("at 1 s: foot_target RF x 5 mm", "foot_target needs y (mm), z (mm)"),
        ('at 1 s: foot_release "R\\F"', "is not a valid string: a backslash"),
        ("at 1 s: cycle_time", "cycle_time needs cycle_time (s, or auto)"),
        ("at 1 s: cycle_time aut", "cycle_time needs a number with its unit, s or ms, or auto, not 'aut'"),
        ("at 1 s: cycle_time auto 2 s", "cycle_time is given twice"),
        ("at 1 s: cycle_time 99 s", "cycle_time = 99 s: must be from 0.01 to 60 s"),
        ("at 1 s: swing_height auto", "swing_height needs a number with its unit, mm or cm or m, not 'auto'"),
        ("at 1 s: foot_velocity 5 mm/s", "foot_velocity needs a leg, such as RF"),
        ("at 1 s: foot_velocity RF 5 mm/s", "5 has no name; give its name: vx, vy, vz"),
        ("at 1 s: foot_velocity RF vz 2 m/s", "vz = 2 m/s: must be from -1000 to 1000 mm/s"),
        ("at 1 s: force 5 N", "force needs a leg, such as RF"),
        ("at 1 s: force RF", "force needs force (N)"),
        ("at 1 s: force RF 5 mm", "force 5 has the unit 'mm'; it must have N"),
        ("at 1 s: force RF 1001 N", "force = 1001 N: must be from -1000 to 1000 N"),
        ("at 1 s: walk §", "no number of walk is called '§'"),
    ],
)
def test_errors_in_a_timeline_name_its_line(text, wanted):
    for read in (scenario_from_text, lambda timeline: scenario_from_dict({"timeline": timeline})):
        with pytest.raises(InputError) as rejected:
            read(text)
        assert wanted in str(rejected.value)


def test_all_problems_of_a_timeline_are_reported_and_long_ones_are_shortened():
    with pytest.raises(InputError, match="2 problems") as rejected:
        scenario_from_text("at 1 s: " + "x" * 500 + "\nat 2 s: stop\nat 3 s: hop")
    assert "..." in str(rejected.value)
    assert "line 3" in str(rejected.value)


@pytest.mark.parametrize(
    ("document", "wanted"),
    [
        ({"rate_hz": 5}, "rate_hz = 5: must be from 20 to 1000 Hz"),
        ({"rat_hz": 50}, "rat_hz: unknown key; did you mean 'rate_hz'?"),
        ({"qqq": 50}, "qqq: unknown key; known here: name, robot"),
        ({"walk": {}}, "walk: unknown key; it belongs to a table [[at]]"),
        ({"timeline": 4}, "timeline = 4: must be text in quotes"),
        ({"at": {}}, "at: must be a list of tables, each under [[at]]"),
        ({"at": [4]}, "at[0] = 4: must be a table of keys"),
        ({"at": [{"gait": "wave"}]}, "at[0].time_s: missing; time of the commands [s]"),
        ({"at": [{"time_s": 3}]}, "at[0]: no command; there are: do, gait, walk"),
        ({"at": [{"time_s": 3, "do": "sitt"}]}, 'at[0].do = "sitt": must be one of stand_up'),
        ({"at": [{"time_s": 3, "walk": {"vx_mm": 3}}]}, "at[0].walk.vx_mm: unknown key; did you mean 'vx_mm_s'?"),
        ({"at": [{"time_s": 3, "wlak": {}}]}, "at[0].wlak: unknown key; did you mean 'walk'?"),
        ({"at": [{"time_s": 3, "body": 4}]}, "at[0].body = 4: must be a table of keys"),
        ({"at": [{"time_s": 3, "walk": {"heading_deg": 4}}]}, "at[0]: heading needs speed"),
        ({"at": [{"time_s": 3, "foot_targets_mm": {"RF": [1, 2]}}]}, "RF: must be a list of 3 numbers"),
        ({"at": [{"time_s": 3, "ground_mm": {"RF": "release"}}]}, "RF: must be a number from -1000 to 1000 mm"),
        (
            {"at": [{"time_s": 3, "foot_targets_mm": {"RF": "bak"}}]},
            'RF: must be a list of 3 numbers from -1000 to 1000 mm, or "release"',
        ),
        (
            {"at": [{"time_s": 3, "foot_velocities_mm_s": {"RF": "release"}}]},
            "RF: must be a list of 3 numbers from -1000 to",
        ),
        (
            {"at": [{"time_s": 3, "foot_velocities_mm_s": {"RF": [0, 0, 2e3]}}]},
            "RF: the third number must be from -1000",
        ),
        ({"at": [{"time_s": 3, "force_n": {"RF": 2e3}}]}, "at[0].force_n: RF: must be from -1000 to 1000 N"),
        ({"at": [{"time_s": 3, "force_n": {"RF": [1, 2, 3]}}]}, "RF: must be a number from -1000 to 1000 N"),
        (
            {"at": [{"time_s": 3, "cycle_time_s": "aut"}]},
            'cycle_time_s = "aut": must be a number from 0.01 to 60 s, or "auto"',
        ),
        ({"at": [{"time_s": 3, "cycle_time_s": 0}]}, 'cycle_time_s = 0: must be from 0.01 to 60 s, or "auto"'),
        ({"admittance": 5}, "admittance = 5: must be a table of keys"),
        ({"admittance": {"mass_kg": 0}}, "admittance.mass_kg = 0: must be from 0.1 to 1000 kg"),
        ({"admittance": {"mass_kg": 1}}, "admittance.damping_ns_m: missing; virtual damping of a foot [N s/m]"),
        ({"admittance": {"stifness_n_m": 1}}, "admittance.stifness_n_m: unknown key; did you mean 'stiffness_n_m'?"),
        ({"at": [{"time_s": 3, "ground_mm": 5}]}, "at[0].ground_mm = 5: must be a table of legs"),
    ],
)
def test_problems_of_a_document_are_reported_with_their_key(document, wanted):
    with pytest.raises(InputError) as rejected:
        scenario_from_dict(document)
    assert wanted in str(rejected.value)


def test_problems_of_a_file_are_reported_with_the_line_of_their_table(tmp_path):
    path = tmp_path / "wrong.toml"
    path.write_text(
        "name = 'x'\n\n[[at]]\ntime_s = 1\ndo = 'stop'\n\n[[at]]\ntime_s = 2\nswing_height_mm = -1\n", encoding="utf-8"
    )
    with pytest.raises(
        InputError, match=r"at\[1\].swing_height_mm \(in the table of line 7\) = -1: must be from 0 to 1000 mm"
    ):
        load_scenario(path)
    path.write_text("\n[[at]]\ntime_s = 2\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"at\[0\] \(line 2\): no command"):
        load_scenario(path)


@pytest.mark.parametrize(
    ("content", "wanted"),
    [
        (b"at = 5 5", r"bad.toml: line 1, column 8: not valid TOML: .*; in: at = 5 5"),
        (b'start = "lying\n', r"bad.toml: line 1, column 15: not valid TOML: .*Likely cause: a quote is missing"),
        (b"at = " + b"9" * 5000, "bad.toml: a number has too many digits"),
        (b"\xff\xfe", "byte 0 is not UTF-8"),
        (b"#" * (2**20 + 1), "larger than 1 MiB"),
    ],
)
def test_files_that_are_none_are_refused(content, wanted, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=wanted):
        load_scenario(path)


def test_unreadable_and_unwritable_files_are_reported(tmp_path):
    with pytest.raises(InputError, match="can't be read: No such file"):
        load_scenario(tmp_path / "none.toml")
    with pytest.raises(InputError, match="can't be read: not a valid path"):
        load_scenario("\0")
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(InputError, match="is a pipe or a device"):
        load_scenario(tmp_path / "pipe.toml")
    with pytest.raises(InputError, match="can't be written"):
        save_scenario(Scenario(), tmp_path)
    with pytest.raises(InputError, match="can't be written: not a valid path"):
        save_scenario(Scenario(), "\0")


@pytest.mark.parametrize(
    ("changes", "wanted"),
    [
        ({"commands": (3,)}, "are Walk, Stop and the like, not 3"),
        ({"start": "stading"}, "no start is called 'stading'. Did you mean 'standing'?"),
        ({"gait": "wavy"}, "Did you mean 'wave'?"),
        ({"admittance": 400.0}, "admittance is an Admittance or None, not 400.0"),
        (
            {"admittance": Admittance(mass=0.01, damping=1.0, stiffness=1.0)},
            "admittance: mass is 0.01 kg; it must be from 0.1 to 1000 kg",
        ),
        ({"rate": 5.0}, "rate is 5 Hz; it must be from 20 to 1000 Hz"),
        ({"body_height": float("nan")}, "body_height is nan; it must be a finite number"),
        ({"duration": 0.0}, "duration is 0 s"),
        ({"jitter": 0.02}, "it must be less than a tick, 0.01 s"),
        ({"rate": 25.0, "jitter": 0.02}, "a tick takes up to 0.06 s; at most 0.05 s works"),
        ({"rate": 1000.0, "duration": 2000.0}, "2e[+]06 ticks, more than 1000000"),
    ],
)
def test_scenarios_that_can_not_be_are_refused(changes, wanted):
    with pytest.raises(TarsusError, match=wanted.replace("?", ".")):
        Scenario(**changes)


@pytest.mark.parametrize(
    ("make", "wanted"),
    [
        (lambda: Walk(-1.0), "walk: at is -1 s; it must be from 0 to 3600 s"),
        (lambda: Walk(0.0, vx=float("nan")), "vx is nan; it must be a finite number"),
        (lambda: Walk(0.0, vx="fast"), "vx is 'fast'; it must be a finite number"),
        (lambda: Walk(0.0, vx=True), "vx is True; it must be a finite number"),
        (lambda: BodyHeight(1.0, body_height=-0.1), "body_height is -100 mm; it must be from 0.001 to 1000 mm"),
        (lambda: CycleTime(1.0, cycle_time="aut"), "cycle_time is 'aut'; it must be a finite number, or 'auto'"),
        (lambda: SwingHeight(1.0, swing_height="auto"), "swing_height is 'auto'; it must be a finite number"),
        (
            lambda: FootVelocity(1.0, leg="RF", vz=2.0),
            "foot_velocity at 1 s: vz is 2000 mm/s; it must be from -1000 to 1000",
        ),
        (lambda: Force(1.0, leg="RF", force=2e3), "force at 1 s: force is 2000 N; it must be from -1000 to 1000 N"),
        (lambda: FootTarget(1.0, leg="RF", x=2.0, y=0.0, z=0.0), "foot_target at 1 s: x is 2000 mm"),
    ],
)
def test_commands_out_of_their_bounds_are_refused(make, wanted):
    with pytest.raises(InputError) as rejected:
        make()
    assert wanted in str(rejected.value)


def test_unknown_gaits_are_refused_with_the_nearest():
    with pytest.raises(UnknownNameError, match="Did you mean 'ripple'"):
        GaitChange(0.0, gait="riple")


def test_a_page_of_settings_makes_feet_give_way():
    (example,) = re.findall(r"```toml\n(name = \"a soft foot\".+?)```", PAGE, re.DOTALL)
    soft = scenario_from_dict(tomllib.loads(example))
    assert soft.admittance == Admittance(mass=1.0, damping=60.0, stiffness=400.0, travel=0.01)
    assert scenario_to_dict(soft)["admittance"] == {
        "mass_kg": 1,
        "damping_ns_m": 60,
        "stiffness_n_m": 400,
        "travel_mm": 10,
    }


PAGE = (Path(__file__).parents[1] / "docs" / "scenarios.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| `(.+?)` \| `(.+?)` \|", PAGE.partition("## Commands")[2], re.MULTILINE)


@pytest.mark.parametrize(("text", "table"), ROWS)
def test_the_page_shows_two_forms_of_the_same_command(text, table):
    found = scenario_from_text(f"at 1 s: {text}")
    assert found == scenario_from_dict(tomllib.loads(f"[[at]]\ntime_s = 1\n{table}"))


def test_the_page_shows_every_command():
    assert {text.split()[0] for text, _ in ROWS} == set(COMMANDS)
