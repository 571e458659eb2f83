"""Reports of a check, and of a comparison of methods for the mesh stiffness."""

from __future__ import annotations

import base64
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial, singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypedDict, TypeVar

import numpy as np

from gearcad.check.comparison import Comparison, ComparisonRole
from gearcad.check.depth import MaterialExposure
from gearcad.check.pictures import ToothSurface
from gearcad.check.result import CheckResult, PlaneCheck, SolidCheck, StiffnessMethods
from gearcad.core.records import Role
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.plots.check import (
    COLOUR_MAP,
    PITCH,
    YAW,
    plot_contact_pattern,
    plot_contact_pressure,
    plot_contact_zone,
    plot_convergence,
    plot_depth_profile,
    plot_exposure,
    plot_exposure_course,
    plot_fillets,
    plot_gap_of_shafts,
    plot_harmonics,
    plot_line_loads,
    plot_lines_share,
    plot_load_along_face,
    plot_load_share,
    plot_losses,
    plot_mesh_stiffness,
    plot_oil_film,
    plot_root_along_face,
    plot_root_stress,
    plot_stress_field,
    plot_sweep_pressure,
    plot_sweep_stiffness,
    plot_tooth,
    plot_transmission_error,
)
from gearcad.plots.paper import short
from gearcad.plots.stiffness import parts_inches, plot_load_dependence, plot_parts_of_all, plot_stiffness
from gearcad.report.document import (
    ReportFigure,
    ReportRow,
    figure_address,
    gear_rows,
    load_rows,
    names_of_pair,
    page_html,
    pair_picture,
    pair_rows,
    picture_address,
    rating_rows,
    sentences,
)
from gearcad.report.strength import StrengthSection, strength_section
from gearcad.stiffness.comparison import StiffnessComparison

if TYPE_CHECKING:
    from matplotlib.axes import Axes


_GEAR = "teeth normal_module helix_angle profile_shift face_width tip_diameter root_diameter body.bore"

_NONE = "–"  # an en dash where a method has no value

_TALL = (6.6, 4.8)
"""Size (inches) of figures with a long legend."""


class _MethodRow(NamedTuple):
    """A method in the table; stiffness in N/µm, per width in N/(mm·µm), deviation in %."""

    title: str
    holds: str
    mean: str
    maximum: str
    minimum: str
    pitch_point: str
    c_gamma_beta: str
    c_gamma_alpha: str
    single: str
    deviation: str


class StiffnessSection(NamedTuple):
    """Table, curves and notes of a comparison; `referred` if there is a 3D contact to measure the others by."""

    rows: list[_MethodRow]
    referred: bool
    curves: ReportFigure
    notes: list[tuple[str, tuple[str, ...]]]
    left_out: list[tuple[str, str]]


def write_stiffness_report(
    comparison: StiffnessComparison, design_name: str, path: Path, head: Mapping[str, str] | None = None
) -> None:
    """Write the report of a comparison of the design's pair to `path`; the same comparison gives the same bytes."""
    path.write_text(stiffness_html(comparison, design_name, head), encoding="utf-8", newline="\n")


def stiffness_html(comparison: StiffnessComparison, design_name: str, head: Mapping[str, str] | None = None) -> str:
    """The report as one HTML document without links."""
    return page_html(
        "stiffness.html",
        design_name,
        head,
        of=comparison,
        stiffness=_section(comparison),
        figures=_figures(comparison),
        pair_picture=pair_picture(comparison.pair),
        gear_rows=gear_rows(comparison.pair, _GEAR),
        names=names_of_pair(comparison.pair),
        pair_rows=pair_rows(comparison.pair),
        load_rows=load_rows(comparison.material, comparison.load, Mounting()),
    )


def section_of_check(methods: StiffnessMethods) -> StiffnessSection | str:
    """The model of a check beside the closed forms; why not, where they cannot be had."""
    return _section(methods.comparison) if methods.comparison is not None else methods.reason


