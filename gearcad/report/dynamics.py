"""Report of a study of dynamics: of a train, or of a pair."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial, singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.dynamics.level_verdict import LevelStudy
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.tooth_errors.error_result import BAND, ErrorStudy
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.dynamics.trains.train_modes import NaturalModes
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.plots.motions import (
    MOTION_INCHES,
    factors_inches,
    plot_angles,
    plot_campbell,
    plot_lines,
    plot_motion,
    plot_spectrum,
    plot_transient,
    plot_transient_factors,
    plot_waterfall,
    transient_inches,
    waterfall_inches,
)
from gearcad.plots.orders import orders_inches, plot_orders, plot_spectrogram, plot_tracks
from gearcad.plots.paper import short
from gearcad.plots.speeds import (
    bearing_inches,
    course_inches,
    displacement_inches,
    plot_bearings,
    plot_course,
    plot_cycle,
    plot_displacements,
    plot_factors,
    plot_shaft_overload,
    plot_tooth_errors,
)
from gearcad.plots.trains import (
    MOST_SHAPES,
    beside_inches,
    energies_inches,
    plot_approaches_beside,
    plot_energies,
    plot_errors_beside,
    plot_factors_beside,
    plot_overloads_beside,
    plot_shapes,
    shapes_inches,
)
from gearcad.report.document import (
    ReportFigure,
    figure_address,
    gear_rows,
    names_of_pair,
    page_html,
    pair_picture,
    pair_rows,
    picture_address,
    sentences,
)
from gearcad.report.dynamics_tables import (
    MOST_PEAKS,
    WordTable,
    component_table,
    contact_rows,
    deciding_table,
    factor_text,
    inertia_table,
    level_resonance_table,
    mesh_table,
    mode_table,
    pair_dynamics_rows,
    pair_table,
    peak_table,
    shaft_table,
    shape_table,
    speed_table,
    unjudged_table,
    verdict_table,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_NONE = "–"  # an en dash where there is no value

_DISPLACEMENTS_WIDE = (6.6, 4.2)


def displacement_table(study: TrainStudy) -> WordTable:
    """Return the table of the greatest amplitudes of inertias, flanks and axes."""
    rows = []
    for each in study.greatest_amplitudes:
        words = f"{each.name}: {each.quantity}" + ("" if each.direction is None else f", running {each.direction.value}")
        rows.append((words, short(each.amplitude), each.unit, *map(short, (each.speed, each.frequency))))
    return WordTable(("greatest amplitude", "", "", "pinion, rpm", "tooth frequency, 1/s"), rows)


def displacement_figures(study: TrainStudy) -> list[ReportFigure]:
    """Return figures of displacements over speed, and of the dynamic transmission error at one speed and over all, if it has
    lines.
    """
    drawn = figure_address(partial(plot_displacements, study), "svg", displacement_inches(study))
    found = [ReportFigure("Displacements over speed", drawn, _said("displacements", study))]
    if len(study.course.order):
        lines = picture_address(partial(plot_lines, study), "svg", _DISPLACEMENTS_WIDE)
        found.append(ReportFigure("Dynamic transmission error at one speed", lines, _said("transmission_lines", study)))
    if len(study.up.transmission.orders):
        waterfall = figure_address(partial(plot_waterfall, study), "svg", waterfall_inches(study))
        found.append(ReportFigure("Dynamic transmission error over speed", waterfall, _said("waterfall", study)))
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


def bearing_figures(study: TrainStudy) -> list[ReportFigure]:
    """Forces on bearings over speed; none of gears that do not travel."""
    if study.up.bearings is None:
        return []
    drawn = figure_address(partial(plot_bearings, study), "svg", bearing_inches())
    return [ReportFigure("Forces on the bearings over speed", drawn, _said("bearings", study))]


def _said(macro: str, *values: object) -> str:
    return sentences("captions_dynamics.txt", macro, *values)


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


def beside_figures(of: SideBySide) -> list[ReportFigure]:
    """K_v of all meshes, also with errors of teeth, and overload of the shafts that carry something, approach of the flanks."""
    drawn = [("Dynamic factor over speed", plot_factors_beside, "factors_beside", len(of.mesh_names))]
    if of.errors:
        drawn.append(("Dynamic factor with tooth errors", plot_errors_beside, "errors_beside", len(of.mesh_names)))
    if of.shaft_names:
        drawn.append(("Overload of the shafts over speed", plot_overloads_beside, "overloads_beside", len(of.shaft_names)))
    drawn.append(("Approach of the flanks over speed", plot_approaches_beside, "approaches_beside", len(of.mesh_names)))
    return [
        ReportFigure(
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


def error_table(study: TrainStudy) -> WordTable | None:
    """Rows of each mesh: over all speeds, and at the one asked for if it is among them; None where nothing was drawn."""
    if study.errors is None:
        return None
    of = study.errors
    upper = f"{100 * BAND[1]:g} % quantile"
    heads = ("mesh", "", "without errors", "at rpm", "median", "at rpm", upper, "at rpm", "greatest", "at rpm")
    rows = []
    for mesh, name in enumerate(of.mesh_names):
        curves = (of.nominal, of.median, of.band[1], of.most)
        places = [int(curve[:, mesh].argmax()) for curve in curves]
        cells = [
            (factor_text(float(curve[row, mesh])), short(float(of.speeds[row])))
            for curve, row in zip(curves, places, strict=True)
        ]
        rows.append((name, "highest over speed", *(cell for pair in cells for cell in pair)))
        if (row := _asked(study, of)) is not None:
            speed = short(float(of.speeds[row]))
            found = [cell for curve in curves for cell in (factor_text(float(curve[row, mesh])), speed)]
            rows.append((name, "at the speed asked for", *found))
    return WordTable(heads, rows, 2)


def _asked(study: TrainStudy, of: ErrorStudy) -> int | None:
    """Return the index of the train's speed among the speeds of the error study, or None."""
    found = np.flatnonzero(np.isclose(of.speeds, abs(study.train.speed), rtol=1e-9))
    return int(found[0]) if len(found) and study.train.speed else None


