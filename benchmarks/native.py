"""The C reference of the benchmarks: `leg.c`, compiled on demand."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tarsus import Pose, Robot

if TYPE_CHECKING:
    from jaxtyping import Float


__all__ = ["FLAGS", "CLoop"]

FLAGS = ("-O3", "-march=native", "-ffast-math")
_HERE = Path(__file__).parent
_DOUBLES = ctypes.POINTER(ctypes.c_double)


class CLoop:
    """Inverse kinematics of one robot in C, with preallocated outputs.

    Attributes
    ----------
    vectors : tuple of str
        Vector functions of the mathematics library that the compiled code calls; empty if there are none.
    angles : array, shape (robots, legs, 3)
        Joint angles of the last call [rad].
    codes : array, shape (robots, legs)
        Reach codes of the last call.
    """

    def __init__(self, library: Path, robot: Robot, robots: int) -> None:
        g = robot.geometry
        if robot.legs != 6 or robot.batch_shape or g.side.any() or np.ptp(g.up):
            raise ValueError("the C loop needs six legs without a sideways offset of the femur axes")
        columns = [g.mount_x, g.mount_y, g.mount_z + g.up, g.cos_yaw, g.sin_yaw, g.coxa, g.femur, g.tibia]
        columns += [g.farthest2, g.nearest2, g.sum2, g.difference2]
        columns += [g.coxa_lower, g.femur_lower, g.tibia_lower, g.coxa_upper, g.femur_upper, g.tibia_upper]
        self._constants = np.ascontiguousarray(np.stack(columns, axis=-1))
        self._up = float(g.up[0])
        self._function = ctypes.CDLL(str(library)).inverse
        self._function.argtypes = [_DOUBLES, ctypes.c_double, ctypes.c_long, *(_DOUBLES,) * 4, ctypes.c_void_p]
        self._function.restype = None
        self.angles = np.zeros((robots, 6, 3))
        self.codes = np.zeros((robots, 6), dtype=np.int8)
        self.vectors = _vector_functions(library)

    @classmethod
    def compiled(cls, robot: Robot, robots: int) -> Self | None:
        """Compile the loop; None if gcc is not installed."""
        gcc = shutil.which("gcc")
        if gcc is None:
            return None
        library = _HERE / "build" / "leg.so"
        library.parent.mkdir(exist_ok=True)
        command = [gcc, *FLAGS, "-shared", "-fPIC", str(_HERE / "leg.c"), "-o", str(library)]
        # glibc has its vector functions in a separate library, which other systems lack.
        if subprocess.run([*command, "-lmvec", "-lm"], check=False, capture_output=True).returncode:
            subprocess.run([*command, "-lm"], check=True)
        return cls(library, robot, robots)

    def __call__(self, feet: Float[np.ndarray, "..."], body: Pose | None = None) -> None:
        """Solve for feet ``(robots, legs, 3)`` in B, or in G if body poses ``(robots,)`` are given."""
        rotation, position = (None, None) if body is None else (_pointer(body.rotation), _pointer(body.position))
        self._function(
            _pointer(self._constants),
            self._up,
            len(feet),
            _pointer(feet),
            rotation,
            position,
            _pointer(self.angles),
            self.codes.ctypes.data,
        )


def _pointer(array: Float[np.ndarray, "..."]) -> Any:
    if array.dtype != np.float64 or not array.flags.c_contiguous:
        raise ValueError("the C loop needs contiguous arrays of doubles")
    return array.ctypes.data_as(_DOUBLES)


def _vector_functions(library: Path) -> tuple[str, ...]:
    """Return the names of glibc's vector functions that the library calls."""
    objdump = shutil.which("objdump")
    if objdump is None:
        return ()
    listing = subprocess.run([objdump, "-d", str(library)], check=True, capture_output=True, text=True).stdout
    return tuple(sorted(set(re.findall(r"_ZGV\w+", listing))))