def _section(comparison: StiffnessComparison) -> StiffnessSection:
    return StiffnessSection(
        rows=[_report_row(comparison, cycle) for cycle in comparison.cycles],
        referred=comparison.reference is not None,
        curves=ReportFigure(
            "Mesh stiffness along the line of action",
            picture_address(partial(plot_stiffness, comparison), "svg", _TALL),
            _caption(comparison, "curves"),
        ),
        notes=[(comparison.titles[cycle.method], cycle.notes) for cycle in comparison.cycles if cycle.notes],
        left_out=[(comparison.titles[name], reason) for name, reason in comparison.left_out.items()],
    )


def _report_row(comparison: StiffnessComparison, cycle: MeshCycle) -> _MethodRow:
    deviation = comparison.deviation(cycle) if cycle is not comparison.reference else None
    known = not cycle.mean_only
    return _MethodRow(
        title=comparison.titles[cycle.method],
        holds="; ".join(cycle.holds),
        mean=short(cycle.mean),
        maximum=short(cycle.maximum) if known else _NONE,
        minimum=short(cycle.minimum) if known else _NONE,
        pitch_point=short(cycle.pitch_point) if known else _NONE,
        c_gamma_beta=short(cycle.secant_per_width),
        c_gamma_alpha=short(cycle.tangent_per_width),
        single=short(cycle.single_stiffness) if cycle.single_stiffness is not None else _NONE,
        deviation=f"{100 * deviation:+.1f}" if deviation is not None else _NONE,
    )


def _figures(comparison: StiffnessComparison) -> list[ReportFigure]:
    """Return the figures of the comparison: parts of the compliance, and influence of the load.

    Figures that would show nothing are left out.
    """
    found = []
    if comparison.divided:
        address = figure_address(partial(plot_parts_of_all, comparison), "svg", parts_inches(comparison))
        found.append(ReportFigure("Parts of the compliance", address, _caption(comparison, "parts")))
    if len(comparison.load_points) > len(comparison.cycles):
        address = picture_address(partial(plot_load_dependence, comparison), "svg", _TALL)
        found.append(ReportFigure("Mean mesh stiffness over the load", address, _caption(comparison, "load")))
    return found


def _caption(comparison: StiffnessComparison, figure: str) -> str:
    return sentences("captions_stiffness.txt", figure, comparison)


_COLOURS = 256
_STOPS = 9
"""Number of colours in the legend."""


class SurfaceData(TypedDict):
    """Arrays of a tooth's surface in base64, which the page draws.

    Points (mm) are 32-bit floats, triangles numbers of `bytes` bytes, stresses numbers of colours; `size` is the greatest
    distance from the origin (mm), `yaw` and `pitch` the first view (deg).
    """

    points: str
    triangles: str
    bytes: int
    stress: str
    colours: str
    size: float
    yaw: float
    pitch: float


class ToothView(NamedTuple):
    """One view: title, address of the still picture, numbers for the page, colours and words of the legend, caption."""

    title: str
    address: str
    data: SurfaceData
    colours: list[str]
    legend: list[str]
    caption: str


def tooth_view(surface: ToothSurface, role: Role, caption: str) -> ToothView:
    """Return the view of the most stressed tooth of a gear."""
    return ToothView(
        title=f"Stress in a tooth of the {role.value}",
        address=picture_address(partial(plot_tooth, surface), "png"),
        data=_data(surface),
        colours=[f"rgb({red}, {green}, {blue})" for red, green, blue in _colours(_STOPS)],
        legend=[short(round(part * surface.most)) for part in (0.0, 0.25, 0.5, 0.75, 1.0)],
        caption=caption,
    )


def _data(surface: ToothSurface) -> SurfaceData:
    """Return the arrays of a surface, its triangles as 16-bit numbers where these suffice, else as 32-bit numbers."""
    small = len(surface.points) <= np.iinfo("<u2").max
    stress = np.clip(surface.von_mises / surface.most, 0, 1) * (_COLOURS - 1)
    return {
        "points": _packed(surface.points, "<f4"),
        "triangles": _packed(surface.triangles, "<u2" if small else "<u4"),
        "bytes": 2 if small else 4,
        "stress": _packed(stress.round(), "u1"),
        "colours": _packed(_colours(_COLOURS), "u1"),
        "size": float(np.linalg.norm(surface.points, axis=1).max()),
        "yaw": YAW,
        "pitch": PITCH,
    }


def _packed(values: np.typing.NDArray[Any], kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, kind).tobytes()).decode("ascii")


