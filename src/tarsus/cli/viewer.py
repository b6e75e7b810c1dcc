"""Replay of a simulated run in MuJoCo's own viewer."""

from __future__ import annotations

import os
import sys
import time

import numpy as np

from tarsus.cli.simulated_run import SimulatedRun
from tarsus.errors import TarsusError
from tarsus.simulation.engine import mujoco_module

__all__ = ["replay", "require_screen"]


def require_screen() -> None:
    """Check that there is a screen to show a run on.

    Raises
    ------
    TarsusError
        If there is none.
    """
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise TarsusError("--view needs a screen: neither DISPLAY nor WAYLAND_DISPLAY is set; --video needs none")


def replay(found: SimulatedRun) -> None:
    """Show a run repeatedly, in real time, until the window is closed.

    Parameters
    ----------
    found : SimulatedRun
        The run.
    """
    mujoco, trace = mujoco_module(), found.trace
    model = found.plant.mj_model
    data = mujoco.MjData(model)
    from mujoco import viewer

    with viewer.launch_passive(model, data) as window:
        while window.is_running():
            for number, step in enumerate(np.diff(trace.time, prepend=0.0).tolist()):
                if not window.is_running():
                    return
                data.qpos[:3] = trace.body.position[number]
                mujoco.mju_mat2Quat(data.qpos[3:7], trace.body.rotation[number].ravel())
                data.qpos[7:] = trace.angles[number].ravel()
                mujoco.mj_forward(model, data)
                window.sync()
                time.sleep(step)
