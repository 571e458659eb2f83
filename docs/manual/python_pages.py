"""What autodoc makes of our docstrings: fields of inputs as their schema says them, links by the names that users have."""

from __future__ import annotations

import re
from dataclasses import is_dataclass
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive
from sphinx.util.nodes import make_refnode

import gearcad
from gearcad.core.quantities import schema_of
from manual.field_words import fields_default, fields_permitted
from manual.table_pages import meaning, unit
from manual.tables import table, text

__all__ = ["setup"]

_NEITHER = re.compile(r"(?<!\\)([|*])")
"""What reStructuredText would read as markup, and our docstrings mean as it is."""


@cache
def _public() -> frozenset[str]:
    """The names that users import, from the entrance or from a room."""
    rooms = [getattr(gearcad, room) for room in gearcad.__dir__() if isinstance(getattr(gearcad, room), ModuleType)]
    return frozenset(gearcad.__all__).union(*(getattr(room, "__all__", ()) for room in rooms))


class Fields(Directive):
    """The fields of an input: its arguments."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        room, _, name = self.arguments[0].rpartition(".")
        rows = [
            (
                [nodes.literal(text=key)],
                meaning(field.symbol, key),
                text(unit(field.symbol.unit)),
                text(fields_permitted(key, field)),
                text(fields_default(field)),
            )
            for key, field in schema_of(getattr(import_module(room), name)).items()
        ]
        return [table("keys", ("Argument", "Meaning", "Unit", "Permitted", "Default"), rows)]


def _is_input(kind: object) -> bool:
    """Whether a type's fields say of themselves what they are."""
    if not (isinstance(kind, type) and is_dataclass(kind)):
        return False
    try:
        return any(field.symbol.words for field in schema_of(kind).values())
    except NameError:  # its annotations name what only type checkers import
        return False


def _docstring(_app: Any, what: str, name: str, found: object, _options: Any, lines: list[str]) -> None:
    """Let signs of formulas be signs, and the fields of an input stand below its docstring."""
    lines[:] = _marked(lines)
    if what == "class" and _is_input(found):
        lines += ["", f".. fields:: {found.__module__}.{found.__qualname__}", ""]  # type: ignore[attr-defined]


def _marked(lines: list[str]) -> list[str]:
    """Lines whose signs are signs; those that are set in, a table or a formula, stay as they are typed."""
    found: list[str] = []
    blank, typed = True, False
    for line in lines:
        set_in = line.startswith("  ")
        if blank and set_in and not typed:
            found += ["::", ""]
        typed = (typed and not line) or (set_in and (typed or blank))
        found.append(line if typed or line.startswith((">>>", "...")) else _escaped(line))
        blank = not line
    return found


def _escaped(line: str) -> str:
    """Outside of what stands between backquotes."""
    parts = line.split("`")
    return "`".join(part if odd % 2 else _NEITHER.sub(r"\\\1", part) for odd, part in enumerate(parts))


def _signature(_app: Any, what: str, _name: str, found: object, _options: Any, given: str | None, returned: str | None) -> Any:
    """That of an input is its table of fields."""
    return ("(**fields)", returned) if what == "class" and _is_input(found) else (given, returned)


def _link(_app: Any, env: Any, node: Any, content: nodes.Node) -> nodes.Node | None:
    """A type is called as it is documented, wherever it stands; one that is no public name of ours needs no link."""
    if node.get("refdomain") != "py":
        return None
    name = node["reftarget"].rpartition(".")[2]
    if name not in _public():
        return content.deepcopy()
    objects = env.get_domain("py").objects
    homes = {(entry.docname, entry.node_id) for full, entry in objects.items() if full.rpartition(".")[2] == name}
    if len(homes) != 1:
        return None
    ((page, target),) = homes
    return make_refnode(_app.builder, node["refdoc"], page, target, [content.deepcopy()])


def setup(app: Any) -> dict[str, bool]:
    app.add_directive("fields", Fields)
    app.connect("autodoc-process-docstring", _docstring)
    app.connect("autodoc-process-signature", _signature)
    app.connect("missing-reference", _link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
