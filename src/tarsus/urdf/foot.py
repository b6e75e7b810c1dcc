"""The foot point of a leg: a link fixed at its end, or the end of its last shape."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tarsus.urdf.document import Shape
from tarsus.urdf.tree import Part, Placed

if TYPE_CHECKING:
    from jaxtyping import Float

__all__ = ["Foot", "foot_of"]

_NAMES = re.compile(r"foot|feet|toe|tip|tarsus|ee$|end_?effector", re.IGNORECASE)
# A sphere centred this near to the foot point is the foot's ball; a fixed link this near to the knee is no foot [m].
_NEAR = 1e-3
# A binary STL file: a header with the number of triangles [bytes], and then the triangles, of 50 bytes each.
_HEADER, _TRIANGLE = 84, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


class Foot(NamedTuple):
    """A foot.

    Attributes
    ----------
    point : array, shape (3,)
        The foot point, in the frame of the body's link with all joints at zero [m].
    radius : float
        Radius of its ball; 0 where the file has none [m].
    source : str
        What the point was taken from.
    """

    point: Float[np.ndarray, "3"]
    radius: float
    source: str


def foot_of(part: Part, knee: Float[np.ndarray, "3"], *, folder: Path | None) -> Foot | None:
    """Return the foot of a leg, or None if its place is unknown.

    Parameters
    ----------
    part : Part
        What the tibia joint moves.
    knee : array, shape (3,)
        A point on that joint's axis, in the frame of the body's link [m].
    folder : Path or None
        Folder of the file, for its meshes.
    """
    tibia, *fixed = part.links
    ends = [placed for placed in fixed if _NAMES.search(placed.link.name)] or fixed
    if ends:
        end = max(ends, key=lambda placed: _distance(placed, knee))
        point = end.T_body_link[:3, 3]
        if _distance(end, knee) > _NEAR:
            return Foot(point, _radius(part, point), f"the fixed link {end.link.name!r}")
    found = [(point, ball, shape) for placed in part.links for shape, point, ball in _extents(placed, knee, folder)]
    if not found:
        return None
    # Collision shapes are preferred, as these touch the ground; a ball prevails over a shape that ends at its centre.
    solid = [each for each in found if each[2].collision] or found
    point, ball, shape = max(solid, key=lambda each: float(np.linalg.norm(each[0] - knee)) + each[1])
    what = "the centre of a sphere" if ball else f"the end of a {shape.kind}"
    return Foot(point, ball, f"{what} of {tibia.link.name!r}")


def _distance(placed: Placed, knee: Float[np.ndarray, "3"]) -> float:
    return float(np.linalg.norm(placed.T_body_link[:3, 3] - knee))


def _radius(part: Part, point: Float[np.ndarray, "3"]) -> float:
    """Return the radius of a sphere around a point; 0 if there is none."""
    for placed in part.links:
        for shape in placed.link.shapes:
            centre = (placed.T_body_link @ shape.T_link_shape)[:3, 3]
            if shape.kind == "sphere" and np.linalg.norm(centre - point) < _NEAR:
                return float(shape.size[0])
    return 0.0


def _extents(
    placed: Placed, knee: Float[np.ndarray, "3"], folder: Path | None
) -> Iterator[tuple[Shape, Float[np.ndarray, "3"], float]]:
    """Yield each shape, its farthest point from the knee, and its radius if it is a sphere, else 0."""
    for shape in placed.link.shapes:
        place = placed.T_body_link @ shape.T_link_shape
        points = _points(shape, folder)
        if len(points):
            there = points @ place[:3, :3].T + place[:3, 3]
            farthest = there[int(np.argmax(np.linalg.norm(there - knee, axis=1)))]
            yield shape, farthest, float(shape.size[0]) if shape.kind == "sphere" else 0.0


def _points(shape: Shape, folder: Path | None) -> Float[np.ndarray, "n 3"]:
    """Return the candidates for a shape's end: a sphere's centre, the ends of a middle line, or a mesh's vertices."""
    if shape.kind == "mesh":
        vertices: np.ndarray = _vertices(shape.file, folder) * shape.size
        return vertices
    half = np.zeros(3)
    if shape.kind == "cylinder":
        half[2] = shape.size[1] / 2
    elif shape.kind == "box":
        # Along its longest direction: a foot is not at a corner.
        longest = int(np.argmax(shape.size))
        half[longest] = shape.size[longest] / 2
    return np.array([-half, half])


def _vertices(name: str, folder: Path | None) -> Float[np.ndarray, "n 3"]:
    """Return the vertices of a mesh in a binary STL file near the robot's file; none if it can't be read."""
    words = [word for word in re.sub(r"^\w+://", "", name).split("/") if word not in ("", ".", "..")]
    places = [] if folder is None else [folder, *folder.resolve().parents][:4]
    for place, start in itertools.product(places, range(len(words))):
        path = place.joinpath(*words[start:])
        if path.suffix.lower() == ".stl" and path.is_file():
            data = path.read_bytes()
            count = (len(data) - _HEADER) // _TRIANGLE.itemsize
            if count > 0 and int.from_bytes(data[80:84], "little") == count:
                triangles = np.frombuffer(data, _TRIANGLE, count, _HEADER)
                return triangles["corners"].reshape(-1, 3).astype(float)
    return np.empty((0, 3))
