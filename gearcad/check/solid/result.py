"""SolidCheck: what a check of solid bodies found out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar

from gearcad.check.convergence import SOLID_ORDER
from gearcad.check.explanation import explain_stiffness
from gearcad.check.options import Model
from gearcad.check.result import CheckResult
from gearcad.check.shown import shown_contact
from gearcad.check.solid import pictures
from gearcad.check.solid.along_face import AlongFace, along_face
from gearcad.check.solid.document import load_distribution
from gearcad.check.solid.explanation import SolidExplanations, explain_lines, explain_roots
from gearcad.check.solid.pictures import Cells, Shown, ToothStress, ToothSurface
from gearcad.check.solid.summary import SolidSummary
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.mounting import Mounting
from gearcad.per_gear import PerGear
from gearcad.stiffness import SolidContact, StiffnessMethod

__all__ = ["SolidCheck"]


@dataclass(frozen=True, kw_only=True, repr=False)
class SolidCheck(CheckResult):
    """A check of solid bodies; under a negative torque `cycle` is that of the mirrored pair.

    `tooth_stresses` are those of the most stressed tooth of each gear.
    """

    cycle: SolidCycle
    summary: SolidSummary
    tooth_stresses: PerGear[ToothStress]

    model: ClassVar[Model] = Model.SOLID

    shown_by_reports: ClassVar[tuple[str, ...]] = ("stiffness_methods", "along_face", "cells", "tooth_surfaces")

    greatest_order: ClassVar[float] = SOLID_ORDER
    """The greatest order of convergence that meshes of solids are credited with."""

    @cached_property
    def along_face(self) -> AlongFace:
        """Load and root stress over the face width."""
        return along_face(self.cycle)

    @cached_property
    def explanations(self) -> SolidExplanations:
        return SolidExplanations(
            stiffness=explain_stiffness(self.task, self.cycle, self.summary, self.sweep),
            root_stress=explain_roots(self.task, self.cycle, self.summary),
            lines_of_contact=explain_lines(self.task, self.cycle, self.summary),
        )

    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        return SolidContact(
            pair=self.pair, material=self.material, body=self.options.body, mounting=mounting, bodies=self.cycle.model
        )

    # ------------------------------------------------------------------ files and documents

    @property
    def own_document(self) -> dict[str, Any]:
        return {"load_distribution": load_distribution(self.cycle), "face": self.along_face.to_dict()}

    @property
    def stress_files(self) -> Mapping[str, Callable[[Path], None]]:
        return {f"stress_{role.value}.vtu": stress.write for role, stress in self.tooth_stresses.items()}

    # ------------------------------------------------------------------ what pictures show

    @cached_property
    def shown(self) -> Shown:
        """The contact that pictures show."""
        return shown_contact(self.cycle)

    @cached_property
    def cells(self) -> Cells:
        """Of all lines of contact."""
        return pictures.loaded_cells(self.cycle)

    @cached_property
    def tooth_surfaces(self) -> PerGear[ToothSurface]:
        """Of the most stressed teeth."""
        return PerGear(*map(pictures.tooth_surface, self.tooth_stresses, self.pair.gears))
