"""What of the bar is the browser's own: light or dark, and the keys of the page."""

from __future__ import annotations

from nicegui.element import Element

from gearcad.page.words import Words

__all__ = ["BarView"]


class BarView(Element, component="gear_bar.js"):
    """Follows the system until somebody chooses; the browser remembers that."""

    def __init__(self, words: Words) -> None:
        super().__init__()
        self._props["keys"] = list(_keys(words).items())
        self._props["words"] = {"dark": words["light or dark"], "keys": words["keys"], "close": words["close"]}


def _keys(words: Words) -> dict[str, str]:
    """What each does."""
    return {
        "/": words["find a key"],
        "Enter": words["next field, with Shift the one before; on a row of data: put on top"],
        "↑ ↓": words["step a number, with Shift by ten; walk rows of data"],
        "Esc": words["leave a field or a menu; Tab then leaves the text, too"],
        "Ctrl+Z": words["undo"],
        "Ctrl+Y": words["redo"],
        "Tab": words["from part to part of the page"],
        "?": words["these keys"],
    }
