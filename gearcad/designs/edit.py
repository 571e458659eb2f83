"""A spec with other values: its own text, with comments and layout kept (by tomlkit)."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from gearcad.designs.keys import Cell
from gearcad.errors import SpecError

if TYPE_CHECKING:
    from tomlkit import TOMLDocument
    from tomlkit.container import Container
    from tomlkit.items import AbstractTable, Item

__all__ = ["edit_spec"]


def edit_spec(text: str, values: Mapping[str, Cell | None], notes: Mapping[str, str] | None = None) -> str:
    """The text of a spec with values under their dotted keys, such as "pinion.modification.tip_relief".

    A value that is there is replaced, or goes with its line where the new one is None; a key that is not there comes to the end
    of its table (a name to its head), with a note behind it if it has one; a table that is not there to the end of the text.
    Raises SpecError for a layout that cannot be edited.
    """
    import tomlkit

    newline = "\r\n" if "\r\n" in text else "\n"
    edited = text if not text or text.endswith("\n") else text + newline
    try:
        for key, value in values.items():
            document = tomlkit.parse(edited)  # anew for each: what is put in between is found in its place
            if value is None:
                _take(document, key.split("."))
            else:
                item = tomlkit.item(value)
                item.trivia.trail = newline
                if notes and key in notes:
                    item.trivia.comment_ws, item.trivia.comment = "  ", f"# {notes[key]}"
                _put(document, key.split("."), item, newline)
            edited = document.as_string()
    except (KeyError, tomlkit.exceptions.TOMLKitError) as error:
        raise _uneditable(values) from error
    _require_edited(text, edited, values)
    return edited


def _take(document: Container, path: list[str]) -> None:
    """Remove the value under a path with its line, wherever it is; what holds nothing else by dotted keys goes as well."""
    for inside, _, _, table in sorted(_tables_around(document, path), key=itemgetter(0), reverse=True):
        if len(path) - inside == 1 and path[-1] in table.value:
            table.value.remove(path[-1])
            path = path[:-1]
            if table.value or len(path) < 2:
                return


def _put(document: TOMLDocument, path: list[str], item: Item, newline: str) -> None:
    """Replace the value under a path, or put a new one in the innermost of the tables around it that is there, or a new one."""
    import tomlkit

    around = sorted(_tables_around(document, path), key=itemgetter(0, 1, 2))
    if not around and (path[0] in document or len(path) < 2):
        raise KeyError(path[0])
    if not around:
        made = tomlkit.table()
        made.append(tomlkit.key(path[1:]), item)
        made.trivia.indent = newline if document.as_string().strip() else ""
        made.trivia.trail = newline
        document.append(path[0], made)
        return
    inside, *_, table = around[-1]  # of equals the last
    rest, keys = path[inside:], table.value.body
    if len(rest) == 1 and rest[0] in table.value:
        table.value[rest[0]] = item.unwrap()
        return
    end = max((at for at, (key, each) in enumerate(keys, 1) if key is not None and not _has_header(key, each)), default=0)
    at = 0 if rest == ["name"] else end
    if isinstance(table, tomlkit.items.InlineTable):
        item.trivia.indent = " " if at else ""
        item.trivia.comment_ws = item.trivia.comment = ""  # a note would end the line, and the table with it
    keys.insert(at, (tomlkit.key(rest), item))


def _tables_around(container: Container, path: list[str], inside: int = 1) -> Iterator[tuple[int, bool, bool, AbstractTable]]:
    """Tables around the end of a path, one of which may stand in several places.

    With each: how far it is inside, whether it has the next key, and whether it is more than the beginning of others' names.
    """
    from tomlkit.items import AbstractTable, Table

    for key, item in container.body:
        if key is not None and key.key == path[0] and isinstance(item, AbstractTable) and len(path) > 1:
            yield inside, path[1] in item.value, not (isinstance(item, Table) and item.is_super_table()), item
            yield from _tables_around(item.value, path[1:], inside + 1)


def _has_header(key: Any, item: Any) -> bool:
    """Whether an entry of a table is a table with a header of its own, which ends the keys of the one around it."""
    from tomlkit.items import AoT, Table

    return isinstance(item, AoT) or (isinstance(item, Table) and not key.is_dotted())


def _require_edited(text: str, edited: str, values: Mapping[str, Cell | None]) -> None:
    """Raise SpecError unless the edited text holds the new values, and else what the old one did."""
    expected = tomllib.loads(text)
    for key, value in values.items():
        inner: dict[str, Any] = expected
        *tables, last = key.split(".")
        for table in tables:
            inner = inner.setdefault(table, {})
        if value is None:
            inner.pop(last, None)
        else:
            inner[last] = list(value) if isinstance(value, tuple) else value
    try:
        same = _filled(tomllib.loads(edited)) == _filled(expected)
    except tomllib.TOMLDecodeError:
        same = False
    if not same:
        raise _uneditable(values)


def _filled(table: dict[str, Any]) -> dict[str, Any]:
    """Without tables in which nothing is: dotted keys make one that goes with the last of them."""
    inner = {key: _filled(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in inner.items() if value != {}}


def _uneditable(values: Mapping[str, Cell | None]) -> SpecError:
    import tomlkit

    wanted = ", ".join(
        f"no {key}" if value is None else f"{key} = {tomlkit.item(value).as_string()}" for key, value in values.items()
    )
    return SpecError(f"the layout of the spec cannot be edited; write by hand: {wanted}")
