"""The heading of a design table: which key each column holds, and every fault at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from gearcad.designs.cells import RawCell, plain_text
from gearcad.designs.column_keys import COLUMNS, explain_unknown_column, nearest_table
from gearcad.designs.design import DesignKind
from gearcad.designs.keys import MAIN_TABLES, OF_SETS, SPEEDS
from gearcad.designs.planetary_keys import PLANETARY
from gearcad.designs.train_keys import TrainKey
from gearcad.errors import SpecError, shown

__all__ = ["column_letter", "kinds_of", "read_headings"]

_MAIN = DesignKind.PLANETARY.value


def column_letter(index: int) -> str:
    """The name a spreadsheet gives the column of this index (from 0): A ... Z, AA ..."""
    letters = ""
    index += 1
    while index:
        index, letter = divmod(index - 1, 26)
        letters = chr(ord("A") + letter) + letters
    return letters


def kinds_of(keys: Iterable[str]) -> set[DesignKind]:
    """What full keys can make; none of [material] and [load] makes anything. A pinion may have a wheel or a rack."""
    keys = tuple(keys)
    owners = {key.partition(".")[0] for key in keys}
    planetary = {"planetary", *OF_SETS}
    paired = bool(owners & {"pair", "pinion"})
    makes = {
        DesignKind.GEAR: "gear" in owners,
        DesignKind.PAIR: "wheel" in owners or (paired and "rack" not in owners),
        DesignKind.RACK: "rack" in owners and not paired,
        DesignKind.RACK_PAIR: "rack" in owners and paired,
        DesignKind.TRAIN: any(map(_of_train, keys)),
        DesignKind.PLANETARY: bool(owners & planetary),
    }
    return {kind for kind, made in makes.items() if made}


def _of_train(key: str) -> bool:
    """Whether a key is of a train: that of a mesh has a name between its table and itself, which no key of [mesh] has."""
    table, _, rest = key.partition(".")
    return table in ("train", "inertia", "shaft") or (table == "mesh" and "." in rest)


def read_headings(cells: Sequence[RawCell], where: str) -> tuple[str, ...]:
    """The full key of every column, "name" for that of the designs, "" under a blank heading; blank ones at the end are cut.

    `where` names the file and row. A key without a table is one of [pair] or [gear], by what the table has. Raises
    SpecError with one line per fault.
    """
    headings = [plain_text(cell) for cell in cells]
    while headings and not headings[-1]:
        headings.pop()
    dotted = (heading for heading in headings if "." in heading and heading not in COLUMNS["gear"])
    kinds = kinds_of(f"{nearest_table(first) or ''}.{rest}" for first, _, rest in (each.partition(".") for each in dotted))
    places: dict[str, int] = {}
    columns, faults = [], []
    for index, heading in enumerate(headings):
        key, fault = _key_of(heading, kinds) if heading else ("", "")
        if not fault and key in places:
            fault = f"is the same as column {column_letter(places[key])} ({headings[places[key]]}); keep one of them"
        if fault:
            faults.append(f"{where} column {column_letter(index)}: {shown(heading)}: {fault}")
        elif key:
            places[key] = index
        columns.append(key)
    if "name" not in headings:
        faults.append(f"{where}: has no column name, which every table needs: it gives each design a name and a folder")
    if faults:
        raise SpecError("\n".join(faults))
    return tuple(columns)


def _key_of(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """The full key of a heading, and what is wrong with it."""
    if heading == "name":
        return heading, ""
    if heading in ("pair.name", "gear.name", "rack.name", "train.name", "planetary.name"):
        return "", "is the name of the design; write name"
    if DesignKind.TRAIN in kinds:
        return _key_of_train(heading, kinds)
    if DesignKind.PLANETARY in kinds:
        return _key_of_planetary(heading, kinds)
    table, _, field = heading.partition(".")
    if table in COLUMNS and field in COLUMNS[table]:
        return heading, ""
    mains = dict.fromkeys(MAIN_TABLES[kind][0] for kind in MAIN_TABLES if kind in kinds)
    if len(mains) > 1 and heading in COLUMNS["gear"]:
        homes = tuple(mains) if heading in COLUMNS["pair"] else (*(main for main in mains if main != "pair"), "pinion", "wheel")
        written = " or ".join(f"{owner}.{heading}" for owner in homes)
        owners = " or of a ".join(mains)
        return "", f"could be of a {owners}, and this table has both; write {written}"
    main = "pair" if "pair" in mains else next(iter(mains), "gear")
    if heading in COLUMNS[main] and len(mains) < 2:
        return f"{main}.{heading}", ""
    return "", explain_unknown_column(heading, main)


def _key_of_train(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """The full key of a heading in a table of trains, whose bare keys are those of [train]; and what is wrong with it."""
    for key in (heading, f"train.{heading}"):
        if TrainKey.of(key) is not None:
            return key, ""
    table = heading.partition(".")[0]
    if len(kinds) > 1 and (table in (*COLUMNS, *PLANETARY) or heading in COLUMNS["gear"]):
        return "", "cannot stand beside keys of trains: a table holds these, or gears and pairs, or planetary trains"
    return "", explain_unknown_column(heading, "train")


def _key_of_planetary(heading: str, kinds: set[DesignKind]) -> tuple[str, str]:
    """The full key of a heading in a table of planetary trains, whose bare keys are those of [planetary]; and what is wrong."""
    table, _, field = heading.partition(".")
    if field in PLANETARY.get(table, ()) or (table == _MAIN and field.startswith(f"{SPEEDS}.")):
        return heading, ""
    if len(kinds) > 1 and (table in COLUMNS or heading in COLUMNS["gear"]):
        return "", "cannot stand beside keys of planetary trains: a table holds these, or gears and pairs"
    if heading in PLANETARY[_MAIN] or heading.startswith(f"{SPEEDS}."):
        return f"{_MAIN}.{heading}", ""
    return "", explain_unknown_column(heading, _MAIN)
