"""The report of a planetary train: what its study holds, section by section, and what it could not find out."""

from __future__ import annotations

from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING

from gearcad.notice import texts
from gearcad.report.page import page_html
from gearcad.report.planetary.bending import sections_of_bending
from gearcad.report.planetary.rating import section_of_rating
from gearcad.report.planetary.sections import said, sections_of_build, sections_of_load
from gearcad.report.planetary.strength import section_of_strength
from gearcad.report.planetary.vibration import sections_of_vibration

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["planetary_html", "write_planetary_report"]

_MISSING = "not-computed"
"""Code of the notices of parts that could not be had: they have a section of their own."""


def write_planetary_report(study: PlanetaryStudy, name: str, path: Path) -> None:
    """Write the report of a study of the design `name` to `path`; the same study gives the same bytes."""
    path.write_text(planetary_html(study, name), encoding="utf-8")


def planetary_html(study: PlanetaryStudy, name: str) -> str:
    """The report as one HTML document without links."""
    parts = (sections_of_build, sections_of_load, sections_of_bending, sections_of_vibration)
    sections = list(chain.from_iterable(part(study) for part in parts))
    if study.rating is not None:
        sections += [section_of_rating(study.train, study.rating), section_of_strength(study.rating.strength)]
    figures = [figure.title for section in sections for figure in section.figures]
    return page_html(
        "planetary.html",
        name,
        of=study,
        train=study.train,
        methods=_methods(study),
        editions=_editions(study),
        words=said("train", study.train),
        sections=sections,
        numbers=dict(zip(figures, count(1), strict=False)),
        why_not=_missing(study),
        warnings=texts(notice for notice in study.notices if notice.code != _MISSING),
    )


def _methods(study: PlanetaryStudy) -> list[str]:
    """How the stiffness of the meshes was found."""
    return list(dict.fromkeys(each.cycle.method for each in (study.stiffness or {}).values()))


def _editions(study: PlanetaryStudy) -> list[str]:
    """The standards by which meshes were rated."""
    meshes = () if study.rating is None else study.rating.meshes.values()
    return list(dict.fromkeys(each.rating.edition.value for each in meshes))


def _missing(study: PlanetaryStudy) -> list[tuple[str, str]]:
    """What could not be computed, and why: together what has the same reason."""
    return [(notice.where.removeprefix("no "), notice.text) for notice in study.notices if notice.code == _MISSING]
