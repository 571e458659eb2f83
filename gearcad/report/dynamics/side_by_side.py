"""A train several times side by side: tables of what differs, pictures, and the sections of its report."""

from __future__ import annotations

from functools import partial

from gearcad.dynamics.side_by_side import SideBySide
from gearcad.plots.paper import short
from gearcad.plots.side_by_side import (
    beside_inches,
    plot_approaches_beside,
    plot_errors_beside,
    plot_factors_beside,
    plot_overloads_beside,
)
from gearcad.report.check.figures import Picture, figure_address
from gearcad.report.dynamics.tables import WordTable, factor_text
from gearcad.report.sentences import sentences

__all__ = ["beside_figures", "frequency_table", "greatest_table", "overload_table", "resonance_table"]

_NONE = "–"  # an en dash where there is no value


def greatest_table(of: SideBySide) -> WordTable:
    """The greatest K_v of every mesh in every study, and where."""
    heads = ("mesh", of.what, "greatest K_v", "at rpm")
    rows = []
    for each in of.greatest:
        last = "" if each.stable else ", unstable"
        rows.append((each.mesh, each.label + last, factor_text(each.factor), short(each.speed)))
    return WordTable(heads, rows, 2)


def overload_table(of: SideBySide) -> WordTable:
    """The greatest overload of every shaft in the studies that have it, and where."""
    rows = [(each.shaft, each.label, factor_text(each.factor), short(each.speed)) for each in of.shaft_overloads]
    return WordTable(("shaft", of.what, "greatest torque over the static one", "at rpm"), rows, 2)


def resonance_table(of: SideBySide) -> WordTable:
    """The highest resonances, each in every study: speed, how far it is off that of the reference, and K_v."""
    heads = ("mesh", "resonance", of.what, "rpm", f"off {of.labels[of.reference]}, %", "K_v")
    rows, number = [], dict.fromkeys(of.mesh_names, 0)
    for each in of.resonances:
        number[each.mesh] += 1
        for study, (label, peak) in enumerate(zip(of.labels, each.shown, strict=True)):
            numbers = (_NONE,) * 3
            if peak is not None:
                moved = each.moved(study, of.reference)
                off = _NONE if moved is None or study == of.reference else f"{100 * moved:+.2f}"
                numbers = (short(peak.speed), off, factor_text(peak.factor))
            rows.append((each.mesh, str(number[each.mesh]), label, *numbers))
    return WordTable(heads, rows, 3)


def beside_figures(of: SideBySide) -> list[Picture]:
    """K_v of all meshes, also with errors of teeth, and overload of the shafts that carry something, approach of the flanks."""
    drawn = [("Dynamic factor over speed", plot_factors_beside, "factors_beside", len(of.mesh_names))]
    if of.errors:
        drawn.append(("Dynamic factor with tooth errors", plot_errors_beside, "errors_beside", len(of.mesh_names)))
    if of.shaft_names:
        drawn.append(("Overload of the shafts over speed", plot_overloads_beside, "overloads_beside", len(of.shaft_names)))
    drawn.append(("Approach of the flanks over speed", plot_approaches_beside, "approaches_beside", len(of.mesh_names)))
    return [
        Picture(
            title,
            figure_address(partial(plot, of), "svg", beside_inches(panels, len(of.studies))),
            sentences("captions_dynamics.txt", macro, of),
        )
        for title, plot, macro, panels in drawn
    ]


def frequency_table(of: SideBySide) -> WordTable:
    """Natural frequencies in 1/s, those of modes that move alike in a row."""
    rows = [
        (str(number), *(_NONE if each is None else short(each) for each in group))
        for number, group in enumerate(of.natural_frequencies, 1)
    ]
    return WordTable(("", *of.titles), rows)
