"""The report of a rating: verdict, safeties, factors with their clauses, what flanks and roots bear, what was assumed."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from gearcad.geometry import GearPair
from gearcad.plots.pair import plot_sliding
from gearcad.plots.strength import plot_flash, plot_life
from gearcad.rating.strength import StrengthRating
from gearcad.report.check.figures import Picture, pair_picture, picture_address
from gearcad.report.check.tables import gear_rows, pair_rows
from gearcad.report.page import page_html
from gearcad.report.sentences import sentences
from gearcad.report.strength.tables import (
    backlash_rows,
    factor_groups,
    material_rows,
    option_rows,
    safety_rows,
    spectrum_rows,
    tolerance_rows,
    uncovered_tolerances,
)

__all__ = ["rate_html", "write_rate_report"]


def write_rate_report(rating: StrengthRating, design_name: str, path: Path) -> None:
    """Write the report of the rating of a design's pair to `path`; the same rating gives the same bytes."""
    path.write_text(rate_html(rating, design_name), encoding="utf-8")


def rate_html(rating: StrengthRating, design_name: str) -> str:
    """The report as one HTML document without links."""
    document = rating.to_dict()
    pair = rating.pair if isinstance(rating.pair, GearPair) else None
    return page_html(
        "rate.html",
        design_name,
        of=rating,
        names=list(rating.gear_names),
        pair_picture=None if pair is None else pair_picture(pair),
        safeties=safety_rows(rating, document),
        groups=factor_groups(rating, document),
        spectrum=spectrum_rows(rating),
        tolerances=tolerance_rows(document, rating.names),
        backlash=backlash_rows(document),
        uncovered=uncovered_tolerances(rating, document),
        options=option_rows(rating.options),
        gear_rows=[] if pair is None else gear_rows(pair),
        pair_rows=[] if pair is None else pair_rows(pair),
        materials=material_rows(rating.materials),
        figures=_figures(rating),
    )


def _figures(rating: StrengthRating) -> list[Picture]:
    """Specific sliding, what flanks and roots bear over load cycles, and temperatures along the path of contact."""
    sliding = picture_address(partial(plot_sliding, rating.pair), "svg")
    found = [
        Picture("Specific sliding along the path of contact", sliding, sentences("captions_rate.txt", "sliding", rating.pair)),
        *_lives(rating),
    ]
    if (scuffing := rating.scuffing) is not None and scuffing.flash is not None:
        address = picture_address(partial(plot_flash, scuffing), "svg")
        found.append(
            Picture("Temperature along the path of contact", address, sentences("captions_rate.txt", "flash", scuffing))
        )
    return found


def _lives(rating: StrengthRating) -> list[Picture]:
    """What flanks and roots bear over load cycles, where that is known."""
    return [
        Picture(
            f"What the {part.value}s bear",
            picture_address(partial(plot_life, rating, part), "svg"),
            sentences("captions_rate.txt", "life", rating, part),
        )
        for part, both in rating.parts.items()
        if any(each.resistance is not None for each in both)
    ]