def _colours(count: int) -> np.typing.NDArray[np.uint8]:
    """Colours (count, 3) of the map from its one end to the other."""
    from matplotlib import colormaps

    found: np.typing.NDArray[np.uint8] = colormaps[COLOUR_MAP](np.linspace(0, 1, count), bytes=True)[:, :3]
    return found


Checked = TypeVar("Checked", bound=CheckResult)


class ComparisonRow(NamedTuple):
    """A comparison as the tables have it; the verdict is a `word`, not only a colour."""

    quantity: str
    computed: str
    reference: str
    unit: str
    permitted: str
    deviation: str
    word: str
    style: str
    source: str
    note: str
    reason: str


@dataclass(frozen=True)
class CheckSections(ABC, Generic[Checked]):
    """Sections of the report of a `result`; each model has a `template` for what it tells in other words, and `captions`."""

    result: Checked

    template: ClassVar[str]
    captions: ClassVar[str]

    # ------------------------------------------------------------------ the verdict

    @property
    def verdict(self) -> str:
        """Verdict, beginning with a capital letter."""
        return self.result.verdict[0].upper() + self.result.verdict[1:]

    @property
    def gates(self) -> list[ComparisonRow]:
        """Rows of comparisons that decide the verdict."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.GATE]

    @property
    def information(self) -> list[ComparisonRow]:
        """Rows of comparisons that are for information only."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.INFORMATION]

    @property
    def failed(self) -> list[ComparisonRow]:
        """Gates that are not passed."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.GATE and not each.passed]

    @property
    def outside(self) -> list[ComparisonRow]:
        """Information outside its band."""
        found = (each for each in self.result.comparisons if each.role is ComparisonRole.INFORMATION)
        return [_row(each) for each in found if each.evaluated and not each.passed and each.tolerance is not None]

    @property
    def below(self) -> tuple[str, ...]:
        """Safeties by finite elements that are less than required."""
        return self.result.safeties.below_required

    # ------------------------------------------------------------------ why they differ

    @property
    @abstractmethod
    def root_reasons(self) -> list[str]:
        """Reasons why the root stresses differ from those of the standard."""

    @property
    def stiffness_reasons(self) -> list[str]:
        """Reasons why the stiffness differs from that of the standard."""
        of, part, names = self.result.explanations.stiffness, self.result.rating.edition.part(1), self.result.names
        ring = self.result.ring
        return [
            sentences("reasons_check.txt", macro, of, part, ring, names) for macro in ("compared", "bodies", "load", "sharing")
        ]

    # ------------------------------------------------------------------ figures

    @property
    def pair(self) -> ReportFigure:
        """The gears in mesh."""
        return pair_picture(self.result.pair)

    @cached_property
    @abstractmethod
    def figures(self) -> list[ReportFigure]:
        """Figures in the order of the report."""

    @cached_property
    def views(self) -> list[ToothView]:
        """Teeth to be turned by hand; only solid bodies have some."""
        return []

    def figure(
        self, title: str, draw: Callable[[Axes], Axes], caption: str, kind: str = "svg", *values: object
    ) -> ReportFigure:
        """One with a caption of the model's own, of the result and of other values."""
        return ReportFigure(title, picture_address(draw, kind), self.caption(caption, *values))

    def caption(self, name: str, *values: object) -> str:
        """Return the caption of this name, from the model's own template."""
        return sentences(self.captions, name, self.result, *values)

    @property
    def over_mesh(self) -> list[ReportFigure]:
        """Courses over one base pitch."""
        of = self.result
        return [
            _common("Mesh stiffness", partial(plot_mesh_stiffness, of), "mesh_stiffness", of),
            _common("Transmission error", partial(plot_transmission_error, of), "transmission_error", of),
            _common("Root stress over the mesh", partial(plot_root_stress, of), "root_stress", of),
            *([] if of.losses is None else [_common("Losses", partial(plot_losses, of.losses), "friction_losses", of)]),
            *(figure for exposure in of.exposure.values() for figure in _below_flank(exposure)),
            *([] if of.film is None else [_common("Oil film", partial(plot_oil_film, of.film), "oil_film", of.film)]),
        ]

    @property
    def over_torque_and_mesh_size(self) -> list[ReportFigure]:
        """Figures over torque, and over mesh size if a convergence study was made."""
        of = self.result
        found = [
            _common("Pressure over torque", partial(plot_sweep_pressure, of), "sweep_pressure", of.trends, of.names),
            _common("Stiffness over torque", partial(plot_sweep_stiffness, of), "sweep_stiffness", of.trends, of.names),
        ]
        if of.convergence:
            found.append(self.figure("Convergence", partial(plot_convergence, of), "convergence"))
        return found

    @cached_property
    def stiffness(self) -> StiffnessSection | str:
        """Section on stiffness by other methods, or the reason why there is none."""
        return section_of_check(self.result.stiffness_methods)

    @cached_property
    def strength(self) -> StrengthSection:
        """Safeties by finite elements and by the standard."""
        return strength_section(self.result.safeties)

    # ------------------------------------------------------------------ inputs and rating

    @property
    def gear_rows(self) -> list[ReportRow]:
        """Rows of both gears."""
        return gear_rows(self.result.pair)

    @property
    def pair_rows(self) -> list[ReportRow]:
        """Rows of the pair."""
        return pair_rows(self.result.pair)

    @property
    def load_rows(self) -> list[ReportRow]:
        """Rows of material, load and mounting."""
        return load_rows(self.result.material, self.result.load, self.result.mounting)

    @property
    def rating_rows(self) -> list[ReportRow]:
        """Rows of the rating."""
        return rating_rows(self.result)


