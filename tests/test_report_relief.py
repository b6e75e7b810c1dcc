"""The drawn faces of uneven ground are those of the terrain, in the order in which they hide each other."""

import numpy as np
import pytest

from tarsus.report.ground import Ground
from tarsus.report.relief import relief_of
from tarsus.report.style import new_figure
from tarsus.report.view import View
from tarsus.simulation.terrain import Blocks, Gaps, Ramp, Smooth, Stairs

VIEW = View()
LOW, HIGH = np.array([-0.31, -0.52]), np.array([1.27, 0.4])
TERRAINS = [Ramp(slope=0.3), Stairs(rise=0.03), Gaps(depth=0.05), Blocks(size=0.1, clear=0.1), Smooth()]


@pytest.mark.parametrize("terrain", TERRAINS, ids=lambda each: type(each).__name__)
def test_faces_are_at_the_height_of_the_ground(terrain):
    relief = relief_of(terrain.height, LOW, HIGH, step=0.025, view=VIEW)
    level = np.ptp(relief.corners[..., 0], axis=1) * np.ptp(relief.corners[..., 1], axis=1) > 1e-6
    x, y, z = np.moveaxis(relief.corners[level], -1, 0)
    np.testing.assert_allclose(z, terrain.height(x, y), atol=1e-12)
    # They cover the whole rectangle.
    area = (np.ptp(x, axis=1) * np.ptp(y, axis=1)).sum()
    assert area == pytest.approx(np.prod(np.ceil(HIGH / 0.025) - np.floor(LOW / 0.025)) * 0.025**2, rel=1e-3)
    assert (relief.corners[..., :2].min((0, 1)) <= LOW + 1e-5).all()
    assert (relief.corners[..., :2].max((0, 1)) >= HIGH - 1e-5).all()
    assert ((relief.brightness > 0.5) & (relief.brightness <= 1.0)).all()
    on_ground = relief.corners.mean(1) * [1, 1, 0]
    assert (np.diff(VIEW.depth(on_ground)) >= -1e-9).all()
    walls = relief.corners[~level]
    if isinstance(terrain, Stairs | Gaps | Blocks):
        jumps = np.ptp(walls[..., 2], axis=1)
        assert jumps.min() > 1e-4
        assert jumps.max() == pytest.approx({Stairs: 0.03, Gaps: 0.05}.get(type(terrain), jumps.max()))
    else:
        assert len(walls) == 0


@pytest.mark.parametrize("width", [600.0, 60_000.0])
def test_ground_fills_the_view_with_a_bounded_number_of_faces(width):
    axes = new_figure(width=3, height=2, manual_layout=True).add_axes((0, 0, 1, 1))
    axes.set_xlim(-width / 2, width / 2)
    axes.set_ylim(-width / 3, width / 3)
    Ground(axes, VIEW, Blocks().height).update()
    grid, faces = axes.collections
    assert grid.get_segments() == []
    corners = np.concatenate([path.vertices for path in faces.get_paths()])
    assert 100 < len(faces.get_paths()) < 100_000
    assert corners[:, 0].min() <= -width / 2
    assert corners[:, 0].max() >= width / 2
    assert corners[:, 1].min() <= -width / 3
    assert corners[:, 1].max() >= width / 3
