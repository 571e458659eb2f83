"""PlaneCheck: what a check in the plane found out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import ClassVar

from gearcad.check.explanation import Explanations, explain_stiffness
from gearcad.check.options import Model
from gearcad.check.plane import pictures
from gearcad.check.plane.explanation import PlaneRootExplanation, explain_roots
from gearcad.check.plane.pictures import DepthProfile, FilletCurves, Shown, StressField
from gearcad.check.plane.summary import PlaneSummary
from gearcad.check.result import CheckResult
from gearcad.check.shown import shown_contact
from gearcad.contact.plane.cycle import PlaneCycle, PlanePairContact
from gearcad.contact.plane.elasticity import Plane
from gearcad.mounting import Mounting
from gearcad.per_gear import PerGear
from gearcad.stiffness import PlaneStrainContact, PlaneStressContact, StiffnessMethod

__all__ = ["PlaneCheck"]


@dataclass(frozen=True, kw_only=True, repr=False)
class PlaneCheck(CheckResult):
    """A check in the transverse section through the middle of the common face width."""

    cycle: PlaneCycle
    summary: PlaneSummary

    model: ClassVar[Model] = Model.PLANE

    shown_by_reports: ClassVar[tuple[str, ...]] = ("stiffness_methods", "stress_field", "fillet_curves")

    @cached_property
    def explanations(self) -> Explanations[PlaneRootExplanation]:
        return Explanations(
            stiffness=explain_stiffness(self.task, self.cycle, self.summary, self.sweep),
            root_stress=explain_roots(self.task, self.cycle, self.summary, self.load_share),
        )

    @property
    def contacts_along_path(self) -> list[PlanePairContact]:
        """All contacts of the cycle in the order in which one pair of teeth goes through them."""
        return sorted((contact for _, contact in self.cycle.contacts), key=attrgetter("place"))

    @property
    def hertz_deviation(self) -> float | None:
        """The greatest deviation of a peak pressure from Hertz's; None if all contacts are near the ends of the flanks."""
        contacts = [contact for _, contact in self.cycle.interior_contacts if contact.two_cylinders]
        return max((abs(contact.peak_pressure / contact.hertz_pressure - 1) for contact in contacts), default=None)

    def _as_method(self, mounting: Mounting) -> StiffnessMethod:
        method = PlaneStressContact if self.options.plane_state is Plane.STRESS else PlaneStrainContact
        return method(
            pair=self.pair, material=self.material, body=self.options.body, mounting=mounting, bodies=self.cycle.model
        )

    # ------------------------------------------------------------------ what pictures show

    @cached_property
    def shown(self) -> Shown:
        """The contact that pictures show."""
        return shown_contact(self.cycle)

    @cached_property
    def stress_field(self) -> StressField:
        """Around the contact that is shown."""
        return pictures.stress_field(self.cycle, self.shown)

    @cached_property
    def fillet_curves(self) -> PerGear[FilletCurves]:
        """Of both gears, each where its root tension is greatest."""
        return pictures.fillet_curves(self.cycle)

    @cached_property
    def depth_profile(self) -> DepthProfile:
        """Below the contact that is shown."""
        return pictures.depth_profile(self.cycle, self.shown.contact)
