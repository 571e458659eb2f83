"""Directives of the manual: `{keys} TABLE` shows the keys of a table, `{results} NAME` the quantities of a result."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive

from gearcad.core.symbols import Symbol
from manual.field_words import clause, default, permitted
from manual.key_tables import key_tables
from manual.result_tables import result_tables
from manual.tables import Cell, table, text

__all__ = ["meaning", "setup", "unit"]


class Keys(Directive):
    """A table of keys, each with a target `key-TABLE-KEY` that links can name."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        if name not in key_tables():
            raise self.error(f"no table of keys is called {name}")
        rows = [
            (
                [nodes.literal(text=key)],
                [*meaning(field.symbol, key), *_source(field.symbol)],
                text(unit(field.symbol.unit)),
                text(permitted(key, field)),
                text(default(name, key, field)),
            )
            for key, field in key_tables()[name].items()
        ]
        ids = [f"key-{name}-{key}".replace(".", "-").replace("_", "-") for key in key_tables()[name]]
        return [table("keys", ("Key", "Meaning", "Unit", "Permitted", "Default"), rows, ids)]


class Results(Directive):
    """A table of quantities, each with a target `result-NAME-KEY`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        name = self.arguments[0]
        if name not in result_tables():
            raise self.error(f"no table of results is called {name}")
        quantities = result_tables()[name]
        rows = [
            ([nodes.literal(text=key)], meaning(symbol, key), text(unit(symbol.unit)), text(clause(symbol.source)))
            for key, symbol in quantities.items()
        ]
        ids = [re.sub(r"[^a-z0-9]+", "-", f"result-{name}-{key}".lower()) for key in quantities]
        return [table("results", ("Key", "Meaning", "Unit", "Source"), rows, ids)]


def unit(name: str) -> str:
    """A unit as one writes it."""
    return "°" if name == "deg" else name


def meaning(symbol: Symbol, key: str) -> Cell:
    """Words, and the symbol with its index below the line."""
    words = symbol.words or key.rpartition(".")[2].replace("_", " ")
    return [*text(words), *([nodes.Text(", "), *_symbol(symbol.symbol)] if symbol.symbol else [])]


def _source(symbol: Symbol) -> Cell:
    return [nodes.inline(text=f" ({clause(symbol.source)})", classes=["source"])] if symbol.source else []


_INDEX = re.compile(r"_([^\s/*()]+)(\*?)")


def _symbol(symbol: str) -> Cell:
    """`h_aP*` with its index below the line and the star above it."""
    found: Cell = []
    end = 0
    for index in _INDEX.finditer(symbol):
        found += [nodes.emphasis(text=symbol[end : index.start()]), nodes.subscript(text=index[1])]
        found += [nodes.superscript(text="*")] if index[2] else []
        end = index.end()
    return [*found, nodes.emphasis(text=symbol[end:])] if symbol[end:] else found


_FROM_CODE = ("keys", "results", "commands/", "api/")
"""Pages that follow from the code, beginnings of their names: they are read anew in every build."""


def _outdated(_app: Any, env: Any, *_changes: Any) -> list[str]:
    return [page for page in env.found_docs if page.startswith(_FROM_CODE)]


def setup(app: Any) -> dict[str, bool]:
    app.connect("env-get-outdated", _outdated)
    app.add_directive("keys", Keys)
    app.add_directive("results", Results)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
