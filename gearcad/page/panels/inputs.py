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

    def __init__(self, changed: Callable[[str, str, int], None], step: Callable[[bool], None], words: Words) -> None:
        self._words = words
        own = {
            "inputs": words["inputs of the spec"],
            "search": words["find a key"],
            "nothing": words["no key has these words"],
            "textOnly": words["This kind of spec is edited as text."],
            "out": words["leave out of the spec"],
            "shared": words["as in"],
        }
        self._view = InputsView(changed, step, own)
        self._layout: Any = None
        self._keys: frozenset[str] = frozenset()

    def follow(self, bench: Workbench, reveal: bool = False) -> None:
        """Show what the text says, what the last good design uses where it says nothing, and what is wrong.

        With `reveal` what has changed comes into sight: it was not typed here.
        """
        layout = (bench.design.kind, *bench.design.gears, *bench.tables)
        if layout != self._layout:
            self._layout = layout
            self._have(fields_of(bench.design, bench.tables))
        fault = None if bench.fault is None else bench.fault._asdict() | {"said": self._words.said(bench.fault.line)}
        given, former = given_texts(bench.tables), given_texts(bench.former)
        used = {key: text for key, text in used_texts(bench.design, bench.tables).items() if key in self._keys}
        changed = sorted(key for key in given.keys() | former.keys() if given.get(key) != former.get(key))
        self._view.show({"given": given, "used": used, "fault": fault, "changed": changed, "reveal": reveal})

    def _have(self, tables: list[dict[str, Any]]) -> None:
        """Make the fields, in the language of the page."""
        words = self._words
        self._keys = frozenset(field["key"] for table in tables for group in table["groups"] for field in group["fields"])
        for table in tables:
            table["title"] = words[table["title"]]
            for group in table["groups"]:
                group["title"] = ": ".join(words[title] for title in group.pop("titles"))
                for field in group["fields"]:
                    field["words"] = words.divided(words[field["words"]])
        self._view.have(tables)
