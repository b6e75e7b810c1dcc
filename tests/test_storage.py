import csv
import dataclasses
import json
import sys
import zipfile

import numpy as np
import pytest
import xarray

from gait_robots import PRESETS, preset, ring
from tarsus.errors import InputError, RobotFileError
from tarsus.gait.gait import Gait
from tarsus.gait.path import curved_path, straight_path
from tarsus.gait.plan import plan_walk
from tarsus.gait.storage import load_motion, motion_to_csv, motion_to_dataset, save_motion
from tarsus.kinematics.reach import Reach

ARRAYS = ("time", "feet", "contacts", "angles", "reach")
NUMBERS = ("cycle_time", "stroke", "speed", "body_height", "swing_height", "foot_distance")


def walk(robot="strider", **more):
    more = {"stroke": 0.05, "cycle_time": 0.7, "rate": 30, "body_tilt": (0.03, -0.02)} | more
    return plan_walk(preset(robot), Gait.named("ripple"), curved_path(0.3, (0.1, 0.4)), **more)


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_csv_contains_the_motion_in_mm_and_degrees(tmp_path):
    motion = walk()
    motion_to_csv(motion, tmp_path / "walk.csv")
    rows = read_csv(tmp_path / "walk.csv")
    assert len(rows) == motion.time.size

    def column(name):
        return np.array([float(row[name]) for row in rows])

    half = 0.5e-6 * (1 + 1e-6)
    np.testing.assert_allclose(column("time_s"), motion.time, atol=half)
    for leg, code in enumerate(("LF", "LM", "LR", "RR", "RM", "RF")):
        for joint, name in enumerate(("coxa", "femur", "tibia")):
            np.testing.assert_allclose(
                column(f"{code}_{name}_deg"), np.degrees(motion.angles[:, leg, joint]), atol=half, rtol=0
            )
        for axis, letter in enumerate("xyz"):
            np.testing.assert_allclose(
                column(f"{code}_foot_{letter}_mm"), motion.feet[:, leg, axis] * 1000, atol=half, rtol=0
            )
        np.testing.assert_array_equal(column(f"{code}_down"), motion.contacts[:, leg])
        assert {row[f"{code}_reach"] for row in rows} == {"OK"}
    for axis, letter in enumerate("xyz"):
        np.testing.assert_allclose(column(f"body_{letter}_mm"), motion.body.position[:, axis] * 1000, atol=half, rtol=0)
    for axis, name in enumerate(("roll", "pitch", "yaw")):
        np.testing.assert_allclose(column(f"body_{name}_deg"), np.degrees(motion.body.rpy[:, axis]), atol=half, rtol=0)
    np.testing.assert_allclose(column("margin_mm"), motion.margin * 1000, atol=half, rtol=0)
    assert len(rows[0]) == 1 + 18 + 6 + 6 * 5 + 1


def test_csv_names_the_reach_codes_and_writes_no_minus_zero(tmp_path):
    motion = walk(stroke=0.4, strict=False)
    motion_to_csv(motion, str(tmp_path / "walk.csv"))
    rows = read_csv(tmp_path / "walk.csv")
    for leg, code in enumerate(motion.robot.leg_codes):
        assert [Reach[row[f"{code}_reach"]] for row in rows] == motion.reach[:, leg].tolist()
    assert "-0.000000" not in (tmp_path / "walk.csv").read_text()


def test_csv_columns_of_legs_without_short_names(tmp_path):
    names = ("one", "two", "the third leg", "four")
    robot = ring(4, leg_names=names)
    motion = plan_walk(robot, Gait.named("creep", legs=4), straight_path(0.05), rate=30)
    motion_to_csv(motion, tmp_path / "walk.csv")
    assert "the_third_leg_coxa_deg" in read_csv(tmp_path / "walk.csv")[0]


