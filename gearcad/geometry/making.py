"""Inputs of how a gear is made without cutting its teeth by a tool that rolls: moulded, printed, cut by wire or by laser.

Lengths in mm, shrinkages in percent. The shrinkage is that of ISO 294-4: what is lost, as a share of the size of the cavity.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Annotated

from gearcad.core.errors import GeometryError
from gearcad.core.quantities import Choice, Range, Words, require_fields
from gearcad.core.records import concise

PROCESSES = ("mould", "print", "wire", "laser")

_SHRINKAGE = Range("%", -20, 20)
_OFFSET = Range("mm", -10, 10)
_WIDTH = Range("mm", 0, 10)

PATH_TOLERANCE = 0.0005
"""Distance (mm) of the arcs of a path from the exact one where nobody says."""

_SHRINKS = ("shrinkage_radial", "shrinkage_tangential", "shrinkage_axial")
_CUTS = ("kerf", "path_tolerance", "lead_in")
_KEYS_OF = {
    "mould": _SHRINKS,
    "print": (*_SHRINKS, "first_layer", "hole_growth"),
    "wire": (*_CUTS, "spark_gap"),
    "laser": _CUTS,
}
"""Keys of each process beside `process` and `offset`, which all have."""


@dataclass(frozen=True, kw_only=True)
class Making:
    """Inputs of how a gear is made; without a `process` nothing is corrected.

    `shrinkage_radial` (percent) scales all distances from the axis by 1/(1 - s), and all else too unless that is given:
    `shrinkage_tangential` the thickness of each tooth about its middle, `shrinkage_axial` what lies along the axis. `offset`
    (mm) moves the outline and the walls of bore and holes out of the material, after that; negative: into it.
    `first_layer` (mm) is how much the first layer of a print spreads: so much is taken off the outline at the lower end, over
    as much of the height. `hole_growth` (mm) is added to the diameters of bore and bolt holes of a print.
    `kerf` (mm) is the width of the cut of a laser, or the diameter of the wire, `spark_gap` (mm) what it burns away beside it.
    `path_tolerance` (mm) is how far the arcs of a path may be from the exact one, None 0.0005 mm; `lead_in` (mm) the length of
    the straight way into the cut, None one normal module. Raises ParameterError, or GeometryError for a key that the
    process does not have.
    """

    process: Annotated[str | None, Choice(PROCESSES), Words("process")] = None
    shrinkage_radial: Annotated[float, _SHRINKAGE, Words("shrinkage, radial", "", "ISO 294-4")] = 0.0
    shrinkage_tangential: Annotated[float | None, _SHRINKAGE, Words("shrinkage, tangential", "", "ISO 294-4")] = None
    shrinkage_axial: Annotated[float | None, _SHRINKAGE, Words("shrinkage, axial", "", "ISO 294-4")] = None
    offset: Annotated[float, _OFFSET, Words("offset of the outline, outward")] = 0.0
    kerf: Annotated[float, _WIDTH, Words("kerf, or diameter of the wire")] = 0.0
    spark_gap: Annotated[float, _WIDTH, Words("spark gap")] = 0.0
    first_layer: Annotated[float, _WIDTH, Words("spread of the first layer")] = 0.0
    hole_growth: Annotated[float, _OFFSET, Words("growth of holes, in diameter")] = 0.0
    path_tolerance: Annotated[float | None, Range("mm", 1e-6, 1), Words("tolerance of the path")] = None
    lead_in: Annotated[float | None, Range("mm", 0.001, 1000), Words("length of the lead-in")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        known = self.inputs
        for each in fields(self):
            value = getattr(self, each.name)
            if each.name in known or value == each.default:
                continue
            if self.process is None:
                raise GeometryError("process", None, f"must be given where {each.name} is: one of {', '.join(PROCESSES)}")
            owners = " or ".join(f'"{process}"' for process, keys in _KEYS_OF.items() if each.name in keys)
            unit = "%" if each.name in _SHRINKS else "mm"
            permitted = f'must be left out of process "{self.process}": it is of {owners}'
            raise GeometryError(each.name, value, permitted, unit)

    @property
    def present(self) -> bool:
        """Whether a process is named."""
        return self.process is not None

    @property
    def inputs(self) -> dict[str, str | float | None]:
        """The keys that the process has, and their values."""
        known = ("process", "offset", *_KEYS_OF[self.process]) if self.process else ("process",)
        return {each.name: getattr(self, each.name) for each in fields(self) if each.name in known}

    @property
    def cuts(self) -> bool:
        """Whether the process cuts along a path, with a wire or a laser."""
        return self.process in ("wire", "laser")

    @property
    def radial_scale(self) -> float:
        """1/(1 - s_r) of all distances from the axis."""
        return _scale(self.shrinkage_radial)

    @property
    def tangential_scale(self) -> float:
        """1/(1 - s_t) of the thickness of teeth."""
        return self.radial_scale if self.shrinkage_tangential is None else _scale(self.shrinkage_tangential)

    @property
    def axial_scale(self) -> float:
        """1/(1 - s_z) of lengths along the axis."""
        return self.radial_scale if self.shrinkage_axial is None else _scale(self.shrinkage_axial)

    @property
    def path_offset(self) -> float:
        """Distance (mm) of the middle of wire or beam from the finished surface: half its width, and the gap."""
        return self.kerf / 2 + self.spark_gap

    @property
    def arc_tolerance(self) -> float:
        """Distance (mm) that arcs of a path keep from the exact one."""
        return PATH_TOLERANCE if self.path_tolerance is None else self.path_tolerance

    def lead_length(self, normal_module: float) -> float:
        """Length (mm) of the way into the cut."""
        return normal_module if self.lead_in is None else self.lead_in


def _scale(percent: float) -> float:
    return 1 / (1 - percent / 100)
