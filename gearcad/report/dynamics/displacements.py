"""How everything moves over speed, in the report: tables and pictures; gears on their bearings."""

from __future__ import annotations

from functools import partial

from gearcad.dynamics.train_result import TrainStudy
from gearcad.plots.displacements import bearing_inches, displacement_inches, plot_bearings, plot_displacements
from gearcad.plots.paper import short
from gearcad.plots.transmission import plot_lines, plot_waterfall, waterfall_inches
from gearcad.report.check.figures import Picture, figure_address, picture_address
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.sentences import sentences

__all__ = ["bearing_figures", "bearing_mode_table", "bearing_table", "displacement_figures", "displacement_table"]

_NONE = "–"  # an en dash where there is no value

_WIDE = (6.6, 4.2)


def displacement_table(study: TrainStudy) -> WordTable:
    """Where inertias, flanks and axes swing farthest."""
    rows = []
    for each in study.greatest_amplitudes:
        words = f"{each.name}: {each.quantity}" + ("" if each.direction is None else f", running {each.direction.value}")
        rows.append((words, short(each.amplitude), each.unit, *map(short, (each.speed, each.frequency))))
    return WordTable(("greatest amplitude", "", "", "pinion, rpm", "tooth frequency, 1/s"), rows)


def displacement_figures(study: TrainStudy) -> list[Picture]:
    """Over speed; the dynamic transmission error at one speed and over all, where it has lines."""
    drawn = figure_address(partial(plot_displacements, study), "svg", displacement_inches(study))
    found = [Picture("Displacements over speed", drawn, _said("displacements", study))]
    if len(study.course.order):
        lines = picture_address(partial(plot_lines, study), "svg", _WIDE)
        found.append(Picture("Dynamic transmission error at one speed", lines, _said("transmission_lines", study)))
    if len(study.up.transmission.orders):
        waterfall = figure_address(partial(plot_waterfall, study), "svg", waterfall_inches(study))
        found.append(Picture("Dynamic transmission error over speed", waterfall, _said("waterfall", study)))
    return found


def bearing_mode_table(study: TrainStudy) -> WordTable | None:
    """The six modes of gears on bearings; None of others."""
    modes = study.on_bearings
    if modes is None:
        return None
    heads = (
        "mode",
        "what moves most",
        "Hz",
        "1/s",
        "met at rpm",
        "energy in the mesh, %",
        "pinion's bearings, %",
        "wheel's, %",
    )
    rows = []
    for mode, (hertz, circular) in enumerate(zip(modes.frequency.tolist(), modes.circular.tolist(), strict=True)):
        if mode == 0:
            rows.append(("f₁", modes.words[0], short(hertz), short(circular), *[_NONE] * 4))
            continue
        met = short(60 * hertz / study.train.meshes[0].teeth) if modes.shaken[mode] else _NONE
        shares = (f"{100 * share:.1f}" for share in modes.potential[mode])
        rows.append((f"f{'₁₂₃₄₅₆'[mode]}", modes.words[mode], short(hertz), short(circular), met, *shares))
    return WordTable(heads, rows, 2)


def bearing_table(study: TrainStudy) -> WordTable:
    """The greatest forces on the bearings of both gears."""
    rows = []
    for each in study.greatest_bearing_forces:
        words = each.gear + ("" if each.direction is None else f", running {each.direction.value}")
        numbers = (each.static, each.force, each.force / each.static, each.speed, each.frequency)
        rows.append((words, *map(short, numbers)))
    return WordTable(
        ("bearings of", "at rest, N", "greatest, N", "over that at rest", "pinion, rpm", "tooth frequency, 1/s"), rows
    )


def bearing_figures(study: TrainStudy) -> list[Picture]:
    """Forces on bearings over speed; none of gears that do not travel."""
    if study.up.bearings is None:
        return []
    drawn = figure_address(partial(plot_bearings, study), "svg", bearing_inches())
    return [Picture("Forces on the bearings over speed", drawn, _said("bearings", study))]


def _said(macro: str, *values: object) -> str:
    return sentences("captions_dynamics.txt", macro, *values)
