"""What CalculiX has found out of a deck, read from its files: .dat, words and columns, and .frd, columns that may touch."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gearcad.arrays import Floats
from gearcad.errors import SolverError
from gearcad.meshing.bodies import ElementMesh

__all__ = ["PrintedContact", "displacements", "printed_contact"]


_COLUMN = 12
"""Characters of a number in a .frd, from the thirteenth of a line on."""

_SETS = re.compile(r"statistics for slave set (\S+), master set")

_ROWS = re.compile(r"[-+ 0-9.EeNna]+")
"""Numbers only, NaN among them: where nothing touches."""


@dataclass(frozen=True)
class PrintedContact:
    """What a .dat holds of a loaded pair: how far the pinion turned (rad), and by the names of the pinion's flanks the normal
    force (N, 0 where nothing touches) and the greatest pressure at a point of integration (MPa).
    """

    turn: float
    forces: Mapping[str, float]
    pressures: Mapping[str, float]

    @property
    def shares(self) -> dict[str, float]:
        """Shares of the load by the names of the pinion's flanks."""
        total = math.fsum(self.forces.values())
        return {name: force / total for name, force in self.forces.items()}


def printed_contact(path: Path, mesh: ElementMesh, flanks: Iterable[str]) -> PrintedContact:
    """Read the .dat of a loaded pair; `flanks` are the pinion's sides that may touch. Raises SolverError if it is not whole."""
    turn, forces, stresses = math.nan, dict.fromkeys(flanks, 0.0), np.empty((0, 3))
    sides = {name.upper(): name for name in forces}
    for heading, rows in _blocks(path):
        if heading.startswith("displacements"):
            turn = rows[-1][1]
        elif heading.startswith("contact stress"):
            stresses = np.array([row[:3] for row in rows])
        elif found := _SETS.match(heading):
            force = -rows[-1][1] if len(rows) > 3 else math.nan
            forces[sides[found[1]]] = force if math.isfinite(force) else 0.0
    if not math.isfinite(turn) or not len(stresses):
        raise SolverError(f"{path.name} has no loaded pair: did CalculiX come to an end?")
    owners = {name: np.isin(stresses[:, 0], mesh.sides[name].elements + 1) for name in forces}
    return PrintedContact(turn, forces, {name: float(stresses[own, 2].max(initial=0.0)) for name, own in owners.items()})


def _blocks(path: Path) -> Iterator[tuple[str, list[list[float]]]]:
    """Headings of a .dat, and the lines of numbers below each; words between those of one statistic are passed over."""
    heading, rows = "", list[list[float]]()
    with path.open(encoding="latin-1") as lines:
        for text in map(str.strip, lines):
            if text and _ROWS.fullmatch(text):
                rows.append([float(word) for word in text.split()])
            elif " and time " in text or " for set " in text:
                if heading:
                    yield heading, rows
                heading, rows = text, []
    yield heading, rows


def displacements(path: Path, nodes: int) -> Floats:
    """Displacements (nodes, 3) in mm of the first nodes, from the last increment in a .frd. Raises SolverError."""
    found, inside = np.full((nodes, 3), np.nan), False
    with path.open(encoding="latin-1") as lines:
        for line in lines:
            if line.startswith(" -4"):
                inside = line[5:9] == "DISP"
            elif inside and line.startswith(" -1") and (node := int(line[3:13])) <= nodes:
                found[node - 1] = [float(line[at : at + _COLUMN]) for at in range(13, 13 + 3 * _COLUMN, _COLUMN)]
    if np.isnan(found).any():
        raise SolverError(f"{path.name} has not the displacements of all nodes: did CalculiX come to an end?")
    return found