def _common(title: str, draw: Callable[[Axes], Axes], caption: str, *of: object) -> ReportFigure:
    return ReportFigure(title, picture_address(draw, "svg"), sentences("captions_check.txt", caption, *of))


def _below_flank(of: MaterialExposure) -> Iterator[ReportFigure]:
    """Yield the figures of the material exposure of a gear."""
    whose, text = of.role.value, sentences("captions_check.txt", "exposure", of)
    yield ReportFigure(f"Material exposure, {whose}", picture_address(partial(plot_exposure, of), "png"), text)
    course = sentences("captions_check.txt", "exposure_course", of)
    yield ReportFigure(f"Shear stress over depth, {whose}", picture_address(partial(plot_exposure_course, of), "svg"), course)


def _row(comparison: Comparison) -> ComparisonRow:
    gate = comparison.role is ComparisonRole.GATE
    if comparison.passed:
        word = "passed" if gate else "reached" if comparison.least else "in the band"
    elif gate or not comparison.evaluated:
        word = "NOT PASSED" if gate else "not evaluated"
    else:
        word = "below" if comparison.least else "above" if comparison.tolerance is None else "outside the band"
    return ComparisonRow(
        quantity=comparison.quantity,
        computed=_number(comparison.computed),
        reference=_number(comparison.reference),
        unit=comparison.unit,
        permitted=_permitted(comparison),
        deviation=_deviation(comparison),
        word=word,
        style="good" if comparison.passed else "bad" if gate else "aside",
        source=comparison.source,
        note=comparison.note,
        reason=comparison.reason,
    )


def _permitted(comparison: Comparison) -> str:
    if comparison.tolerance is not None:
        return f"± {100 * comparison.tolerance:g} %"
    return "at least" if comparison.least else "at most"


def _number(value: float | None) -> str:
    return "-" if value is None else short(value)


def _deviation(comparison: Comparison) -> str:
    """Return the deviation of a value from its reference in percent, or the used share of a limit; "-" if there is none."""
    if comparison.deviation is None:
        return "-"
    percent = 100 * comparison.deviation
    return f"{100 + percent:.1f} % of it" if comparison.tolerance is None else f"{round(percent, 2) + 0.0:+.2f} %"


class PlaneSections(CheckSections[PlaneCheck]):
    """Sections of the report on the transverse section."""

    template: ClassVar[str] = "report_plane.html"
    captions: ClassVar[str] = "captions_plane.txt"

    @property
    def root_reasons(self) -> list[str]:
        part = self.result.rating.edition.part(3)
        roots = self.result.explanations.root_stress
        leans = self.result.rating.roots.map(lambda root: root.section.lean)
        names = self.result.names
        return [
            sentences("reasons_plane.txt", "root_stress", of, names.pick(role), part, leans.pick(role))
            for role, of in roots.items()
        ]

    @cached_property
    def figures(self) -> list[ReportFigure]:
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


