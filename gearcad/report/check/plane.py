"""What the report of a check in the plane shows."""

from __future__ import annotations

from functools import cached_property, partial
from typing import ClassVar

from gearcad.check.plane.result import PlaneCheck
from gearcad.plots.check import plot_contact_pressure, plot_load_share
from gearcad.plots.stresses import plot_contact_zone, plot_depth_profile, plot_fillets, plot_stress_field
from gearcad.report.check.figures import Picture
from gearcad.report.check.sections import CheckSections
from gearcad.report.sentences import sentences

__all__ = ["PlaneSections"]


class PlaneSections(CheckSections[PlaneCheck]):
    """Those of the transverse section."""

    template: ClassVar[str] = "report_plane.html"
    captions: ClassVar[str] = "captions_plane.txt"

    @property
    def root_reasons(self) -> list[str]:
        part = self.result.rating.edition.part(3)
        roots = self.result.explanations.root_stress
        leans = self.result.rating.roots.map(lambda root: root.section.lean)
        return [sentences("reasons_plane.txt", "root_stress", of, role, part, leans.pick(role)) for role, of in roots.items()]

    @cached_property
    def figures(self) -> list[Picture]:
        of, inside = self.result, self.result.shown.interior
        figure = self.figure
        return [
            figure("Stress in the teeth", partial(plot_stress_field, of), "stress_field", "png"),
            *([figure("Stress around the contact", partial(plot_contact_zone, of), "contact_zone", "png")] if inside else []),
            figure("Pressure along the path of contact", partial(plot_contact_pressure, of), "contact_pressure"),
            *([figure("Stresses below the flank", partial(plot_depth_profile, of), "depth_profile")] if inside else []),
            figure("Load share", partial(plot_load_share, of), "load_share"),
            *self.over_mesh,
            figure("Stress along the fillets", partial(plot_fillets, of), "fillets"),
            *self.over_torque_and_mesh_size,
        ]
