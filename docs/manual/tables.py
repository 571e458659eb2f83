"""Tables of the manual as Sphinx has them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from docutils import nodes

__all__ = ["Cell", "table", "text"]

Cell = list[nodes.Node]


def text(words: str) -> Cell:
    """Words with what is between backquotes as it is typed."""
    return [nodes.literal(text=part) if odd % 2 else nodes.Text(part) for odd, part in enumerate(words.split("`")) if part]


def table(kind: str, heads: Sequence[str], rows: Sequence[tuple[Cell, ...]], ids: Iterable[str] = ()) -> nodes.table:
    """A table of a kind that style sheets know, its rows with targets that links can name."""
    group = nodes.tgroup(cols=len(heads))
    group += [nodes.colspec(colwidth=1) for _ in heads]
    head, body = nodes.thead(), nodes.tbody()
    head += _row([text(each) for each in heads])
    body += [_row(cells) for cells in rows]
    for row, target in zip(body.children, ids, strict=False):
        row["ids"].append(target)
    group += [head, body]
    found = nodes.table(classes=[kind])
    found += group
    return found


def _row(cells: Iterable[Cell]) -> nodes.row:
    row = nodes.row()
    row += [nodes.entry("", nodes.paragraph("", "", *cell)) for cell in cells]
    return row
