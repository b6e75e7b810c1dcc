"""Settings of the physics engine, which were measured to hold for legged robots of 0.5 to 5 kg."""

from __future__ import annotations

from typing import Any

from tarsus.simulation.engine import mujoco_module

__all__ = ["FRICTION", "SOLREF", "TIMESTEP", "apply_settings"]

TIMESTEP = 0.002
"""Duration of a physics step [s]."""

FRICTION = 0.8
"""Coefficient of friction between feet and ground where none is given: rubber on a dry floor."""

SOLREF = (0.01, 1.0)
"""Time constant [s] and damping ratio of the contacts."""

# Ratio of the frictional to the normal constraint impedance: friction creeps with about 0.23 s times this number.
_IMPRATIO = 10.0
_GRAVITY = 9.80665


def apply_settings(spec: Any) -> None:
    """Set time step, integrator, solver and friction cone of a model.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model; it is changed.
    """
    mujoco = mujoco_module()
    option = spec.option
    option.timestep = TIMESTEP
    option.gravity = (0.0, 0.0, -_GRAVITY)
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = _IMPRATIO
    # A simulation that becomes unstable is reported; the engine would start again from its initial state.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
