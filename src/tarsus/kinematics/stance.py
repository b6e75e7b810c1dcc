"""Where a leg's foot stands at rest: in the middle of what it can reach at the ground's height (source 001)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tarsus.arrays import Array, Namespace, as_floats, is_traced, namespace, require_finite, root, stack_last
from tarsus.errors import UnreachableError
from tarsus.kinematics.nearest import tibia_bend, tibia_branch
from tarsus.kinematics.reach import ANGLE_TOLERANCE
from tarsus.kinematics.triangle import direction
from tarsus.robot.geometry import LegGeometry
from tarsus.robot.robot import Robot

__all__ = ["default_body_height", "default_stance", "reachable_band", "stance_or_nan"]


def default_body_height(robot: Robot) -> Array:
    """Return the height of the body's origin over the ground that the robot walks at unless told otherwise [m].

    The robot file's `body_height_mm`; where it has none, the least height at which a leg's upright tibia hangs from a
    femur raised by 30 degrees, but at least half the tibia below the femur axis.

    Parameters
    ----------
    robot : Robot
        The robot; of a batch of designs, the least body height of all.
    """
    if robot.gait.body_height is not None:
        return robot.gait.body_height
    g = robot.geometry
    xp = namespace(*g)
    g = g.to(xp)
    least = xp.min(xp.maximum(g.tibia - g.femur / 2, g.tibia / 2) - (g.mount_z + g.up))
    return least if is_traced(least) else float(least)


def reachable_band(robot: Robot, height: Array) -> tuple[Array, Array]:
    """Return the least and greatest distance at which each foot can stand straight out from its coxa axis.

    Source 001's `x_min` and `x_max`, with the joint limits: the ends are where femur or tibia come to a limit, or the
    leg is straight or folded. Where the reachable distances fall apart into several bands, the widest. The coxa
    is at 0, or at the limit nearest to 0; the knee is up.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    height : array, shape (...)
        Height of the feet in B [m]: the negative of the body height.

    Returns
    -------
    nearest, farthest : array, shape (..., legs)
        Distances from the coxa axis along the leg's plane [m]. Both NaN where the height can't be reached.

    Raises
    ------
    InputError
        If a height is not a finite number.
    """
    g = robot.geometry
    xp = namespace(height, *g)
    g = g.to(xp)
    z = as_floats(xp, height, name="height")
    require_finite("height", z)
    z = z[..., None] - (g.mount_z + g.up)
    ends = xp.sort(xp.stack(xp.broadcast_arrays(*_band_ends(xp, g, z))), axis=0)
    lows, highs = ends[:-1, ...], ends[1:, ...]
    between_open = _in_limits(xp, g, (lows + highs) / 2, z)
    zero = xp.zeros_like(ends[0, ...])
    start, best_start, best_end = zero, zero, zero
    was_open = zero > 1
    for i in range(lows.shape[0]):
        low, high, is_open = lows[i, ...], highs[i, ...], between_open[i, ...]
        start = xp.where(is_open & ~was_open, low, start)
        wider = is_open & (high - start > best_end - best_start)
        best_start, best_end = xp.where(wider, start, best_start), xp.where(wider, high, best_end)
        # A gap of no width between two equal ends doesn't part a band.
        was_open = is_open | (was_open & (high <= low))
    none = best_end <= best_start
    nan = xp.full_like(best_start, xp.nan)
    return xp.where(none, nan, best_start + g.coxa), xp.where(none, nan, best_end + g.coxa)


def _band_ends(xp: Namespace, g: LegGeometry, z: Array) -> list[Array]:
    """Distances from the femur axis at which a joint is at a limit; none is behind the coxa axis."""
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


def _in_limits(xp: Namespace, g: LegGeometry, r: Array, z: Array) -> Array:
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


def default_stance(robot: Robot, body_height: Array | None = None, *, swing_height: Array = 0.0) -> Array:
    """Return where the feet stand at rest, in the body frame.

    Straight out from each coxa axis (or as near to that as its limits allow), in the middle of the reachable band:
    source 001's ``x_min + (x_max - x_min) / 2``. For a walk, of what is reachable on the ground and lifted alike: a
    leg that stands where it can't be lifted can't step.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    body_height : array, shape (...), optional
        Height of the body's origin over the ground [m]; `default_body_height` where left out.
    swing_height : array, shape (...)
        How far above the ground a foot must be able to rise [m].

    Returns
    -------
    array, shape (..., legs, 3)
        Footholds in B [m]; their height is the negative of the body height.

    Raises
    ------
    InputError
        If the body height is not a finite number.
    UnreachableError
        If a leg reaches the ground nowhere at that body height; the message says which body heights work.
    """
    height = default_body_height(robot) if body_height is None else body_height
    feet = stance_or_nan(robot, height, swing_height=swing_height)
    xp = namespace(feet)
    missing = xp.isnan(feet[..., 0])
    if not is_traced(feet) and bool(xp.any(missing)):
        raise UnreachableError(_why_no_stance(robot, np.asarray(height), np.asarray(swing_height), np.asarray(missing)))
    return feet


def stance_or_nan(robot: Robot, body_height: Array, *, swing_height: Array = 0.0) -> Array:
    """Return what `default_stance` does, NaN where it raises that a leg reaches the ground nowhere.

    Parameters
    ----------
    robot : Robot
        The robot, or a batch of designs.
    body_height : array, shape (...)
        Height of the body's origin over the ground [m].
    swing_height : array, shape (...)
        How far above the ground a foot must be able to rise [m].

    Returns
    -------
    array, shape (..., legs, 3)
        Footholds in B [m]; x and y of a leg that has none are NaN.

    Raises
    ------
    InputError
        If the body height or the lift is not a finite number.
    """
    g = robot.geometry
    xp = namespace(body_height, swing_height, *g)
    g = g.to(xp)
    z, rise = -as_floats(xp, body_height, name="body_height"), as_floats(xp, swing_height, name="swing_height")
    require_finite("body_height", -z)
    require_finite("swing_height", rise)
    middle = _middle(xp, robot, z, rise)
    zero = xp.zeros_like(middle)
    coxa = xp.minimum(xp.maximum(zero, g.coxa_lower), g.coxa_upper)
    out_x, out_y = middle * xp.cos(coxa) - g.side * xp.sin(coxa), middle * xp.sin(coxa) + g.side * xp.cos(coxa)
    x = g.mount_x + g.cos_yaw * out_x - g.sin_yaw * out_y
    y = g.mount_y + g.sin_yaw * out_x + g.cos_yaw * out_y
    return stack_last(xp, (x, y, z[..., None] + zero))


def _middle(xp: Namespace, robot: Robot, height: Array, swing_height: Array) -> Array:
    """Return the middle of what each foot reaches on the ground and lifted; NaN where there is nothing."""
    height, swing_height = height + xp.zeros_like(swing_height), swing_height + xp.zeros_like(height)
    # The two heights come before the axes of a batch of designs.
    shape = (1,) * (len(robot.batch_shape) - height.ndim) + height.shape
    low, high = reachable_band(robot, xp.stack([xp.reshape(z, shape) for z in (height, height + swing_height)]))
    nearest, farthest = xp.maximum(low[0, ...], low[1, ...]), xp.minimum(high[0, ...], high[1, ...])
    return xp.where(nearest <= farthest, (nearest + farthest) / 2, xp.full_like(nearest, xp.nan))


def _why_no_stance(
    robot: Robot, body_height: np.ndarray[Any, Any], swing_height: np.ndarray[Any, Any], missing: np.ndarray[Any, Any]
) -> str:
    """Say which leg has no foothold, and at which body heights all legs of that design have one."""
    *batch, leg = (int(i) for i in np.argwhere(missing)[0])
    where, whole = tuple(batch), missing.shape[:-1]
    wanted, rise = (float(np.broadcast_to(values, whole)[where]) * 1000 for values in (body_height, swing_height))
    lifted = f" and can be lifted {rise:.1f} mm" if rise else ""
    text = (
        f"{f'{batch} ' if batch else ''}body height {wanted:.1f} mm: leg {robot.leg_names[leg]} nowhere reaches the "
        f"ground{lifted} within its joint limits"
    )
    one = robot.item(where, of=whole)
    g = one.geometry
    reach = float((g.femur + g.tibia).max() + np.abs(g.mount_z + g.up).max())
    # In tenths of a millimetre, so that the body heights work as they are written.
    steps = np.arange(-np.ceil(reach * 1e4), np.ceil(reach * 1e4) + 1)
    works = steps[~np.isnan(_middle(np, one, -steps / 1e4, np.asarray(rise / 1000))).any(-1)] / 10
    if not len(works):
        return f"{text}, and there is no body height at which all legs do"
    nearest = works[np.argmin(np.abs(works - wanted))]
    return (
        f"{text}; all legs do at body heights between {works.min():.1f} and {works.max():.1f} mm, "
        f"nearest to it at {nearest:.1f} mm"
    )
