"""Report of the wear of a pair."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path

from gearcad.check.wear import WearResult
from gearcad.core.records import Role
from gearcad.plots.paper import short
from gearcad.plots.wear import plot_worn_error, plot_worn_profile, plot_worn_roots, plot_worn_share
from gearcad.report.document import ReportFigure, gear_rows, load_rows, page_html, pair_picture, pair_rows, picture_address


def write_wear_report(result: WearResult, path: Path, head: Mapping[str, str] | None = None) -> None:
    """Write the report to `path`; the same result gives the same bytes."""
    path.write_text(wear_html(result, head), encoding="utf-8", newline="\n")


def wear_html(result: WearResult, head: Mapping[str, str] | None = None) -> str:
    """The report as one HTML document without links."""
    task = result.task
    return page_html(
        "wear.html",
        result.name,
        head,
        of=result,
        names=[role.value for role in Role],
        worn=[role.value for role in _worn(result)],
        pair_picture=pair_picture(task.pair),
        rows=_rows(result),
        figures=_figures(result),
        asked=None if result.asked_cycles is None else result.depth_at(result.asked_cycles),
        gear_rows=gear_rows(task.gear_pair),
        pair_rows=pair_rows(task.gear_pair),
        load_rows=load_rows(task.material, task.load, task.mounting),
    )


def _rows(result: WearResult) -> list[tuple[str, ...]]:
    """Return each state: load cycles; depth, mean depth, volume of the gears that wear; transmission error, ratio, roots."""
    found, worn = [], _worn(result)
    for state in result.states:
        both = [each.pick(role) for each in (state.depth, state.mean_depth, state.volume) for role in worn]
        found.append(
            tuple(map(short, (state.cycles, *both, state.transmission_error, state.contact_ratio, *state.root_stresses)))
        )
    return found


def _worn(result: WearResult) -> list[Role]:
    """Return the gears that wear."""
    return [role for role, coefficient in result.coefficients.items() if coefficient]


def _figures(result: WearResult) -> list[ReportFigure]:
    """Profiles of the gears that wear, load share, transmission error and root stress."""
    found = [
        ReportFigure(
            f"What the flank of the {role.value} has lost",
            picture_address(partial(plot_worn_profile, result, role), "svg"),
            "Depth along the normal of the involute. Flanks slide least near the pitch point: there the least is lost.",
        )
        for role in _worn(result)
    ]
    for title, draw, caption in (
        ("Load share of a pair of teeth", plot_worn_share, "Wear takes most where load and sliding are great together."),
        ("Transmission error", plot_worn_error, "Along the line of action, over one base pitch, without its beginning at 0."),
        ("Root stress of the worn pair", plot_worn_roots, "The greatest of the mesh cycle; teeth count as stiff as new ones."),
    ):
        found.append(ReportFigure(title, picture_address(partial(draw, result), "svg"), caption))
    return found
