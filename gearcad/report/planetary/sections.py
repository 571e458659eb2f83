"""What sections of the report are made of, and those of how a train is built and what acts in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from gearcad.plots.planetary.front import front_inches, plot_front
from gearcad.plots.planetary.ladder import plot_ladder
from gearcad.plots.planetary.phases import phases_inches, plot_phases
from gearcad.plots.planetary.scheme import plot_scheme, scheme_inches
from gearcad.report.check.figures import Picture, figure_address
from gearcad.report.check.tables import Row
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.build import assembly_rows, gear_table, mesh_table
from gearcad.report.planetary.loads import force_table, harmonic_table, phase_table, pin_rows, power_rows, speed_table
from gearcad.report.sentences import sentences

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["Section", "Table", "figure", "said", "sections_of_build", "sections_of_load"]


class Table(NamedTuple):
    """A table with a title and a note: of quantities in `rows`, or any `grid`.

    `symbols`: an underscore in a head begins an index; else it is that of a name.
    """

    title: str
    rows: list[Row] | None = None
    grid: WordTable | None = None
    note: str = ""
    symbols: bool = False


class Section(NamedTuple):
    """Sentences, tables and figures under one title."""

    title: str
    words: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
    figures: tuple[Picture, ...] = ()


def said(macro: str, *values: object) -> str:
    """What a macro of the captions says."""
    return sentences("captions_planetary.txt", macro, *values)


def figure(title: str, draw: Callable[[Figure], object], inches: tuple[float, float], caption: str) -> Picture:
    """A picture with its caption."""
    return Picture(title, figure_address(draw, "svg", inches), caption)


def on_axes(draw: Callable[..., object]) -> Callable[[Figure], object]:
    """What draws on axes, for one that has a whole figure."""
    return lambda of: draw(ax=of.subplots())


def sections_of_build(study: PlanetaryStudy) -> Iterator[Section]:
    """Scheme, gears, assembly."""
    train, flow = study.train, study.flow
    draw = on_axes(partial(plot_scheme, train, flow=flow))
    scheme = figure("Scheme", draw, scheme_inches(train, flow), said("scheme", train, flow))
    yield Section("Scheme", figures=(scheme,))
    speeds = study.speeds
    turning = {} if speeds is None else {**speeds.members, "planet": speeds.planet}
    front = partial(plot_front, train, study.pose, turning)
    yield Section(
        "Gears",
        tables=(
            Table("", grid=gear_table(train), note=said("gear_note"), symbols=True),
            Table("Meshes", grid=mesh_table(train), note=said("mesh_note"), symbols=True),
        ),
        figures=(figure("In mesh", front, front_inches(train), said("front", train, turning)),),
    )
    yield Section("Assembly", words=(said("assembly", train),), tables=(Table("", rows=assembly_rows(train)),))


def sections_of_load(study: PlanetaryStudy) -> Iterator[Section]:
    """Speeds and torques, power, phases, forces: those that are known."""
    train, speeds, flow = study.train, study.speeds, study.flow
    if speeds is not None:
        lever = figure(
            "Lever of the speeds",
            on_axes(partial(plot_ladder, train, speeds.members, speeds.planet, "rpm")),
            (6.6, 3.7),
            said("ladder", train),
        )
        yield Section(
            "Speeds and torques",
            tables=(Table("", grid=speed_table(train, speeds, flow, "rpm"), note=said("speed_note", train, flow)),),
            figures=(lever,) if study.turning is not None else (),
        )
    if flow is not None:
        yield Section("Power", words=(said("power", train, flow),), tables=(Table("", rows=power_rows(train, flow)),))
    yield _phases(study)
    if study.forces is not None:
        yield Section(
            "Forces",
            words=(said("forces", train),),
            tables=(Table("Meshes", grid=force_table(study.forces)), Table("One pin", rows=pin_rows(study.forces))),
        )


def _phases(study: PlanetaryStudy) -> Section:
    train, phases, stiffness = study.train, study.phases, study.stiffness
    words = tuple(said("phase_words", name, each.relative) for name, each in phases.items())
    picture = figure(
        "Phases",
        partial(plot_phases, train, phases, stiffness),
        phases_inches(train, stiffness),
        said("phases", train, stiffness),
    )
    table = Table("", grid=phase_table(train, phases), note=said("phase_note"))
    sums = Table("What their harmonics do", grid=harmonic_table(train, phases), note=said("harmonic_sum_note"))
    return Section("Phases of the meshes", tuple(filter(None, words)), (table, sums), (picture,))
