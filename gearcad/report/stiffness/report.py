"""The report of a comparison of methods for the mesh stiffness, and the section of it that the report of a check has."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import NamedTuple

from gearcad.check.stiffness import StiffnessMethods
from gearcad.mesh_cycle import MeshCycle
from gearcad.mounting import Mounting
from gearcad.plots.paper import short
from gearcad.plots.stiffness import parts_inches, plot_load_dependence, plot_parts_of_all, plot_stiffness
from gearcad.report.check.figures import Picture, figure_address, pair_picture, picture_address
from gearcad.report.check.tables import gear_rows, load_rows, pair_rows
from gearcad.report.page import page_html
from gearcad.report.sentences import sentences
from gearcad.stiffness.comparison import StiffnessComparison

__all__ = ["StiffnessSection", "section_of_check", "stiffness_html", "write_stiffness_report"]

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
    curves: Picture
    notes: list[tuple[str, tuple[str, ...]]]
    left_out: list[tuple[str, str]]


def write_stiffness_report(comparison: StiffnessComparison, design_name: str, path: Path) -> None:
    """Write the report of a comparison of the design's pair to `path`; the same comparison gives the same bytes."""
    path.write_text(stiffness_html(comparison, design_name), encoding="utf-8")


def stiffness_html(comparison: StiffnessComparison, design_name: str) -> str:
    """The report as one HTML document without links."""
    return page_html(
        "stiffness.html",
        design_name,
        of=comparison,
        stiffness=_section(comparison),
        figures=_figures(comparison),
        pair_picture=pair_picture(comparison.pair),
        gear_rows=gear_rows(comparison.pair, _GEAR),
        pair_rows=pair_rows(comparison.pair),
        load_rows=load_rows(comparison.material, comparison.load, Mounting()),
    )


def section_of_check(methods: StiffnessMethods) -> StiffnessSection | str:
    """The model of a check beside the closed forms; why not, where they cannot be had."""
    return _section(methods.comparison) if methods.comparison is not None else methods.reason


def _section(comparison: StiffnessComparison) -> StiffnessSection:
    return StiffnessSection(
        rows=[_row(comparison, cycle) for cycle in comparison.cycles],
        referred=comparison.reference is not None,
        curves=Picture(
            "Mesh stiffness along the line of action",
            picture_address(partial(plot_stiffness, comparison), "svg", _TALL),
            _caption(comparison, "curves"),
        ),
        notes=[(comparison.titles[cycle.method], cycle.notes) for cycle in comparison.cycles if cycle.notes],
        left_out=[(comparison.titles[name], reason) for name, reason in comparison.left_out.items()],
    )


def _row(comparison: StiffnessComparison, cycle: MeshCycle) -> _MethodRow:
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


def _figures(comparison: StiffnessComparison) -> list[Picture]:
    """Those of the comparison alone: parts of the compliance, and the load's influence; none that would show nothing."""
    found = []
    if comparison.divided:
        address = figure_address(partial(plot_parts_of_all, comparison), "svg", parts_inches(comparison))
        found.append(Picture("Parts of the compliance", address, _caption(comparison, "parts")))
    if len(comparison.load_points) > len(comparison.cycles):
        address = picture_address(partial(plot_load_dependence, comparison), "svg", _TALL)
        found.append(Picture("Mean mesh stiffness over the load", address, _caption(comparison, "load")))
    return found


def _caption(comparison: StiffnessComparison, figure: str) -> str:
    return sentences("captions_stiffness.txt", figure, comparison)
