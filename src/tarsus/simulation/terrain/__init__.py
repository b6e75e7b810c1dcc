"""Terrain: the ground that a simulated robot walks on, with a class for each kind."""

from __future__ import annotations

from tarsus.simulation.terrain.blocks import Blocks
from tarsus.simulation.terrain.box import Box
from tarsus.simulation.terrain.flat import Flat
from tarsus.simulation.terrain.gaps import Gaps
from tarsus.simulation.terrain.height_field import HeightField
from tarsus.simulation.terrain.protocol import Terrain
from tarsus.simulation.terrain.ramp import Ramp
from tarsus.simulation.terrain.smooth import Smooth
from tarsus.simulation.terrain.stairs import Stairs
from tarsus.simulation.terrain.step import Step

__all__ = ["Blocks", "Box", "Flat", "Gaps", "HeightField", "Ramp", "Smooth", "Stairs", "Step", "Terrain"]
