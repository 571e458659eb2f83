"""Reader of spec files and of starters, and an editor of specs that keeps comments and layout.

The main table decides the kind: `[gear]`, `[pair]` with `[pinion]` and `[wheel]`, `[rack]`, which may have a `[pinion]` in its
`[pair]`, `[train]`, or `[planetary]` with its gears. Unknown input is refused, so nothing is silently ignored.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from importlib import import_module
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from gearcad.core.errors import ParameterError, SpecError, as_path
from gearcad.core.runtime import templates
from gearcad.designs.design import Design, Where, read_tables
from gearcad.designs.keys import MAIN_TABLES, OF_SETS, Cell, DesignKind, is_gearbox
from gearcad.designs.shaft_keys import with_shaft_lists

if TYPE_CHECKING:
    from tomlkit import TOMLDocument
    from tomlkit.container import Container
    from tomlkit.items import AbstractTable, Item


def type_of(kind: DesignKind) -> type[Design]:
    """Return the class of a kind's designs, imported only when it is asked for."""
    module = import_module("gearcad.designs")
    name = "".join(word.capitalize() for word in kind.value.split("_"))
    return cast("type[Design]", getattr(module, f"{name}Design"))


def read_spec(path: Path | str) -> Design:
    """Read a TOML spec. The name of the design is its own, else the stem of the file.

    Raises SpecError, one line that names the file, the line, the key and what is permitted.
    """
    tables, where = read_tables(as_path("file", path))
    if is_gearbox(tables):
        return type_of(DesignKind.GEARBOX).read(tables, where, Path(path).stem)
    return design_from_tables(tables, where=where, default_name=Path(path).stem)


def design_from_tables(tables: Mapping[str, Any], *, where: Where, default_name: str) -> Design:
    """Return the design that parsed tables describe: {"gear": {"teeth": 20, "rack": {...}, ...}}, one mapping per TOML table.

    `where` locates a dotted key for messages. The page and tables take no gearbox of planetary sets. Raises SpecError.
    """
    refuse_gearbox(tables, where)
    return type_of(kind_of(tables)).read(tables, where, default_name)


def refuse_gearbox(tables: Mapping[str, Any], where: Where) -> None:
    """Raise SpecError for the spec of a gearbox of planetary sets, which neither the page nor a study takes."""
    if is_gearbox(tables):
        key = "planetary.set"
        words = "a gearbox of planetary sets has no page and no such table: use `gearcad planetary` or a column gearbox"
        raise SpecError(f"{where(key)}: {key}: {words}", key)


def design_from_values(values: Mapping[str, Any], kind: DesignKind, *, where: Where, default_name: str) -> Design:
    """Return the design that values under the keys of a design table describe. Raises SpecError."""
    if kind is DesignKind.GEARBOX:
        from gearcad.designs.gearbox_spec import gearbox_of_row

        return gearbox_of_row(values, where, default_name)
    if kind is DesignKind.TRAIN:
        from gearcad.designs.train_designs import TrainDesign, tables_of

        tables, names = tables_of(values, where)
        return TrainDesign.read(tables, where, default_name, names)
    return design_from_tables(nested(values, kind), where=where, default_name=default_name)


def nested(values: Mapping[str, Any], kind: DesignKind) -> dict[str, Any]:
    """Return the values under their full keys as one mapping per table of a spec; the tables of the kind are there even if
    empty.
    """
    tables: dict[str, dict[str, Any]] = {owner: {} for owner in MAIN_TABLES[kind]}
    for key, value in values.items():
        owner, _, field = key.partition(".")
        tables.setdefault(owner, {})[field] = value
    return with_shaft_lists(tables)