@pytest.mark.parametrize("robot", PRESETS)
def test_loading_gives_the_same_motion_to_the_bit(robot, tmp_path):
    motion = walk(robot, stroke=0.03)
    save_motion(motion, tmp_path / "walk.npz")
    again = load_motion(tmp_path / "walk.npz")
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(again, name), getattr(motion, name), strict=True)
    np.testing.assert_array_equal(again.body.rotation, motion.body.rotation, strict=True)
    np.testing.assert_array_equal(again.body.position, motion.body.position, strict=True)
    for name in NUMBERS:
        assert getattr(again, name) == getattr(motion, name)
    assert (again.robot, again.gait, again.assumed) == (motion.robot, motion.gait, motion.assumed)
    assert again.problems == motion.problems
    save_motion(again, tmp_path / "again.npz")
    assert load_motion(tmp_path / "again.npz").robot == motion.robot


def test_a_motion_planned_with_numpy_numbers_can_be_saved(tmp_path):
    motion = plan_walk(
        preset("strider"),
        Gait(np.float32(0.5), np.arange(6) % 2 / 2),
        straight_path(np.float32(0.1)),
        stroke=np.float32(0.05),
        cycle_time=np.int64(1),
        swing_height=np.float32(0.03),
        body_height=np.float32(0.11),
        foot_distance=np.float32(0.02),
    )
    save_motion(motion, tmp_path / "walk.npz")
    assert load_motion(tmp_path / "walk.npz").stroke == motion.stroke


def test_saving_to_an_invalid_path_is_refused(tmp_path):
    motion = walk()
    for write in (save_motion, motion_to_csv):
        with pytest.raises(InputError, match="can't be written: No such file"):
            write(motion, tmp_path / "nowhere" / "walk")
        with pytest.raises(InputError, match="can't be written: Is a directory"):
            write(motion, tmp_path)


def test_a_missing_or_invalid_file_is_refused(tmp_path):
    with pytest.raises(InputError, match="can't be read: No such file"):
        load_motion(tmp_path / "walk.npz")
    with pytest.raises(InputError, match="can't be read: Is a directory"):
        load_motion(tmp_path)
    for name, content in {
        "empty": b"",
        "text": b"time_s,LF_coxa_deg\n0,1\n",
        "pickle": b"\x80\x04N.",
        "zip": b"PK\x05\x06" + 18 * b"\0",
    }.items():
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(InputError, match="is not a motion file of Tarsus"):
            load_motion(path)
    np.save(tmp_path / "array.npy", np.zeros(3))
    np.savez(tmp_path / "arrays.npz", feet=np.zeros(3))
    for name in ("array.npy", "arrays.npz"):
        with pytest.raises(InputError, match="is not a motion file of Tarsus"):
            load_motion(tmp_path / name)


def rewritten(motion, path, *, about=None, **arrays):
    """Save a motion, then change something in its file."""
    save_motion(motion, path)
    with np.load(path) as file:
        content = dict(file)
    stored = json.loads(str(content["about"])) | (about or {})
    np.savez(path, **{**content, "about": np.array(json.dumps(stored)), **arrays})


def test_another_format_is_refused_by_its_name(tmp_path):
    rewritten(walk(), tmp_path / "walk.npz", about={"format": "tarsus motion 2"})
    with pytest.raises(InputError, match="has the format 'tarsus motion 2'; this version reads 'tarsus motion 1'"):
        load_motion(tmp_path / "walk.npz")


def test_inconsistent_contents_are_refused(tmp_path):
    motion, path = walk(), tmp_path / "walk.npz"
    rewritten(motion, path, feet=motion.feet[:-1])
    with pytest.raises(InputError, match="a motion's feet has shape"):
        load_motion(path)
    rewritten(motion, path, about={"stroke": "long"})
    with pytest.raises(InputError, match="is not a motion file of Tarsus"):
        load_motion(path)
    rewritten(motion, path, about={"gait": {"duty_factor": 2.0, "offsets": [0.0]}})
    with pytest.raises(InputError, match=r"duty_factor is 2\.0"):
        load_motion(path)
    rewritten(motion, path, about={"robot": 'name = "x"\n'})
    with pytest.raises(RobotFileError, match="the robot in "):
        load_motion(path)