_GEAR = "teeth normal_module helix_angle profile_shift face_width reference_diameter base_diameter tip_diameter body.bore"

_WIDE = (6.6, 4.4)
_TALL = (6.6, 5.2)
"""Sizes (inches): with a second axis above, and of two pictures on each other."""


def write_dynamics_report(
    study: TrainStudy | ModalStudy | SideBySide | PairStudy | ContactStudy,
    name: str,
    path: Path,
    head: Mapping[str, str] | None = None,
) -> None:
    """Write the report of a study of the design `name` to `path`; the same study gives the same bytes."""
    path.write_text(dynamics_html(study, name, head), encoding="utf-8", newline="\n")


@singledispatch
def dynamics_html(study: object, name: str, head: Mapping[str, str] | None = None) -> str:
    """The report of a study as one HTML document without links."""
    raise TypeError(f"a {type(study).__name__} of {name} has no report of dynamics")


@dynamics_html.register
def _modes_html(study: ModalStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    return page_html(
        "dynamics_modes.html",
        name,
        head,
        of=study,
        parts=[inertia_table(study), *([shaft_table(study)] if study.train.shafts else [])],
        modes=mode_table(study.modes),
        **_shapes(study.modes),
        shape_figures=_shape_figures(study),
        order_figures=_order_figures(study),
        time_figures=_transient_figures(study),
        warnings=study.warnings,
    )


def _shapes(modes: NaturalModes) -> dict[str, WordTable | None]:
    """Tables of shapes: of the natural modes, and of the components of which the model is made."""
    components = modes.component_modes
    return {"shapes": shape_table(modes), "components": None if components is None else component_table(components)}


def _shape_figures(study: TrainStudy | ModalStudy) -> list[ReportFigure]:
    train, modes = study.train, study.modes
    shapes, energies = partial(plot_shapes, train, modes), partial(plot_energies, modes)
    return [
        _figure("Natural modes", shapes, shapes_inches(train, modes), _said("shapes", study, MOST_SHAPES)),
        _figure("Energy of the modes", energies, energies_inches(modes), _said("energies", study)),
    ]


@dynamics_html.register
def _train_html(study: TrainStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    return page_html(
        "dynamics_train.html",
        name,
        head,
        of=study,
        parts=_parts(study),
        greatest=_said("greatest", study),
        modes=mode_table(study.modes),
        **_shapes(study.modes),
        most=MOST_PEAKS,
        peaks=peak_table(study),
        errors=error_table(study),
        shape_figures=_shape_figures(study),
        pair_figures=_pair_figures(study),
        speed_figures=_speed_figures(study),
        displacements=displacement_table(study),
        displacement_figures=displacement_figures(study),
        warnings=study.warnings,
    )


def _parts(study: TrainStudy) -> list[WordTable]:
    """Return the tables of the parts of the train."""
    shafts = [shaft_table(study)] if study.train.shafts else []
    return [inertia_table(study), *shafts, mesh_table(study), *([pair_table(study)] if study.pairs else [])]


def _pair_figures(study: TrainStudy) -> list[ReportFigure]:
    """The stiffness of each pair over one base pitch."""
    courses = {name: mesh.course for name, mesh in study.pairs.items()}
    return [
        ReportFigure(
            f"Mesh stiffness of {name}", picture_address(partial(plot_cycle, course.cycle), "svg"), _said("pair_course", course)
        )
        for name, course in courses.items()
    ]


@dynamics_html.register
def _side_by_side_html(study: SideBySide, name: str, head: Mapping[str, str] | None = None) -> str:
    return page_html("dynamics_side_by_side.html", name, head, **_beside(study))


@dynamics_html.register
def _levels_html(study: LevelStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    first = study.studies[study.reference]
    return page_html(
        "dynamics_levels.html",
        name,
        head,
        **_beside(study),
        verdicts=verdict_table(study),
        level_resonances=level_resonance_table(study),
        deciding=deciding_table(study),
        unjudged=unjudged_table(study),
        modes=mode_table(first.modes),
        shape_figures=_shape_figures(first),
    )


def _beside(study: SideBySide) -> dict[str, Any]:
    """Return the values that both pages of several studies show."""
    first = study.studies[study.reference]
    return {
        "of": study,
        "first": first,
        "parts": _parts(first),
        "greatest": greatest_table(study),
        "overloads": overload_table(study),
        "resonances": resonance_table(study),
        "frequencies": frequency_table(study),
        "figures": beside_figures(study),
        "warnings": study.warnings,
    }


@dynamics_html.register
def _pair_html(study: PairStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    of = study.study
    curve = picture_address(partial(plot_cycle, study.cycle), "svg")
    return page_html(
        "dynamics_pair.html",
        name,
        head,
        of=of,
        on_bearings=study.bearings is not None,
        names=names_of_pair(study.pair),
        greatest=_said("greatest", of),
        pair_picture=pair_picture(study.pair),
        gear_rows=gear_rows(study.pair, _GEAR),
        pair_rows=pair_rows(study.pair),
        rows=pair_dynamics_rows(study),
        curve=ReportFigure("Mesh stiffness", curve, _said("cycle", study)),
        most=MOST_PEAKS,
        peaks=peak_table(of),
        errors=error_table(of),
        speed_figures=_speed_figures(of),
        displacements=displacement_table(of),
        displacement_figures=displacement_figures(of),
        bearing_modes=bearing_mode_table(of),
        bearing_forces=bearing_table(of),
        bearing_figures=bearing_figures(of),
        warnings=study.warnings,
    )


@dynamics_html.register
def _contact_html(study: ContactStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    highest, history = study.study.frequency[-1] / 2, study.history
    diagram = picture_address(partial(plot_campbell, study.study, highest=highest), "svg", _TALL)
    spectrum = picture_address(partial(plot_spectrum, history, highest=highest), "svg")
    return page_html(
        "dynamics_contact.html",
        name,
        head,
        of=study,
        pair_picture=pair_picture(study.pair),
        gear_rows=gear_rows(study.pair, _GEAR),
        pair_rows=pair_rows(study.pair),
        rows=contact_rows(study),
        speeds=speed_table(study.study),
        figures=[
            ReportFigure("Campbell diagram", diagram, _said("campbell", study)),
            _figure("Speeds over time", partial(plot_motion, history), MOTION_INCHES, _said("motion", study)),
            _figure("Angles over time", partial(plot_angles, history), MOTION_INCHES, _said("angles", study)),
            ReportFigure("Spectrum at one speed", spectrum, _said("spectrum", study)),
        ],
        warnings=study.warnings,
    )


def _speed_figures(study: TrainStudy) -> list[ReportFigure]:
    """Return figures over speed and at one speed, without those that would show nothing."""
    chart = picture_address(partial(plot_factors, study), "svg", _WIDE)
    found = [ReportFigure("Dynamic factor over speed", chart, _said("factors", study))]
    if study.up.referred_shafts:
        address = picture_address(partial(plot_shaft_overload, study), "svg", _WIDE)
        found.append(ReportFigure("Overload of the shafts over speed", address, _said("shaft_overload", study)))
    if study.errors is not None:
        address = picture_address(partial(plot_tooth_errors, study), "svg", _WIDE)
        found.append(ReportFigure("Dynamic factor with tooth errors", address, _said("tooth_errors", study)))
    found.append(_figure("Course at one speed", partial(plot_course, study), course_inches(study), _said("course", study)))
    return found + _order_figures(study) + _transient_figures(study) + _campbell_figures(study)


def _order_figures(study: TrainStudy | ModalStudy) -> list[ReportFigure]:
    """Return the figure of the amplitudes of orders over speed, where there are torques on inertias."""
    of = study.orders
    if of is None or not study.train.excitations:
        return []
    return [_figure("Orders over speed", partial(plot_orders, of), orders_inches(of), _said("orders", study))]


def _campbell_figures(study: TrainStudy) -> list[ReportFigure]:
    """Spectra over speed, where there are any."""
    of = study.campbell
    if of is None:
        return []
    diagram = picture_address(partial(plot_campbell, of, highest=float(of.frequency[-1])), "svg", _TALL)
    return [ReportFigure("Campbell diagram", diagram, _said("mesh_campbell", of))]


def _transient_figures(study: TrainStudy | ModalStudy) -> list[ReportFigure]:
    """Return the figures of a run with changing speed or torque; empty if there is none."""
    run, found = study.transient, []
    if run is not None and run.speed_changes and run.names[0]:
        over = partial(plot_transient_factors, study, run)
        found.append(_figure("Run with changing speed", over, factors_inches(run), _said("transient_factors", study, run)))
    if run is not None:
        draw = partial(plot_transient, run)
        found.append(_figure("Run over time", draw, transient_inches(run), _said("transient", run)))
    if run is not None and run.tracks is not None:
        tracks, natural = run.tracks, study.modes.frequency[study.modes.rigid :]
        spectrogram = partial(plot_spectrogram, tracks, natural)
        found.append(_figure("Spectrogram of the run", spectrogram, orders_inches(tracks), _said("spectrogram", tracks)))
        along = partial(plot_tracks, tracks, study.orders)
        found.append(_figure("Orders along the run", along, orders_inches(tracks), _said("tracks", study, tracks)))
    return found


def _figure(title: str, draw: Callable[[Figure], object], inches: tuple[float, float], caption: str) -> ReportFigure:
    return ReportFigure(title, figure_address(draw, "svg", inches), caption)
