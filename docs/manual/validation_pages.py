"""Directive of the manual: `{validation} CHAPTER` shows the rows of a chapter, `{validation} counts` how many there are."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from manual.validated import FILE, counts_text, table_text

__all__ = ["setup"]


class Validation(SphinxDirective):
    """`{validation} CHAPTER`, or `{validation} counts`."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        self.env.note_dependency(str(FILE))
        (chapter,) = self.arguments
        return list(self.parse_text_to_nodes(counts_text() if chapter == "counts" else table_text(chapter)))


def setup(app: Any) -> dict[str, bool]:
    app.add_directive("validation", Validation)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
