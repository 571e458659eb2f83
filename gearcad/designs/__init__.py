"""Spec files (TOML) and design tables (CSV, .xlsx): the same keys in, a Design out."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcad.designs.design import Design, DesignKind
    from gearcad.designs.kinds.gear import GearDesign
    from gearcad.designs.kinds.geared import GearedDesign, Inputs
    from gearcad.designs.kinds.pair import PairDesign
    from gearcad.designs.kinds.planetary import PlanetaryDesign
    from gearcad.designs.kinds.rack import RackDesign
    from gearcad.designs.kinds.rack_pair import RackPairDesign
    from gearcad.designs.kinds.toothed import ToothedDesign
    from gearcad.designs.kinds.train import TrainDesign
    from gearcad.designs.measured import read_measurements
    from gearcad.designs.mesh_pairs import MeshPairs
    from gearcad.designs.reader import design_from_tables, read_spec
    from gearcad.designs.table import Row, Table, open_table

__all__ = [
    "Design",
    "DesignKind",
    "GearDesign",
    "GearedDesign",
    "Inputs",
    "MeshPairs",
    "PairDesign",
    "PlanetaryDesign",
    "RackDesign",
    "RackPairDesign",
    "Row",
    "Table",
    "ToothedDesign",
    "TrainDesign",
    "design_from_tables",
    "open_table",
    "read_measurements",
    "read_spec",
]

if not TYPE_CHECKING:
    _KINDS = ("toothed", "geared", "gear", "pair", "rack", "rack_pair", "train", "planetary")
    from gearcad.lazy import lazily

    __getattr__ = lazily(
        __name__, __all__, ("design", "reader", *(f"kinds.{home}" for home in _KINDS), "measured", "mesh_pairs", "table")
    )
