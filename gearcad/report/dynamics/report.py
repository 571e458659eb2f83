"""The report of a study of dynamics: of a train, of a pair as a mesh of varying stiffness, or as springs between its teeth."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad.dynamics.levels.result import LevelStudy
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.side_by_side import SideBySide
from gearcad.dynamics.train_result import ModalStudy, TrainStudy
from gearcad.dynamics.trains.eigenmodes import NaturalModes
from gearcad.plots.campbell import plot_campbell
from gearcad.plots.history import MOTION_INCHES, plot_angles, plot_motion, plot_spectrum
from gearcad.plots.speeds import (
    course_inches,
    plot_course,
    plot_cycle,
    plot_factors,
    plot_shaft_overload,
)
from gearcad.plots.tooth_errors import plot_tooth_errors
from gearcad.plots.trains import MOST_SHAPES, energies_inches, plot_energies, plot_shapes, shapes_inches
from gearcad.plots.transient import factors_inches, plot_transient, plot_transient_factors, transient_inches
from gearcad.report.check.figures import Picture, figure_address, pair_picture, picture_address
from gearcad.report.check.tables import gear_rows, pair_rows
from gearcad.report.dynamics.displacements import (
    bearing_figures,
    bearing_mode_table,
    bearing_table,
    displacement_figures,
    displacement_table,
)
from gearcad.report.dynamics.levels import deciding_table, level_resonance_table, unjudged_table, verdict_table
from gearcad.report.dynamics.rows import contact_rows, pair_dynamics_rows
from gearcad.report.dynamics.side_by_side import (
    beside_figures,
    frequency_table,
    greatest_table,
    overload_table,
    resonance_table,
)
from gearcad.report.dynamics.tables import (
    MOST_PEAKS,
    WordTable,
    component_table,
    inertia_table,
    mesh_table,
    mode_table,
    pair_table,
    peak_table,
    shaft_table,
    shape_table,
    speed_table,
)
from gearcad.report.dynamics.tooth_errors import error_table
from gearcad.report.page import page_html
from gearcad.report.sentences import sentences

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["dynamics_html", "write_dynamics_report"]

_GEAR = "teeth normal_module helix_angle profile_shift face_width reference_diameter base_diameter tip_diameter body.bore"

_WIDE = (6.6, 4.4)
_TALL = (6.6, 5.2)
"""Sizes (inches): with a second axis above, and of two pictures on each other."""


def write_dynamics_report(
    study: TrainStudy | ModalStudy | SideBySide | PairStudy | ContactStudy, name: str, path: Path
) -> None:
    """Write the report of a study of the design `name` to `path`; the same study gives the same bytes."""
    path.write_text(dynamics_html(study, name), encoding="utf-8")


@singledispatch
def dynamics_html(study: object, name: str) -> str:
    """The report of a study as one HTML document without links."""
    raise TypeError(f"a {type(study).__name__} of {name} has no report of dynamics")


@dynamics_html.register
def _modes_html(study: ModalStudy, name: str) -> str:
    return page_html(
        "dynamics_modes.html",
        name,
        of=study,
        parts=[inertia_table(study), *([shaft_table(study)] if study.train.shafts else [])],
        modes=mode_table(study.modes),
        **_shapes(study.modes),
        shape_figures=_shape_figures(study),
        warnings=study.warnings,
    )


def _shapes(modes: NaturalModes) -> dict[str, WordTable | None]:
    """Tables of shapes: of the natural modes, and of the components of which the model is made."""
    components = modes.component_modes
    return {"shapes": shape_table(modes), "components": None if components is None else component_table(components)}


def _shape_figures(study: TrainStudy | ModalStudy) -> list[Picture]:
    train, modes = study.train, study.modes
    shapes, energies = partial(plot_shapes, train, modes), partial(plot_energies, modes)
    return [
        _figure("Natural modes", shapes, shapes_inches(train, modes), _said("shapes", study, MOST_SHAPES)),
        _figure("Energy of the modes", energies, energies_inches(modes), _said("energies", study)),
    ]


@dynamics_html.register
def _train_html(study: TrainStudy, name: str) -> str:
    return page_html(
        "dynamics_train.html",
        name,
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
    """What the train is made of."""
    shafts = [shaft_table(study)] if study.train.shafts else []
    return [inertia_table(study), *shafts, mesh_table(study), *([pair_table(study)] if study.pairs else [])]


def _pair_figures(study: TrainStudy) -> list[Picture]:
    """The stiffness of each pair over one base pitch."""
    courses = {name: mesh.course for name, mesh in study.pairs.items()}
    return [
        Picture(
            f"Mesh stiffness of {name}", picture_address(partial(plot_cycle, course.cycle), "svg"), _said("pair_course", course)
        )
        for name, course in courses.items()
    ]


@dynamics_html.register
def _side_by_side_html(study: SideBySide, name: str) -> str:
    return page_html("dynamics_side_by_side.html", name, **_beside(study))


@dynamics_html.register
def _levels_html(study: LevelStudy, name: str) -> str:
    first = study.studies[study.reference]
    return page_html(
        "dynamics_levels.html",
        name,
        **_beside(study),
        verdicts=verdict_table(study),
        level_resonances=level_resonance_table(study),
        deciding=deciding_table(study),
        unjudged=unjudged_table(study),
        modes=mode_table(first.modes),
        shape_figures=_shape_figures(first),
    )


def _beside(study: SideBySide) -> dict[str, Any]:
    """What both pages of several studies show."""
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
def _pair_html(study: PairStudy, name: str) -> str:
    of = study.study
    curve = picture_address(partial(plot_cycle, study.cycle), "svg")
    return page_html(
        "dynamics_pair.html",
        name,
        of=of,
        on_bearings=study.bearings is not None,
        greatest=_said("greatest", of),
        pair_picture=pair_picture(study.pair),
        gear_rows=gear_rows(study.pair, _GEAR),
        pair_rows=pair_rows(study.pair),
        rows=pair_dynamics_rows(study),
        curve=Picture("Mesh stiffness", curve, _said("cycle", study)),
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
def _contact_html(study: ContactStudy, name: str) -> str:
    highest, history = study.study.frequency[-1] / 2, study.history
    diagram = picture_address(partial(plot_campbell, study.study, highest=highest), "svg", _TALL)
    spectrum = picture_address(partial(plot_spectrum, history, highest=highest), "svg")
    return page_html(
        "dynamics_contact.html",
        name,
        of=study,
        pair_picture=pair_picture(study.pair),
        gear_rows=gear_rows(study.pair, _GEAR),
        pair_rows=pair_rows(study.pair),
        rows=contact_rows(study),
        speeds=speed_table(study.study),
        figures=[
            Picture("Campbell diagram", diagram, _said("campbell", study)),
            _figure("Speeds over time", partial(plot_motion, history), MOTION_INCHES, _said("motion", study)),
            _figure("Angles over time", partial(plot_angles, history), MOTION_INCHES, _said("angles", study)),
            Picture("Spectrum at one speed", spectrum, _said("spectrum", study)),
        ],
        warnings=study.warnings,
    )


def _speed_figures(study: TrainStudy) -> list[Picture]:
    """Over speed and at one speed; none that would show nothing."""
    chart = picture_address(partial(plot_factors, study), "svg", _WIDE)
    found = [Picture("Dynamic factor over speed", chart, _said("factors", study))]
    if study.up.referred_shafts:
        address = picture_address(partial(plot_shaft_overload, study), "svg", _WIDE)
        found.append(Picture("Overload of the shafts over speed", address, _said("shaft_overload", study)))
    if study.errors is not None:
        address = picture_address(partial(plot_tooth_errors, study), "svg", _WIDE)
        found.append(Picture("Dynamic factor with tooth errors", address, _said("tooth_errors", study)))
    found.append(_figure("Course at one speed", partial(plot_course, study), course_inches(study), _said("course", study)))
    return found + _transient_figures(study) + _campbell_figures(study)


def _campbell_figures(study: TrainStudy) -> list[Picture]:
    """Spectra over speed, where there are any."""
    of = study.campbell
    if of is None:
        return []
    diagram = picture_address(partial(plot_campbell, of, highest=float(of.frequency[-1])), "svg", _TALL)
    return [Picture("Campbell diagram", diagram, _said("mesh_campbell", of))]


def _transient_figures(study: TrainStudy) -> list[Picture]:
    """Of a run with changing speed or torque, where there is one."""
    run, found = study.transient, []
    if run is not None and run.speed_changes:
        over = partial(plot_transient_factors, study, run)
        found.append(_figure("Run with changing speed", over, factors_inches(run), _said("transient_factors", study, run)))
    if run is not None:
        draw = partial(plot_transient, run)
        found.append(_figure("Run over time", draw, transient_inches(run), _said("transient", run)))
    return found


def _figure(title: str, draw: Callable[[Figure], object], inches: tuple[float, float], caption: str) -> Picture:
    return Picture(title, figure_address(draw, "svg", inches), caption)


def _said(macro: str, *values: object) -> str:
    return sentences("captions_dynamics.txt", macro, *values)