class FactorRow(NamedTuple):
    """K_Hbeta by a model of the face, and f_sh (µm) where it has one."""

    words: str
    factor: str
    deflection: str


class ShaftRow(NamedTuple):
    """A place of a shaft in the face: displacements (µm), inclinations (µm/mm) and twist (degrees)."""

    words: str
    numbers: list[str]


class SolidSections(CheckSections[SolidCheck]):
    """Sections of the report on solid bodies over their face widths."""

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
        """Reasons why loads along the lines of contact differ from those of the standard."""
        of = self.result.explanations.lines_of_contact
        return [sentences("reasons_solid.txt", macro, of) for macro in ("pressure", "lines", "along_face")]

    @cached_property
    def figures(self) -> list[ReportFigure]:
        of, figure = self.result, self.figure
        patterns = [
            figure(f"Contact pattern, {role.value}", partial(plot_contact_pattern, of, role), "contact_pattern", "png", role)
            for role in Role
        ]
        shafts = () if of.shafts is None else (of.shafts,)
        return [
            figure("Load over the plane of action", partial(plot_line_loads, of), "line_loads", "png"),
            *patterns,
            figure("Load along the face width", partial(plot_load_along_face, of), "load_along_face"),
            *(figure("Gap that the shafts leave", partial(plot_gap_of_shafts, each), "gap_of_shafts") for each in shafts),
            figure("Root stress along the face width", partial(plot_root_along_face, of), "root_along_face"),
            figure("Load share", partial(plot_lines_share, of), "load_share"),
            *self.over_mesh,
            figure("Harmonics of the transmission error", partial(plot_harmonics, of), "harmonics"),
            *self.over_torque_and_mesh_size,
        ]

    @property
    def shaft_factors(self) -> list[FactorRow]:
        """Rows of K_Hbeta on shafts by the bodies, annex E and Method C; none of a pair on rigid shafts."""
        if (of := self.result.shafts) is None:
            return []
        deflection, factor = of.method_c
        return [
            FactorRow("solid bodies on the shafts", f"{of.face_load_factor:.3f}", _NONE),
            FactorRow("solid bodies on rigid shafts", f"{of.rigid_face_load_factor:.3f}", _NONE),
            FactorRow(
                "ISO 6336-1, annex E, on the shafts", f"{of.mesh.face_load_factor:.3f}", short(of.mesh.misalignment_of_shafts)
            ),
            FactorRow("ISO 6336-1, annex E, on rigid shafts", f"{of.annex_e_on_rigid_shafts:.3f}", _NONE),
            FactorRow("ISO 6336-1, Method C, the shaft of [rating]", f"{factor:.3f}", short(deflection)),
        ]

    @property
    def shaft_rows(self) -> list[ShaftRow]:
        """Rows of the shafts in the face; none of a pair on rigid shafts."""
        if (of := self.result.shafts) is None:
            return []
        return [
            ShaftRow(
                f"{role.value}, {short(place)} mm",
                [short(value) for value in (*(1000 * moved[:3]), 1000 * moved[4], -1000 * moved[3], np.degrees(moved[5]))],
            )
            for role in of.states
            for place, moved in of.face_states(role)
        ]

    @cached_property
    def views(self) -> list[ToothView]:
        surfaces = self.result.tooth_surfaces
        return [tooth_view(surface, role, self.caption("tooth_view", role)) for role, surface in surfaces.items()]


def write_report(result: CheckResult, design_name: str, path: Path, head: Mapping[str, str] | None = None) -> None:
    """Write the report of a check of the design to `path`; the same result gives the same bytes."""
    path.write_text(report_html(result, design_name, head), encoding="utf-8", newline="\n")


def report_html(result: CheckResult, design_name: str, head: Mapping[str, str] | None = None) -> str:
    """The report as one HTML document without links: pictures and styles are inside."""
    sections = _sections(result)
    return page_html(sections.template, design_name, head, result=result, of=sections)


@singledispatch
def _sections(result: CheckResult) -> CheckSections[Any]:
    """Return the sections of a result, by its model."""
    raise NotImplementedError(type(result).__name__)


_sections.register(PlaneCheck, PlaneSections)
_sections.register(SolidCheck, SolidSections)