@pytest.mark.no_cover
def test_a_damaged_file_is_refused_whatever_is_damaged(tmp_path):
    """Zip, deflate, NumPy's headers and JSON fail in ways of their own: all come out as one error, or do no harm."""
    motion, path = walk(rate=10), tmp_path / "walk.npz"
    save_motion(motion, path)
    content = path.read_bytes()
    for end in range(0, len(content), len(content) // 60):
        path.write_bytes(content[:end])
        with pytest.raises(InputError, match="is not a motion file of Tarsus"):
            load_motion(path)
    refused = 0
    for place in range(0, len(content), max(len(content) // 400, 1)):
        damaged = bytearray(content)
        damaged[place] ^= 0x55
        path.write_bytes(damaged)
        try:
            again = load_motion(path)
        except InputError:
            refused += 1
        else:
            # Dates and attributes of the zip archive are damaged without harm.
            np.testing.assert_array_equal(again.angles, motion.angles)
    assert refused > 300


def test_the_file_is_a_plain_zip_of_arrays_without_pickles(tmp_path):
    save_motion(walk(), tmp_path / "walk.any")
    with zipfile.ZipFile(tmp_path / "walk.any") as file:
        assert {name.removesuffix(".npy") for name in file.namelist()} == {*ARRAYS, "about", "rotation", "position"}
    with np.load(tmp_path / "walk.any", allow_pickle=False) as file:
        assert all(file[name].dtype.kind != "O" for name in file.files)


def test_the_data_set_is_labelled_and_equal():
    motion = walk()
    data = motion_to_dataset(motion)
    assert dict(data.sizes) == {"time": motion.time.size, "leg": 6, "joint": 3, "axis": 3, "body_axis": 3}
    for name, values in {
        "angles": motion.angles,
        "feet": motion.feet,
        "contacts": motion.contacts,
        "reach": motion.reach,
        "margin": motion.margin,
        "body_position": motion.body.position,
        "body_rotation": motion.body.rotation,
    }.items():
        np.testing.assert_array_equal(data[name].values, values)
    np.testing.assert_array_equal(
        data["angles"].sel(leg="RM", joint="tibia", time=motion.time[5]), motion.angles[5, 4, 2]
    )
    assert [data[name].attrs["units"] for name in ("angles", "feet", "time")] == ["rad", "m", "s"]
    assert (data.attrs["robot"], data.attrs["gait"]) == ("strider", "ripple")
    assert {name: data.attrs[name] for name in NUMBERS} == {name: getattr(motion, name) for name in NUMBERS}


def test_the_data_set_names_the_reach_codes():
    """As CF flags: `flag_values` of the variable's own type, `flag_meanings` separated by blanks."""
    reach = motion_to_dataset(walk())["reach"]
    flags = reach.attrs["flag_values"]
    assert flags.dtype == reach.dtype
    named = dict(zip(reach.attrs["flag_meanings"].split(), flags, strict=True))
    assert named == {code.name.lower(): code for code in Reach}


@pytest.mark.parametrize("kind", ["netcdf4", "scipy", "zarr 2", "zarr 3"])
def test_the_data_set_is_the_same_after_writing_and_reading(kind, tmp_path):
    data = motion_to_dataset(walk())
    if kind.startswith("zarr"):
        data.to_zarr(tmp_path / "walk", zarr_format=int(kind[-1]), consolidated=False)
        again = xarray.open_zarr(tmp_path / "walk", chunks=None, consolidated=False)
    else:
        data.to_netcdf(tmp_path / "walk.nc", engine=kind)
        again = xarray.open_dataset(tmp_path / "walk.nc", engine=kind)
    with again:
        xarray.testing.assert_identical(again.load(), data)
    assert {name: again[name].dtype for name in data.data_vars} == {name: data[name].dtype for name in data.data_vars}


def test_without_xarray_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(InputError, match=r"needs xarray: pip install 'tarsus\[data\]'"):
        motion_to_dataset(walk())


def test_a_motion_of_changed_values_is_saved_with_them(tmp_path):
    motion = dataclasses.replace(walk(), assumed=("a thing", "ünicode"))
    save_motion(motion, tmp_path / "walk.npz")
    assert load_motion(tmp_path / "walk.npz").assumed == ("a thing", "ünicode")
