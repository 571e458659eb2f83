"""The rating: safeties, permissible torque and life, with all factors; or what is to be given for one."""

from __future__ import annotations

from gearcad.designs.design import Design, DesignKind
from gearcad.errors import GearcadError, InputError
from gearcad.page.panels.figures import Figures, FiguresPanel, figures
from gearcad.page.panels.sheet_notices import keys_of, shown_notices
from gearcad.page.words import Words
from gearcad.sheet.strength import FACTORS, strength_sections, train_strength_sections

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

_VERDICTS = {True: "passed", False: "failed", None: ""}


class StrengthPanel(FiguresPanel):
    """What `gearcad rate` says of a design."""

    def __init__(self, words: Words) -> None:
        super().__init__(words["rating"], "gearcad-strength", words)

    def takes_long(self, design: Design) -> bool:
        """Of a planetary train: how planets share the load is asked of finite elements."""
        return _takes_long(design)

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
    from gearcad.rating.strength import StrengthRating

    options = getattr(design, "rating", None)
    if options is not None and options.face_load_factor == "fe":
        return _without(_ON_REQUEST, ["rating.face_load_factor"])
    try:
        found = Rate(report=False).run(design)
    except GearcadError as error:
        key = KEYS.get(error.parameter, error.parameter) if isinstance(error, InputError) else ""
        return _without(str(error), [key] if key in keys_of(design) else [])
    one = isinstance(found, StrengthRating)
    sections = strength_sections(found) if isinstance(found, StrengthRating) else train_strength_sections(found)
    told = {
        "": (f"{found.options.standard.value}, {found.options.accuracy.value}",),
        "assumed": found.assumed,
        "verify": found.verify,
    }
    return figures(
        sections,
        lines=tuple((label, "; ".join(each)) for label, each in told.items() if each),
        notices=shown_notices(found.notices, keys_of(design)),
        pins=_PINS if one else (),
        folded=("Safety", *FACTORS) if one else FACTORS,
        title=found.verdict,
        verdict=_VERDICTS[found.passed],
    )


def _without(line: str, keys: list[str]) -> Figures:
    return Figures((), {}, notices=({"text": line, "keys": keys},))
