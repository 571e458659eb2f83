"""How the planets of a train share its load."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gearcad.designs.design import Design, DesignKind
from gearcad.errors import GearcadError
from gearcad.page.panels import Panel
from gearcad.page.words import Words

__all__ = ["SharesPanel", "shares_of"]


class SharesPanel(Panel[dict[str, Any] | None]):
    """A bar for each planet of a train, with what it carries least and most; nothing of other designs."""

    def __init__(self, words: Words) -> None:
        from gearcad.page.components.shares import SharesView  # only here: who finds shares elsewhere needs no NiceGUI

        self._shown = False
        self._view = SharesView(
            {
                "title": words["load shares of the planets"],
                "planet": words["Planet"],
                "factor": words["mesh load factor"],
            }
        )

    def aside(self, design: Design) -> Callable[[Design], dict[str, Any] | None] | None:
        return shares_of if design.kind is DesignKind.PLANETARY else None

    def find(self, design: Design) -> dict[str, Any] | None:
        return shares_of(design)

    def wait(self) -> None:
        self._view.wait()

    def show(self, found: dict[str, Any] | None) -> None:
        if found is not None or self._shown:
            self._view.show(found)
        self._shown = found is not None


def shares_of(design: Design) -> dict[str, Any] | None:
    """Shares of all planets, 1 where all carry alike, and K_gamma, or why there are none. None for what has no planets."""
    if design.kind is not DesignKind.PLANETARY:
        return None
    from gearcad.page.panels.train_study import train_study

    try:
        study = train_study(design)
    except GearcadError as error:
        return {"shares": [], "why_not": str(error)}
    if study.sharing is None:
        return {"shares": [], "why_not": study.why_not.get("sharing", "")}
    found = study.sharing.to_dict()
    shares = zip(found["least_shares"], found["shares"], found["greatest_shares"], strict=True)
    return {"shares": [[float(each) for each in three] for three in shares], "factor": float(found["mesh_load_factor"])}
