"""Sizes of meshes that are made quickly."""

from __future__ import annotations

from gearcad.meshing.outline import MeshSizes

COARSE = MeshSizes(flank=0.6, corner=0.5, fillet=0.4, outline=0.75, cut=0.75, rim=2.0, growth=0.5)
