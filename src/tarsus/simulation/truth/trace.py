"""What a simulated robot did, sample by sample, and what was commanded."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from tarsus.arrays import read_only
from tarsus.control.control_output import ControlOutput
from tarsus.errors import InputError
from tarsus.gait.storage import labels, write_table
from tarsus.kinematics.pose import Pose, stack_poses
from tarsus.robot.robot import JOINTS, Robot
from tarsus.simulation.plant_state import PlantState

if TYPE_CHECKING:
    import xarray
    from jaxtyping import Bool, Float, Shaped

__all__ = ["Trace", "trace_to_csv", "trace_to_dataset"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Trace:
    """A simulated robot over time. Arrays have a row for each tick; the first is the robot after it has settled.

    Attributes
    ----------
    robot : Robot
        Which robot.
    time : array, shape (n,)
        Time since the start [s].
    commanded_body : Pose
        Pose of B in G that was commanded, with batch axes ``(n,)``.
    commanded_angles : array, shape (n, legs, 3)
        Joint angles that were commanded [rad].
    commanded_belly : array of bool, shape (n,)
        Whether the body was to rest on the ground.
    body : Pose
        Pose of B in G in physics, with batch axes ``(n,)``.
    angles, speeds, torques : array, shape (n, legs, 3)
        Joint angles [rad], joint speeds [rad/s] and torques of the servos [N m].
    saturated : array of bool, shape (n, legs, 3)
        Whether the servos gave all the torque that they can at their speed.
    foot_forces : array, shape (n, legs, 3)
        Forces of the ground on the feet, in G [N].
    slip_speeds : array, shape (n, legs)
        Speeds of the feet's contact points over the ground [m/s].
    body_touches : array of bool, shape (n,)
        Whether the body is in contact with the ground.
    """

    robot: Robot
    time: Float[np.ndarray, "n"]
    commanded_body: Pose
    commanded_angles: Float[np.ndarray, "n legs 3"]
    commanded_belly: Bool[np.ndarray, "n"]
    body: Pose
    angles: Float[np.ndarray, "n legs 3"]
    speeds: Float[np.ndarray, "n legs 3"]
    torques: Float[np.ndarray, "n legs 3"]
    saturated: Bool[np.ndarray, "n legs 3"]
    foot_forces: Float[np.ndarray, "n legs 3"]
    slip_speeds: Float[np.ndarray, "n legs"]
    body_touches: Bool[np.ndarray, "n"]

    @classmethod
    def of(cls, robot: Robot, commanded: Sequence[ControlOutput], states: Sequence[PlantState]) -> Self:
        """Return the trace of commands and the states that they led to.

        Parameters
        ----------
        robot : Robot
            Which robot.
        commanded : sequence of ControlOutput
            What was executed in the tick that led to each state.
        states : sequence of PlantState
            The states.
        """

        def column(name: str) -> Shaped[np.ndarray, "n *shape"]:
            return read_only(np.array([getattr(state, name) for state in states]))

        return cls(
            robot=robot,
            time=column("time"),
            commanded_body=stack_poses([output.body for output in commanded]),
            commanded_angles=read_only(np.array([output.angles for output in commanded])),
            commanded_belly=read_only(np.array([output.belly for output in commanded])),
            body=stack_poses([state.body for state in states]),
            angles=column("joint_angles"),
            speeds=column("joint_speeds"),
            torques=column("torques"),
            saturated=column("saturated"),
            foot_forces=column("foot_forces"),
            slip_speeds=column("slip_speeds"),
            body_touches=column("body_touches"),
        )

    def __repr__(self) -> str:
        return f"Trace({self.robot.name!r}, {len(self.time)} samples, {self.time[-1]:.2f} s)"


def trace_to_csv(trace: Trace, path: str | os.PathLike[str]) -> None:
    """Write all of a trace as a table: a row for each tick, units in the header (mm, deg, s, N, N m).

    Parameters
    ----------
    trace : Trace
        The trace.
    path : path
        Where to write it.

    Raises
    ------
    InputError
        If it can't be written.
    """
    columns = dict(_columns(trace))
    write_table(path, columns, ([f"{value:.6g}" for value in row] for row in zip(*columns.values(), strict=True)))


def _columns(trace: Trace) -> Iterator[tuple[str, Float[np.ndarray, "n"]]]:
    yield "time_s", trace.time
    for prefix, pose in (("", trace.body), ("commanded_", trace.commanded_body)):
        for axis, values in zip("xyz", 1000 * pose.position.T, strict=True):
            yield f"{prefix}body_{axis}_mm", values
        for axis, values in zip(("roll", "pitch", "yaw"), np.degrees(pose.rpy).T, strict=True):
            yield f"{prefix}body_{axis}_deg", values
    yield "body_touches", trace.body_touches.astype(float)
    per_joint = (
        ("commanded_deg", np.degrees(trace.commanded_angles)),
        ("angle_deg", np.degrees(trace.angles)),
        ("speed_deg_s", np.degrees(trace.speeds)),
        ("torque_nm", trace.torques),
        ("saturated", trace.saturated.astype(float)),
    )
    for leg, code in enumerate(trace.robot.leg_codes):
        for joint, name in enumerate(JOINTS):
            for what, values in per_joint:
                yield f"{code}_{name}_{what}", values[:, leg, joint]
        for axis, values in zip("xyz", trace.foot_forces[:, leg].T, strict=True):
            yield f"{code}_foot_force_{axis}_n", values
        yield f"{code}_foot_slip_mm_s", 1000 * trace.slip_speeds[:, leg]


# Axes and attributes of the arrays of a trace in a data set.
_PER_LEG = ("time", "leg")
_PER_JOINT = (*_PER_LEG, "joint")
_VARIABLES: dict[str, tuple[tuple[str, ...], dict[str, str]]] = {
    "commanded_angles": (_PER_JOINT, {"units": "rad"}),
    "commanded_belly": (("time",), {}),
    "angles": (_PER_JOINT, {"units": "rad"}),
    "speeds": (_PER_JOINT, {"units": "rad/s"}),
    "torques": (_PER_JOINT, {"units": "N m"}),
    "saturated": (_PER_JOINT, {}),
    "foot_forces": ((*_PER_LEG, "axis"), {"units": "N", "frame": "ground"}),
    "slip_speeds": (_PER_LEG, {"units": "m/s"}),
    "body_touches": (("time",), {}),
}


def trace_to_dataset(trace: Trace) -> xarray.Dataset:
    """Return a trace as a labelled `xarray.Dataset` in SI units (needs the extra ``data``).

    Parameters
    ----------
    trace : Trace
        The trace.

    Raises
    ------
    InputError
        If xarray is not installed.
    """
    try:
        import xarray
    except ImportError:
        raise InputError("trace_to_dataset needs xarray: pip install 'tarsus[data]'") from None
    poses = {"body": trace.body, "commanded_body": trace.commanded_body}
    return xarray.Dataset(
        {
            **{name: (axes, getattr(trace, name), about) for name, (axes, about) in _VARIABLES.items()},
            **{
                f"{name}_position": (("time", "axis"), pose.position, {"units": "m", "frame": "ground"})
                for name, pose in poses.items()
            },
            **{f"{name}_rotation": (("time", "axis", "body_axis"), pose.rotation) for name, pose in poses.items()},
        },
        coords={
            "time": ("time", trace.time, {"units": "s"}),
            "leg": labels(trace.robot.leg_codes),
            "joint": labels(JOINTS),
            "axis": labels("xyz"),
            "body_axis": labels("xyz"),
        },
        attrs={"robot": trace.robot.name},
    )