def kind_of(tables: Mapping[str, Any]) -> DesignKind:
    """Return the kind of design, decided by the main table.

    If several main tables are present, the larger kind wins; its reader reports tables that cannot stand beside its own. Tables
    of no kind count as a pair, whose reader reports what is missing.
    """
    if "rack" in tables and "train" not in tables:
        paired = any(table in tables for table in MAIN_TABLES[DesignKind.PAIR])
        return DesignKind.RACK_PAIR if paired else DesignKind.RACK
    if "bearing" in tables:
        return DesignKind.SHAFT
    if any(table in tables for table in OF_SETS) and "train" not in tables:
        return DesignKind.PLANETARY
    return next((kind for kind in reversed(DesignKind) if kind.value in tables), DesignKind.PAIR)


_ALIASES = {
    "gear": "spur",
    "pair": "volvo-13-44",
    "ring": "ring-22-70",
    "planetary": "planetary-24-21-66",
    "uhlir": "uhlir-19-23",
}
"""Names for starters that a newcomer would try."""

_TOGETHER = {"ci": ("ci-github", "ci-gitlab")}
"""Names for several starters at once."""

NO_DESIGNS = ("drawing_title", "measured")
"""Starters that are no spec and no table of designs."""

NOT_ON_PAGE = (*NO_DESIGNS, "ravigneaux", "simpson")
"""Starters that the page does not take: those that are no designs, and gearboxes of planetary sets."""


_NONE = ("bearing_shelf", "drawing_words", "material_shelf", "page_words", "messages_de", "tool_shelf")
"""Templates without a starter."""


def _files() -> dict[str, Path]:
    return {
        path.stem: path
        for path in sorted(templates().iterdir(), key=lambda path: path.stem)
        if path.suffix in (".toml", ".csv", ".yml") and path.stem not in _NONE
    }


def starters() -> dict[str, str]:
    """Return the name of every starter with its description, from the first line of its file."""
    found = {}
    for name, path in _files().items():
        with path.open(encoding="utf-8") as file:
            found[name] = file.readline().strip("# \n").rstrip(".")
    return found


def starter_text(kind: str) -> tuple[str, str]:
    """Name of the file and text of the starter called `kind` - its name, or the beginning of one. Raises ParameterError."""
    files = _files()
    asked = _ALIASES.get(kind, kind)
    matches = [asked] if asked in files else [name for name in files if name.startswith(asked)]
    if len(matches) != 1:
        named, short = ([name for name in names if not name.startswith("ci")] for names in (files, _ALIASES))  # designs
        if near := matches or get_close_matches(kind, [*named, *short]):
            raise ParameterError("kind", kind, f"must be a starter; did you mean {' or '.join(near)}?")
        raise ParameterError("kind", kind, f"must be {', '.join(short)}, or one that `gearcad new` lists")
    path = files[matches[0]]
    return path.name, path.read_text(encoding="utf-8")


def starter_texts(kind: str) -> dict[str, str]:
    """Return the texts of the starters called `kind` by the names of their files: of one, or of all of "ci".

    Raises ParameterError.
    """
    return dict(map(starter_text, _TOGETHER.get(kind, (kind,))))


def edit_spec(text: str, values: Mapping[str, Cell | None], notes: Mapping[str, str] | None = None) -> str:
    """Return the text of a spec with values under their dotted keys, such as "pinion.modification.tip_relief".

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
    """Remove the value under a path with its line, wherever it is. A table that then holds nothing by dotted keys is removed
    too.
    """
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
    """Return whether an entry of a table is a table with a header of its own, which ends the keys of the one around it."""
    from tomlkit.items import AoT, Table

    return isinstance(item, AoT) or (isinstance(item, Table) and not key.is_dotted())


def _require_edited(text: str, edited: str, values: Mapping[str, Cell | None]) -> None:
    """Raise SpecError unless the edited text holds the new values, and otherwise the same values as the old one."""
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
    """Return the table without empty tables; dotted keys create one that is removed with the last of them."""
    inner = {key: _filled(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in inner.items() if value != {}}


def _uneditable(values: Mapping[str, Cell | None]) -> SpecError:
    import tomlkit

    wanted = ", ".join(
        f"no {key}" if value is None else f"{key} = {tomlkit.item(value).as_string()}" for key, value in values.items()
    )
    return SpecError(f"the layout of the spec cannot be edited; write by hand: {wanted}")
