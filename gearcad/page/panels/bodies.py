"""The solid bodies of a design, as the page shows them in mesh."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from gearcad.designs.design import Design
from gearcad.designs.kinds.pair import PairDesign
from gearcad.designs.kinds.toothed import ToothedDesign
from gearcad.errors import GearcadError
from gearcad.jobs.products import products_of, require_bodies
from gearcad.page.components.bodies import BodiesView
from gearcad.page.panels import Panel
from gearcad.solids import FileOptions, Format

__all__ = ["BODIES", "Bodies", "BodiesPanel", "bodies_of"]

BODIES: dict[str, bytes] = {}
"""The GLB that each session shows now, by its key: the server answers with it."""

_CHORD = 0.01
"""Error of facets, in normal modules: bodies are looked at."""


class Bodies:
    """The solid bodies of a design as GLB, and how its axles turn; `why_not` instead where there are none."""

    def __init__(self, glb: bytes = b"", axles: list[dict[str, Any]] | None = None, why_not: str = "") -> None:
        self.glb, self.axles, self.why_not = glb, axles or [], why_not


class BodiesPanel(Panel[Bodies]):
    """The gears in mesh, as solid bodies; `key` is that of the session."""

    def __init__(self, key: str) -> None:
        self._key, self._number = key, 0
        self._view = BodiesView("the gears in mesh")

    def find(self, design: Design) -> Bodies:
        return bodies_of(design)

    def show(self, found: Bodies) -> None:
        self._number += 1
        BODIES[self._key] = found.glb
        self._view.show(f"/bodies/{self._key}/{self._number}.glb" if found.glb else "", found.axles, found.why_not)

    def pose(self, turn: float) -> None:
        """Turn the first axle by so many radians."""
        self._view.pose(turn)


def bodies_of(design: Design) -> Bodies:
    """Those of a design with teeth."""
    if not isinstance(design, ToothedDesign):
        return Bodies(why_not=f"a {design.kind.words} has no bodies of its own")
    module = min((gear.normal_module for gear in design.gears.values()), default=1.0)
    options = FileOptions(chord_error=_CHORD * module)
    try:
        require_bodies(design, options)
        parts, assembly = products_of(design, options)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bodies.glb"
            if assembly is not None and Format.GLB.entry.write_pair is not None:
                Format.GLB.entry.write_pair(assembly, path)
            else:
                Format.GLB.entry.write(next(iter(parts.values())), path)
            return Bodies(path.read_bytes(), _axles(design))
    except GearcadError as error:
        return Bodies(why_not=str(error))


def _axles(design: ToothedDesign) -> list[dict[str, Any]]:
    if isinstance(design, PairDesign):
        return [
            {"name": "pinion", "ratio": 1.0},
            {"name": "wheel", "ratio": -design.pair.pinion.teeth / design.pair.wheel.teeth},
        ]
    return [{"name": design.name, "ratio": 1.0}]
