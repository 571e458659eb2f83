"""The inputs of the spec: they show what it says and what follows, and take what is typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gearcad.page.components.inputs import InputsView
from gearcad.page.fields import fields_of, given_texts, used_texts
from gearcad.page.words import Words
from gearcad.page.workbench import Workbench

__all__ = ["InputsPanel"]


class InputsPanel:
    """Follows the workbench itself, not the last good design: what is wrong must be seen where it was typed."""

    def __init__(self, changed: Callable[[str, str], None], words: Words) -> None:
        self._view = InputsView(changed, {"search": words["find a key"]}, dict(words.table))
        self._layout: Any = None

    def follow(self, bench: Workbench) -> None:
        """Show what the text says, what the last good design uses where it says nothing, and what is wrong."""
        layout = (bench.design.kind, *bench.design.gears)
        if layout != self._layout:
            self._layout = layout
            self._view.have(fields_of(bench.design))
        fault = None if bench.fault is None else {"key": bench.fault.key, "line": bench.fault.line}
        given, former, used = given_texts(bench.tables), given_texts(bench.former), used_texts(bench.design)
        changed = sorted(key for key in given.keys() | former.keys() if given.get(key) != former.get(key))
        self._view.show({"given": given, "used": used, "fault": fault, "changed": changed})
