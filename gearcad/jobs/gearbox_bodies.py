"""Job `build` of a gearbox of planetary sets: each gear, and all of them posed in mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress
from gearcad.designs.design import Design
from gearcad.designs.gearbox_spec import PlanetaryGearboxDesign
from gearcad.designs.keys import DesignKind
from gearcad.jobs.build import Build
from gearcad.jobs.gearbox import PlanetaryGearbox
from gearcad.jobs.job import Data, Job, Result, Writer
from gearcad.solids import Format
from gearcad.solids.body_plan import require_rim
from gearcad.solids.files.gearbox_products import GearboxProduct
from gearcad.version import __version__

_OF_OTHERS = ("bracket", "circles", "carrier", "exploded", "turning")
"""Options that gearboxes do not have."""


@dataclass(frozen=True)
class GearboxBuilt:
    """Bodies of a gearbox: its design, and the product of all gears in mesh."""

    design: PlanetaryGearboxDesign
    product: GearboxProduct


@dataclass(frozen=True, kw_only=True)
class BuildGearbox(Job[PlanetaryGearboxDesign, GearboxBuilt]):
    """The files of a gearbox: each gear as `set1.sun.step` and so on, and `assembly.*` of all, posed in mesh.

    Raises GeometryError for a gearbox of which only teeth are known, a ring without a rim, and options of other designs.
    """

    verb = "build"
    accepts = (DesignKind.GEARBOX,)
    why = "other designs are no gearboxes"

    job: Build

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        return self.job.parts

    def part_of(self, file: str) -> str:
        return self.job.part_of(file)

    def run(self, design: Design, progress: Progress | None = None) -> GearboxBuilt:
        design = self.accepted(design, progress)
        if not design.gears:
            raise ParameterError("planets", None, "must be given in each [[planetary.set]], with normal_module and face_width")
        for option in _OF_OTHERS:
            if getattr(self.job.options, option):
                raise GeometryError(option, True, "must be left out: a gearbox of planetary sets has none")
        if self.job.stage != "finished":
            raise GeometryError("stage", self.job.stage, "must be left out: the gears of a gearbox are finished")
        if self.job.as_made:
            raise GeometryError("as_made", True, "must be left out: a gearbox of planetary sets has none")
        if any(kind.entry.of_bodies for kind in self.job.formats):
            for name, gear in design.gears.items():
                if gear.internal:
                    try:
                        require_rim(gear)
                    except GeometryError as error:
                        raise error.within(name) from error
        return GearboxBuilt(design, GearboxProduct(design.gearbox, self.job.options))

    def document(self, result: GearboxBuilt) -> JsonObject:
        """Return kind, name and version, and the places of all gears: rotation (degrees), axis and bottom (mm)."""
        places = {name: place._asdict() for name, place in result.product.places.items()}
        return {"kind": "build", "name": result.design.name, "gearcad": __version__, "places": places}

    def notices(self, result: GearboxBuilt) -> Sequence[Notice]:
        return result.design.notices

    def files(self, result: GearboxBuilt) -> dict[str, Writer]:
        """Return the data, each gear, and the assembly, quickest first."""
        found = Data().files(result.design)
        for kind in reversed(Format):
            if kind in self.job.formats:
                parts = result.product.parts.items()
                found |= {f"{name}.{kind.value}": partial(kind.entry.write, part) for name, part in parts}
                if kind.entry.write_pair is not None:
                    found[f"assembly.{kind.value}"] = partial(kind.entry.write_pair, result.product)
        return found


def suited_to_gearbox(job: Job[Any, Result]) -> Job[Any, Result]:
    """Return the job for a gearbox of planetary sets: the one that does the same with it, if there is one."""
    if isinstance(job, Build):
        return cast("Job[Any, Result]", BuildGearbox(job=job))
    return cast("Job[Any, Result]", PlanetaryGearbox()) if job.verb == PlanetaryGearbox.verb else job
