"""The rest stance, from which every leg can step: the middle of the range it reaches (source 001)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tarsus.arrays import Array, Namespace, as_array, as_floats, is_traced, namespace, require_finite, root, stack_last
from tarsus.errors import UnreachableError
from tarsus.kinematics.nearest import tibia_bend, tibia_branch
from tarsus.kinematics.reach import ANGLE_TOLERANCE
from tarsus.kinematics.triangle import direction, to_leg_frame
from tarsus.kinematics.underside import belly_depth
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot, require_robot

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Int

__all__ = [
    "default_body_height",
    "default_stance",
    "default_swing_height",
    "foothold_distances",
    "footholds_straight_out",
    "reachable_band",
    "stance_or_nan",
]

# Body heights at which a message looks for footholds, before it refines those at the ends.
_SCANNED = 2000


def default_body_height(robot: Robot) -> Float[Array, "..."]:
    """Return the default height of the body's origin above the ground [m].

    That of the robot file; else the least over all legs of the height with a vertical tibia and the femur 30 deg
    above the horizontal, but with the femur axis at least half the length of the tibia above the ground.

    Parameters
    ----------
    robot : Robot
        The robot; for a batch of designs, the least body height of all is returned.
    """
    require_robot(robot)
    if robot.gait.body_height is not None:
        return robot.gait.body_height
    g = robot.geometry
    xp = namespace(*g)
    g = g.to(xp)
    least = xp.min(xp.maximum(g.tibia - g.femur / 2, g.tibia / 2) - (g.mount_z + g.up))
    return least if is_traced(least) else float(least)


def default_swing_height(robot: Robot) -> Float[Array, ""]:
    """Return the default swing height [m]: that of the robot file, else a quarter of the default body height.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    """
    require_robot(robot)
    return robot.gait.swing_height if robot.gait.swing_height is not None else abs(default_body_height(robot)) / 4


def reachable_band(
    robot: Robot, height: Float[Array, "*#batch"]
) -> tuple[Float[Array, "*batch legs"], Float[Array, "*batch legs"]]:
    """Return the least and greatest distance from the coxa axis at which each foot can stand in the leg's plane.

    Source 001's `x_min` and `x_max` with the joint limits: at the ends, femur or tibia are at a limit, or the leg is
    straight or folded. Of several separate bands, the widest. The coxa is at 0, or at the limit nearest to 0; the knee
    is up.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    height : array, shape (...)
        Height of the feet in B [m]: the negative of the body height.

    Returns
    -------
    nearest, farthest : array, shape (..., legs)
        Distances from the coxa axis in the leg's plane [m]; NaN where the height is out of reach.

    Raises
    ------
    InputError
        If a height is not a finite number.
    """
    require_robot(robot)
    g = robot.geometry
    xp = namespace(height, *g)
    g = g.to(xp)
    z = as_floats(xp, height, name="height")
    require_finite("height", z)
    z = z[..., None] - (g.mount_z + g.up)
    return _widest_band(xp, g, [z])


def _widest_band(
    xp: Namespace, g: LegGeometry, heights: Sequence[Float[Array, "*#batch legs"]]
) -> tuple[Float[Array, "*batch legs"], Float[Array, "*batch legs"]]:
    """Return the ends of the widest band that each foot reaches at all the heights over the femur axis; else NaN."""
    every_end = [end for z in heights for end in _band_ends(xp, g, z)]
    ends = xp.sort(xp.stack(xp.broadcast_arrays(*every_end)), axis=0)
    lows, highs = ends[:-1, ...], ends[1:, ...]
    between_open = _in_limits(xp, g, (lows + highs) / 2, heights[0])
    for z in heights[1:]:
        between_open = between_open & _in_limits(xp, g, (lows + highs) / 2, z)
    zero = xp.zeros_like(ends[0, ...])
    start, best_start, best_end = zero, zero, zero
    was_open = zero > 1
    for i in range(lows.shape[0]):
        low, high, is_open = lows[i, ...], highs[i, ...], between_open[i, ...]
        start = xp.where(is_open & ~was_open, low, start)
        wider = is_open & (high - start > best_end - best_start)
        best_start, best_end = xp.where(wider, start, best_start), xp.where(wider, high, best_end)
        # A gap of zero width between two equal ends does not divide a band.
        was_open = is_open | (was_open & (high <= low))
    none = best_end <= best_start
    nan = xp.full_like(best_start, xp.nan)
    return xp.where(none, nan, best_start + g.coxa), xp.where(none, nan, best_end + g.coxa)


def _band_ends(xp: Namespace, g: LegGeometry, z: Float[Array, "*#batch legs"]) -> list[Float[Array, "... legs"]]:
    """Return the distances from the femur axis at which a joint is at a limit, none of them behind the coxa axis."""
    behind = -g.coxa + xp.zeros_like(z)
    ends = [behind]
    for tibia in tibia_branch(xp, g, knee=1):
        across2 = g.sum2 + 2 * g.femur * g.tibia * xp.cos(tibia) - z * z
        ends += [root(xp, across2), -root(xp, across2)]
    for femur in (g.femur_lower, g.femur_upper):
        drop = z - g.femur * xp.sin(femur)
        across = root(xp, g.tibia * g.tibia - drop * drop)
        ends += [g.femur * xp.cos(femur) + across, g.femur * xp.cos(femur) - across]
    return [xp.maximum(end, behind) for end in ends]


def _in_limits(
    xp: Namespace, g: LegGeometry, r: Float[Array, "... legs"], z: Float[Array, "*#batch legs"]
) -> Bool[Array, "... legs"]:
    distance2 = r * r + z * z
    far, near = g.farthest2 - distance2, distance2 - g.nearest2
    height = tibia_bend(xp, g, knee=1) * root(xp, far * near)
    base = distance2 + g.difference2
    femur = direction(xp, z * base - r * height, r * base + z * height)
    tibia = direction(xp, height, distance2 - g.sum2)
    within = (far >= 0) & (near >= 0)
    for angle, lower, upper in ((femur, g.femur_lower, g.femur_upper), (tibia, g.tibia_lower, g.tibia_upper)):
        within = within & (angle >= lower - ANGLE_TOLERANCE) & (angle <= upper + ANGLE_TOLERANCE)
    return within


def default_stance(
    robot: Robot,
    body_height: Float[Array, "*#batch"] | None = None,
    *,
    swing_height: Float[Array, "*#batch"] | None = None,
) -> Float[Array, "*batch legs 3"]:
    """Return the rest footholds in the body frame: the stance in which walks, poses and live driving start.

    With the coxa at 0 (or at the limit nearest to 0), in the middle of the distances reachable both on the ground and
    at the swing height, so that every leg can step. At a swing height of 0 it is source 001's
    ``x_min + (x_max - x_min) / 2``.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    body_height : array, shape (...), optional
        Height of the body's origin above the ground [m]. Default: `default_body_height`.
    swing_height : array, shape (...), optional
        Height above the ground to which each foot can be lifted [m]. Default: `default_swing_height`.

    Returns
    -------
    array, shape (..., legs, 3)
        Footholds in B [m]; z is the negative of the body height.

    Raises
    ------
    InputError
        If the body height or the swing height is not a finite number.
    UnreachableError
        If a leg does not reach the ground at that body height; the message gives the body heights that are possible.
    """
    require_robot(robot)
    height = default_body_height(robot) if body_height is None else body_height
    rise = default_swing_height(robot) if swing_height is None else swing_height
    feet = stance_or_nan(robot, height, swing_height=rise)
    xp = namespace(feet)
    missing = xp.isnan(feet[..., 0])
    if not is_traced(feet) and bool(xp.any(missing)):
        raise UnreachableError(_why_no_stance(robot, np.asarray(height), np.asarray(rise), np.asarray(missing)))
    return feet


def stance_or_nan(
    robot: Robot, body_height: Float[Array, "*#batch"], *, swing_height: Float[Array, "*#batch"]
) -> Float[Array, "*batch legs 3"]:
    """Return the rest footholds as `default_stance` does, with NaN for legs that do not reach the ground.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    body_height : array, shape (...)
        Height of the body's origin above the ground [m].
    swing_height : array, shape (...)
        Height above the ground to which each foot can be lifted [m].

    Returns
    -------
    array, shape (..., legs, 3)
        Footholds in B [m]; x and y are NaN for a leg without one.

    Raises
    ------
    InputError
        If the body height or the swing height is not a finite number.
    """
    xp = namespace(body_height, swing_height, *robot.geometry)
    z, rise = -as_floats(xp, body_height, name="body_height"), as_floats(xp, swing_height, name="swing_height")
    require_finite("body_height", -z)
    require_finite("swing_height", rise)
    return footholds_straight_out(robot, _middle(xp, robot, z, rise), z)


def footholds_straight_out(
    robot: Robot, distances: Float[Array, "*#batch legs"], height: Float[Array, "*#batch"]
) -> Float[Array, "*batch legs 3"]:
    """Return the footholds straight out from the coxa axes: with the coxa at 0, or at the limit nearest to 0.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    distances : array, shape (..., legs)
        Distances as `foothold_distances` returns them [m].
    height : array, shape (...)
        Height of the feet in B [m].

    Returns
    -------
    array, shape (..., legs, 3)
        Footholds in B [m].
    """
    g = robot.geometry
    xp = namespace(distances, height, *g)
    g = g.to(xp)
    zero = xp.zeros_like(distances)
    coxa = xp.minimum(xp.maximum(zero, g.coxa_lower), g.coxa_upper)
    out_x, out_y = distances * xp.cos(coxa) - g.side * xp.sin(coxa), distances * xp.sin(coxa) + g.side * xp.cos(coxa)
    x = g.mount_x + g.cos_yaw * out_x - g.sin_yaw * out_y
    y = g.mount_y + g.sin_yaw * out_x + g.cos_yaw * out_y
    return stack_last(xp, (x, y, as_array(xp, height)[..., None] + zero))


def foothold_distances(robot: Robot, feet: Float[Array, "*#batch legs 3"]) -> Float[Array, "*batch legs"]:
    """Return the distance of each foot from its coxa axis along the plane of the leg.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    feet : array, shape (..., legs, 3)
        Feet in B [m].

    Returns
    -------
    array, shape (..., legs)
        Distances [m].
    """
    xp = namespace(feet, *robot.geometry)
    g = robot.geometry.to(xp)
    x, y, _ = to_leg_frame(g, feet[..., 0], feet[..., 1], feet[..., 2])
    return root(xp, x * x + y * y - g.side2)


def _middle(
    xp: Namespace, robot: Robot, height: Float[Array, "*#batch"], swing_height: Float[Array, "*#batch"]
) -> Float[Array, "... legs"]:
    """Return the middle of the widest band that each foot reaches on the ground and lifted; NaN where none is."""
    g = robot.geometry.to(xp)
    axis = g.mount_z + g.up
    low, high = _widest_band(xp, g, [height[..., None] - axis, (height + swing_height)[..., None] - axis])
    return (low + high) / 2


def _why_no_stance(
    robot: Robot,
    body_height: Float[np.ndarray, "*#batch"],
    swing_height: Float[np.ndarray, "*#batch"],
    missing: Bool[np.ndarray, "... legs"],
) -> str:
    """Return which leg has no foothold, and the body heights at which all legs of that design have one."""
    *batch, leg = (int(i) for i in np.argwhere(missing)[0])
    where, whole = tuple(batch), missing.shape[:-1]
    height, rise = (float(np.broadcast_to(values, whole)[where]) * 1000 for values in (body_height, swing_height))
    lifted = f" with a swing height of {rise:.1f} mm" if rise else ""
    text = (
        f"{f'{batch} ' if batch else ''}body height {height:.1f} mm: leg {robot.leg_names[leg]} does not reach the "
        f"ground{lifted} within its joint limits"
    )
    possible = _possible_heights(robot.item(where, of=whole), height, rise)
    if not len(possible):
        return f"{text}, and there is no body height above the ground at which all legs do"
    nearest = possible[np.argmin(np.abs(possible - height))]
    return (
        f"{text}; all legs do at body heights between {possible.min():.1f} and {possible.max():.1f} mm, "
        f"the nearest is {nearest:.1f} mm"
    )


def _possible_heights(robot: Robot, height: float, rise: float) -> Float[np.ndarray, "n"]:
    """Return the least and the greatest body height at which all legs have a foothold, and those near `height` [mm].

    They are multiples of 0.1 mm, so that they are possible as printed, and leave the body above the ground. Ranges of
    less than a 2000th of the reach may be missed.
    """

    def possible(steps: Int[np.ndarray, "n"]) -> Int[np.ndarray, "m"]:
        missing = np.isnan(_middle(np, robot, -steps / 1e4, np.asarray(rise / 1000))).any(-1)
        return np.asarray(steps[~missing])

    g, depth = robot.geometry, belly_depth(robot)
    # Not below the origin either, unless the whole body is above it.
    least = max(depth - float(robot.foot_radius.min()), min(depth, 0.0))
    reach = float((g.femur + g.tibia).max() + np.abs(g.mount_z + g.up).max())
    first, last = math.ceil(least * 1e4), math.ceil(reach * 1e4)
    stride = max((last - first) // _SCANNED, 1)
    coarse = possible(np.arange(first, last + 1, stride))
    if not len(coarse):
        return coarse / 10
    ends = coarse[np.array([0, -1, np.argmin(np.abs(coarse - height * 10))])]
    around = np.unique(ends[:, None] + np.arange(-stride, stride + 1))
    return possible(around[around >= first]) / 10
