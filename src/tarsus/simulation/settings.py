"""Settings of the physics engine, found by measurement to suit legged robots of 0.5 to 5 kg."""

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

# Ratio of the frictional to the normal constraint impedance; the creep time of friction, which `FootContact` explains,
# is about 0.02 s times this number.
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
    # The plant reports a simulation that becomes unstable; by default the engine would reset it to its initial state.
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
