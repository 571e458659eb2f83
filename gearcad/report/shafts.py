"""Report of shafts: diagrams along each shaft, reactions and lives of bearings, the load over the face."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from gearcad.plots.paper import short
from gearcad.plots.shafts import SHAFT_INCHES, plot_gaps_on_shafts, plot_load_on_shafts, plot_shaft
from gearcad.report.document import ReportFigure, figure_address, page_html, picture_address, sentences
from gearcad.shafts.arrangement import ArrangementResult, ShaftResult

_NONE = "–"  # an en dash where there is no value

_LONGEST = 1e6
"""Hours above which a life is told as more than that."""


class ReportedShaft(NamedTuple):
    """A shaft in the report: its figures in words, rows of its bearings and of its segments, speeds, its picture."""

    name: str
    result: ShaftResult
    bearings: list[tuple[str, ...]]
    segments: list[tuple[str, ...]]
    shoulders: list[tuple[str, str, str, str]]
    speeds: list[tuple[str, ...]]
    figure: ReportFigure


def write_shafts_report(result: ArrangementResult, design_name: str, path: Path, head: Mapping[str, str] | None = None) -> None:
    """Write the report of a design's shafts to `path`; the same result gives the same bytes."""
    path.write_text(shafts_html(result, design_name, head), encoding="utf-8", newline="\n")


def shafts_html(result: ArrangementResult, design_name: str, head: Mapping[str, str] | None = None) -> str:
    """Return the report as one HTML document without links."""
    shafts = [_reported(name, shaft) for name, shaft in result.shafts.items()]
    return page_html(
        "shafts.html",
        design_name,
        head,
        of=result,
        shafts=shafts,
        mesh=result.mesh,
        figures=[*(each.figure for each in shafts), *_mesh_figures(result)],
        warnings=[notice.text for notice in result.notices],
        unconfirmed=result.unconfirmed,
    )


def _reported(name: str, shaft: ShaftResult) -> ReportedShaft:
    lives = shaft.lives
    bearings = [
        (
            life.name,
            short(bearing.position),
            *(_signed(each) for each in reaction[:3].tolist()),
            _text(None if life.equivalent is None else life.equivalent.load),
            _hours(life.hours),
            _hours(life.modified_hours),
        )
        for bearing, life, reaction in zip(shaft.state.shaft.bearings, lives, shaft.state.reactions, strict=True)
    ]
    segments = [
        tuple(map(short, (start, each.length, each.outer_diameter, each.inner_diameter)))
        for start, each in zip(shaft.state.shaft.ends, shaft.state.shaft.segments, strict=False)
    ]
    shoulders = [(short(each.position), _text(each.fatigue), _text(each.static), each.reason or "") for each in shaft.shoulders]
    frequencies = shaft.speeds["natural_frequencies"]
    speeds = [
        ("critical speed, forward whirl", "rpm", *map(short, shaft.speeds["critical_speeds"])),
        ("critical speed, backward whirl", "rpm", *map(short, shaft.speeds["critical_speeds_backward"])),
        ("natural frequency, forward whirl", "Hz", *map(short, frequencies["forward"])),
        ("natural frequency, backward whirl", "Hz", *map(short, frequencies["backward"])),
    ]
    address = figure_address(partial(plot_shaft, shaft.state), "svg", SHAFT_INCHES)
    figure = ReportFigure(f"The shaft {name} under load", address, sentences("captions_shafts.txt", "shaft", shaft))
    return ReportedShaft(name, shaft, bearings, segments, shoulders, speeds, figure)


def _mesh_figures(result: ArrangementResult) -> list[ReportFigure]:
    mesh = result.mesh
    if mesh is None:
        return []
    found = [
        ReportFigure(
            "Load over the face",
            picture_address(partial(plot_load_on_shafts, mesh), "svg"),
            sentences("captions_shafts.txt", "load", mesh),
        )
    ]
    if mesh["gap_at_even_load_at_slices"]:
        address = picture_address(partial(plot_gaps_on_shafts, mesh), "svg")
        found.append(ReportFigure("Gap of the shafts", address, sentences("captions_shafts.txt", "gap", mesh)))
    return found


def _signed(value: float) -> str:
    return "0" if abs(value) < _ROUNDING else f"{value:.5g}"


_ROUNDING = 1e-6
"""Force (N) below which a reaction is rounding."""


def _text(value: float | None) -> str:
    return _NONE if value is None else short(value)


def _hours(value: float | None) -> str:
    return _NONE if value is None else f"> {short(_LONGEST)}" if value > _LONGEST else short(value)
