"""Which columns a design table may have, what their cells can hold, and what to say about a heading that is none."""

from __future__ import annotations

import difflib

from gearcad.designs.keys import FIELDS, KEYS, MOVED, OF_SETS, nearest_of
from gearcad.designs.planetary_keys import PLANETARY, explain_unknown_planetary_column
from gearcad.designs.train_keys import ALL, TRAIN, explain_unknown_key_of_train
from gearcad.designs.train_keys import PARTS as TRAIN_PARTS
from gearcad.schema import ELSEWHERE

__all__ = [
    "COLUMNS",
    "COUNTS",
    "LISTS",
    "NESTED",
    "SWITCHES",
    "TEXTS",
    "TEXT_LISTS",
    "explain_unknown_column",
    "nearest_table",
]

_EACH = {
    f"{table}.{key}": field for kind in (PLANETARY, FIELDS) for table, fields in kind.items() for key, field in fields.items()
} | {
    f"{table}.{ALL}.{key}" if table in TRAIN_PARTS else f"{table}.{key}": field
    for table, fields in TRAIN.items()
    for key, field in fields.items()
}
COUNTS = frozenset(key for key, field in _EACH.items() if field.whole)
LISTS = frozenset(key for key, field in _EACH.items() if field.several)
NESTED = frozenset(key for key, field in _EACH.items() if field.nested)
TEXT_LISTS = frozenset(key for key, field in _EACH.items() if field.texts)
TEXTS = NESTED | frozenset(key for key, field in _EACH.items() if field.text or ELSEWHERE in field.marks)
SWITCHES = frozenset(key for key, field in _EACH.items() if field.switch)
"""Full keys of whole numbers, of what may be several numbers (in a cell there is space between them), of lists of lists (a text
in a cell), of lists of texts, of these and words, and of true and false; of a train's parts those of all (`general_key`)."""


_NO_COLUMN = (("gear", "name"), ("pair", "name"), ("rack", "name"))

COLUMNS = {table: tuple(field for field in fields if (table, field) not in _NO_COLUMN) for table, fields in KEYS.items()}
"""Permitted keys of the columns of a design table, by their tables, where the design's own name has a column `name`."""

_USUAL = tuple(table for table in COLUMNS if table not in ("gear", "rack"))


def nearest_table(name: str) -> str | None:
    """The table that was meant by `name`, if any."""
    if name.lower() in TRAIN:
        return name.lower()
    near = difflib.get_close_matches(name.lower(), (*KEYS, *OF_SETS, "planetary"), n=1, cutoff=0.75)
    return near[0] if near else None


def explain_unknown_column(heading: str, main: str) -> str:
    """The end of the message about a heading of a design table that is no key; bare keys are those of the table `main`."""
    if main == "train":
        return explain_unknown_key_of_train(heading)
    if main == "planetary":
        return explain_unknown_planetary_column(heading)
    if heading.lower() == "name":
        return "unknown column; did you mean name?"
    if (moved := MOVED.get(heading)) is not None:
        return f"is no column any more: {moved}"
    first, dot, rest = heading.partition(".")
    table = nearest_table(first) if dot else None
    owner, field = (table, rest) if table else (main, heading)
    # A pair has no [gear], and few have a [rack]; a table with nothing but bare keys may have been meant for pairs.
    owners = [owner, *(name for name in COLUMNS if name != owner and name in (main, *_USUAL))]
    for meant in (field, *(nearest_of(field, FIELDS[name], COLUMNS[name]) for name in owners)):
        if homes := [f"{name}.{meant}" for name in owners if meant in COLUMNS[name]]:
            found = homes[:1] if homes[0].startswith(f"{owner}.") else homes
            return f"unknown column; did you mean {' or '.join(found)}?"
    if table:
        return f"unknown column; permitted behind {table}. are {', '.join(COLUMNS[table])}"
    examples = f"{main}.teeth" if main != "pair" else "pair.normal_module, pinion.teeth"
    return f"unknown column; must be name, or a key of a spec with its table, such as {examples} or load.torque"
