"""What the report of a check of solid bodies shows."""

from __future__ import annotations

from functools import cached_property, partial
from typing import ClassVar

from gearcad.check.solid.result import SolidCheck
from gearcad.per_gear import Role
from gearcad.plots.lines import (
    plot_contact_pattern,
    plot_harmonics,
    plot_line_loads,
    plot_lines_share,
    plot_load_along_face,
    plot_root_along_face,
)
from gearcad.report.check.figures import Picture
from gearcad.report.check.sections import CheckSections
from gearcad.report.check.views import ToothView, tooth_view
from gearcad.report.sentences import sentences

__all__ = ["SolidSections"]


class SolidSections(CheckSections[SolidCheck]):
    """Those of bodies over their face widths."""

    template: ClassVar[str] = "report_solid.html"
    captions: ClassVar[str] = "captions_solid.txt"

    @property
    def root_reasons(self) -> list[str]:
        part = self.result.rating.edition.part(3)
        roots = self.result.explanations.root_stress
        leans = self.result.rating.roots.map(lambda root: root.section.lean)
        return [sentences("reasons_solid.txt", "root_stress", of, role, part, leans.pick(role)) for role, of in roots.items()]

    @property
    def line_reasons(self) -> list[str]:
        """Why loads along the lines of contact differ from the standard's."""
        of = self.result.explanations.lines_of_contact
        return [sentences("reasons_solid.txt", macro, of) for macro in ("pressure", "lines", "along_face")]

    @cached_property
    def figures(self) -> list[Picture]:
        of, figure = self.result, self.figure
        patterns = [
            figure(f"Contact pattern, {role.value}", partial(plot_contact_pattern, of, role), "contact_pattern", "png", role)
            for role in Role
        ]
        return [
            figure("Load over the plane of action", partial(plot_line_loads, of), "line_loads", "png"),
            *patterns,
            figure("Load along the face width", partial(plot_load_along_face, of), "load_along_face"),
            figure("Root stress along the face width", partial(plot_root_along_face, of), "root_along_face"),
            figure("Load share", partial(plot_lines_share, of), "load_share"),
            *self.over_mesh,
            figure("Harmonics of the transmission error", partial(plot_harmonics, of), "harmonics"),
            *self.over_torque_and_mesh_size,
        ]

    @cached_property
    def views(self) -> list[ToothView]:
        surfaces = self.result.tooth_surfaces
        return [tooth_view(surface, role, self.caption("tooth_view", role)) for role, surface in surfaces.items()]
