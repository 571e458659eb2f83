"""The rating: safeties, permissible torque and life, with all factors; or what is to be given for one."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from gearcad.designs.design import Design, DesignKind
from gearcad.designs.kinds.planetary import PlanetaryDesign
from gearcad.errors import GearcadError, InputError
from gearcad.page.panels.figures import Figures, FiguresPanel, figures
from gearcad.page.panels.sheet_notices import keys_of, shown_notices
from gearcad.page.words import Words
from gearcad.sheet.strength import FACTORS, strength_sections, train_strength_sections

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.strength import TrainStrength
    from gearcad.rating.strength import StrengthRating

__all__ = ["StrengthPanel", "strength_figures", "warm_up"]

_PINNED = (
    "safety.flank safety.root safety.scuffing.integral safety.scuffing.flash"
    " permissible_torque.flank permissible_torque.root life.flank life.root"
)
"""What one looks at first."""

_PINS = [f"strength.{key}" for key in _PINNED.split()]

_ON_REQUEST = (
    'face_load_factor = "fe": K_Hbeta is that of the load distribution of solid bodies, which takes its time: run "rate" for it'
)

_NO_RATING = "This kind of design has no rating."

_VERDICTS = {True: "passed", False: "failed", None: ""}


class StrengthPanel(FiguresPanel):
    """What `gearcad rate` says of a design."""

    def __init__(self, words: Words) -> None:
        super().__init__(words["rating"], "gearcad-strength", words)

    def aside(self, design: Design) -> Callable[[Design], Figures] | None:
        """Of a planetary train: how planets share the load is asked of finite elements."""
        return strength_figures if _takes_long(design) else None

    def find(self, design: Design) -> Figures:
        return strength_figures(design)


def warm_up(design: Design) -> None:
    """Import what ratings need, and rate a design once if that is quick: nobody shall wait for it later."""
    import gearcad.jobs.rate  # noqa: F401

    if not _takes_long(design):
        strength_figures(design)


def _takes_long(design: Design) -> bool:
    return design.kind is DesignKind.PLANETARY


def strength_figures(design: Design) -> Figures:
    """Those of the rating of a design; without one a line that says why, or what to give."""
    from gearcad.jobs.rate import KEYS, Rate

    if design.kind not in Rate.accepts:
        return Figures((), {}, lines=(("", _NO_RATING),))
    options = getattr(design, "rating", None)
    if options is not None and options.face_load_factor == "fe":
        return _without(_ON_REQUEST, ["rating.face_load_factor"])
    try:
        return _rated(_rating(design), design)
    except GearcadError as error:
        key = KEYS.get(error.parameter, error.parameter) if isinstance(error, InputError) else ""
        return _without(str(error), [key] if key in keys_of(design) else [])


def _rating(design: Design) -> StrengthRating | TrainStrength:
    """That of a train is read from its study, which the load shares are of too."""
    from gearcad.jobs.rate import Rate, strength_in_study

    if isinstance(design, PlanetaryDesign):
        from gearcad.page.panels.train_study import train_study

        return strength_in_study(design, train_study(design))
    return Rate(report=False).run(design)


def _rated(found: StrengthRating | TrainStrength, design: Design) -> Figures:
    """What a rating comes to; of a train of all its meshes."""
    from gearcad.dynamics.planetary.strength import TrainStrength

    train = isinstance(found, TrainStrength)
    standards = f"{found.options.standard.value}, {found.options.accuracy.value}"
    told = {"": (standards,), "assumed": found.assumed, "verify": found.verify}
    return figures(
        train_strength_sections(found) if isinstance(found, TrainStrength) else strength_sections(found),
        lines=tuple((label, "; ".join(each)) for label, each in told.items() if each),
        notices=shown_notices(found.notices, keys_of(design)),
        pins=() if train else _PINS,
        folded=FACTORS if train else ("Safety", *FACTORS),
        title=found.verdict,
        verdict=_VERDICTS[found.passed],
    )


def _without(line: str, keys: list[str]) -> Figures:
    return Figures((), {}, notices=({"text": line, "keys": keys},))
