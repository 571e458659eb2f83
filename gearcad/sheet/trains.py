"""Blocks of data sheets of planetary trains and trains, and of a rating."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from gearcad.core import symbols
from gearcad.core.errors import format_number
from gearcad.core.quantities import symbols_of
from gearcad.core.records import JsonObject, PerGear, Role, is_assumed
from gearcad.core.symbols import Better, Symbol
from gearcad.designs.train_keys import MAIN, TORQUES, TRAIN, TRAIN_PARTS
from gearcad.dynamics.planetary.planetary_strength import TrainStrength
from gearcad.load import Load
from gearcad.planetary import Carrier, Central, PlanetaryTrain, Rim
from gearcad.rating.strength import FactorGroup, RatedPart, StrengthRating
from gearcad.sheet.blocks import ABSENT, OF_PAIR, Block, Row, Section, block, flattened, pair_section, value_text

_TRAIN_KEYS = (
    "set_type planets input output fixed ratio basic_ratio centre_distance planet_angles positions"
    " free_tip_distance tip_distance"
).split()
_OF_TRAIN = symbols_of(PlanetaryTrain) | symbols.PLANETARY
_OF_MEMBER = symbols_of(Central) | symbols_of(Rim) | symbols_of(Carrier) | symbols.PLANETARY_MEMBER


def planetary_sections(train: Mapping[str, Any]) -> tuple[Section, ...]:
    """Return the sections of a planetary train from its document."""
    pairs = {name: flattened(pair) for name, pair in (*train["meshes"].items(), *train["stages"].items())}
    return Section((), tuple(_blocks(train))), pair_section(pairs)


def _blocks(train: Mapping[str, Any]) -> Iterator[Block]:
    rows = (_planetary_row("planetary", key, _OF_TRAIN[key], train[key]) for key in _TRAIN_KEYS if train.get(key) is not None)
    yield from block("Planetary train", rows)
    for name, member in train["members"].items():
        given = {key: value for key, value in member.items() if value not in (None, [], 0) or key == "support_stiffness"}
        rows = (_planetary_row(name, key, _OF_MEMBER[key], value) for key, value in given.items() if value is not None)
        yield from block(name, (row for row in rows if row.symbol.words))


def _planetary_row(of: str, key: str, symbol: Symbol, value: Any) -> Row:
    text = " ".join(map(format_number, value)) if isinstance(value, list) else value_text(value)
    return Row(f"{of}.{key}", symbol, (value,), (text,))


_PLAIN = Symbol("", "", "", "")


def gearbox_sections(document: Mapping[str, Any]) -> tuple[Section, ...]:
    """Return the section of a gearbox of planetary sets: its members and states, then the teeth of each set."""
    joined = ["-".join(group) for group in document["joined"]]
    main = {"input": document["input"], "output": document["output"], "joined": ", ".join(joined) or ABSENT}
    main |= {"mesh_efficiency": value_text(document["mesh_efficiency"])}
    blocks = list(block("Gearbox", (_text_row(f"planetary.{key}", key.replace("_", " "), text) for key, text in main.items())))
    for name, each in document["sets"].items():
        teeth = {part: f"z = {own['teeth']}, meshes {own['meshes']}" for part, own in each["centrals"].items()}
        for part, own in each["planets"].items():
            mates = [f"{word} {own[word]}" for word in ("meshes", "beside") if own[word]]
            teeth[part] = ", ".join([f"z = {own['teeth']}", *mates])
        blocks += block(name, (_text_row(f"{name}.{part}", part, text) for part, text in teeth.items()))
    states = {}
    for name, state in document["states"].items():
        joined = ["-".join(group) for group in state["joined"]]
        parts = [f"held: {', '.join(state['held'])}"] if state["held"] else []
        states[name] = "; ".join([*parts, *([f"joined: {', '.join(joined)}"] if joined else [])]) or ABSENT
    blocks += block("States", (_text_row(f"states.{name}", name, text) for name, text in states.items()))
    return (Section((), tuple(blocks)),)


def _text_row(key: str, words: str, text: str) -> Row:
    return Row(key, _PLAIN._replace(words=words), (text,), (text,))


_TITLES = {"inertia": "Inertias", "shaft": "Shafts", "mesh": "Meshes", "excitation": "Excitations"}


def train_sections(document: Mapping[str, Any]) -> Iterator[Section]:
    """Yield the sections of a train from the document of `data.json`, without rows that have no value."""
    known = {key: field.symbol for key, field in TRAIN[MAIN].items()} | symbols.TRAIN
    own = {key: value for key, value in document[MAIN].items() if key != TORQUES}
    yield Section(
        (), (Block("Train", _nonzero_rows(_train_row(MAIN, key, known[key], [value]) for key, value in own.items())),)
    )
    for table in TRAIN_PARTS:
        if not (parts := document.get(table)):
            continue
        known = {
            key: field.symbol for key, field in TRAIN[table].items() if key not in ("layout", "file")
        } | symbols.TRAIN_PARTS[table]
        rows = (_train_row(table, key, symbol, [part.get(key) for part in parts.values()]) for key, symbol in known.items())
        yield Section(tuple(parts), (Block(_TITLES[table], _nonzero_rows(rows)),))


_PAIR_KEYS = ("gear_ratio", "centre_distance", "transverse_contact_ratio", "overlap_ratio", "circumferential_backlash")
"""Figures of the pair of a mesh that the sheet of a train has; all are in its data.json."""


def mesh_sections(documents: Mapping[str, JsonObject]) -> Iterator[Section]:
    """Yield a section with the pair of each mesh, whose documents have the names of meshes: teeth, load of the pinion, ..."""
    if not documents:
        return
    rows = [
        _train_row("mesh", f"{role.value}.teeth", Symbol("z", "", "", f"teeth of the {role.value}"), values)
        for role in Role
        for values in [[each[role.value]["teeth"] for each in documents.values()]]
    ]
    for key in _PAIR_KEYS:
        rows.append(_train_row("mesh", key, OF_PAIR[key], [each["pair"].get(key) for each in documents.values()]))
    for key in ("torque", "speed"):
        loads = [(each.get("load") or {}).get(key) for each in documents.values()]
        rows.append(_train_row("mesh", f"load.{key}", symbols_of(Load)[key], loads))
    yield Section(tuple(documents), (Block("Pairs", _nonzero_rows(rows)),))


def _nonzero_rows(rows: Iterable[Row]) -> tuple[Row, ...]:
    """Return the rows that have a value other than 0 in some column."""
    return tuple(row for row in rows if set(row.texts) - {ABSENT, "0"})


def _train_row(table: str, key: str, symbol: Symbol, values: list[Any]) -> Row:
    return Row(f"{table}.{key}", symbol, tuple(values), tuple(map(_cell_text, values)))


def _cell_text(value: Any) -> str:
    if value is None or value == []:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list):
        return " ".join(map(_cell_text, value)) if len(value) <= 2 else f"{len(value)} values"
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)


LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""

_PART_SYMBOLS = {
    "permissible_torque": Symbol("T_1", "N·m", "", "torque on the pinion at the required safety", Better.HIGHER),
    "life": Symbol("", "h", "", "life at the required safety", Better.HIGHER),
    "damage": Symbol("D", "", "ISO 6336-6", "damage over the life at the required safety", Better.LOWER),
}

_CYCLES = {RatedPart.FLANK: "ISO 6336-2, 11", RatedPart.ROOT: "ISO 6336-3, 12"}
"""Clause in which the standard counts load cycles."""

_BEHIND = "Behind the load factors"

_GROUPS = {
    FactorGroup.LOAD: ("Load factors", (), ()),
    FactorGroup.CONTACT_STRESS: ("Contact stress", (), ("sigma_H0", "sigma_H")),
    FactorGroup.FLANK_STRENGTH: ("What the flanks bear", ("sigma_Hlim",), ("sigma_HG", "sigma_HP")),
    FactorGroup.ROOT_STRESS: ("Root stress", (), ("sigma_F0", "sigma_F")),
    FactorGroup.ROOT_STRENGTH: ("What the roots bear", ("sigma_Flim",), ("sigma_FG", "sigma_FP")),
}
"""Title of each group of factors, and the stresses before and after its factors."""

FACTORS = (*(title for title, _, _ in _GROUPS.values()), _BEHIND)
"""Titles of the blocks of factors and stresses."""

_OF_ONE = {"Z_B": Role.PINION, "Z_D": Role.WHEEL}
"""Gear to which a factor belongs, for factors that documents have by themselves."""


_SHORT = {
    "permissible_torque.flank": "torque for S_Hmin",
    "permissible_torque.root": "torque for S_Fmin",
    "damage.flank": "damage for S_Hmin",
    "damage.root": "damage for S_Fmin",
    "life.flank": "life for S_Hmin",
    "life.root": "life for S_Fmin",
}
"""Words of rows that stand apart from the safety that they are of."""

_WHOLE = 1e7
"""Value below which a number has no exponent."""


class Quantity(NamedTuple):
    """A number of the pair, or those of both gears under the names of documents; `verify`: whether it rests on one source."""

    key: str
    symbol: Symbol
    value: Any
    verify: bool = False


def safety_quantities(rating: StrengthRating, document: Mapping[str, Any]) -> Iterator[Quantity]:
    """Yield the safety quantities of flanks and roots, then those of scuffing.

    Of flanks and roots they are the safety, the required safety, torque, damage, life and cycles.
    """
    for part in RatedPart:
        name, safety = part.value, symbols.STRENGTH[f"S_{part.index}"]
        yield Quantity(f"safety.{name}", safety, document["safety"][name])
        required = Symbol(f"{safety.symbol}min", "", "", f"required safety of the {name}")
        yield Quantity(f"required.{name}", required, document["required"][name])
        torque = _PART_SYMBOLS["permissible_torque"]._replace(
            words=f"torque on the {rating.gear_names.pinion} at the required safety"
        )
        yield Quantity(f"permissible_torque.{name}", torque, document["permissible_torque"][name])
        yield Quantity(f"damage.{name}", _PART_SYMBOLS["damage"], document["damage"][name])
        yield Quantity(f"life.{name}", _PART_SYMBOLS["life"], document["life"][name])
        cycles = symbols.STRENGTH["N_L"]._replace(source=_CYCLES[part])
        yield Quantity(f"load_cycles.{name}", cycles, document["load_cycles"][name])
    for symbol, key in (("S_int", "integral"), ("S_B", "flash")):
        yield Quantity(f"safety.scuffing.{key}", symbols.STRENGTH[symbol], document["safety"]["scuffing"][key])


def factor_quantities(rating: StrengthRating, document: Mapping[str, Any]) -> dict[str, list[Quantity]]:
    """Return all factors and stresses, each with its clause, by what they are of."""
    values, verify = {**document["factors"], **document["stresses"]}, {each.rpartition(".")[2] for each in rating.verify}
    sources = document["sources"]

    def quantity(key: str) -> Quantity:
        symbol, value = symbols.STRENGTH[key], values[key]
        words = symbol.words
        if key in _OF_ONE:
            role = _OF_ONE[key]
            value = {name: value if each is role else None for each, name in rating.names.items()}
            words = words.replace(role.value, rating.gear_names.pick(role))
        symbol = symbol._replace(source=sources.get(key, symbol.source), words=words)
        return Quantity(f"factors.{key}", symbol, value, key in verify)

    found = {
        title: [quantity(key) for key in (*before, *rating.factors[group], *after) if key in values]
        for group, (title, before, after) in _GROUPS.items()
    }
    written, details = symbols.LOAD_FACTOR_DETAILS, document["load_factors"] or {}
    if "K_Hbeta_end_of_face" in details:  # f_sh is that of the shafts, not of Method C
        written = written | {"f_sh": written["f_sh"]._replace(source=written["K_Hbeta_end_of_face"].source)}
    behind = [Quantity(f"load_factors.{key}", written[key], value) for key, value in details.items() if key in written]
    first, *others = found.items()
    return {title: of for title, of in (first, (_BEHIND, behind), *others) if of}


OF_PLASTIC = "Gears of plastic, VDI 2736-2"
"""Title of the block of what VDI 2736-2 has of gears of plastic."""


def plastic_quantities(rating: StrengthRating, document: Mapping[str, Any]) -> list[Quantity]:
    """Return what VDI 2736-2 has of a pair with a gear of plastic, in the order of its steps; empty for other pairs."""
    found = document.get("plastic")
    if found is None:
        return []
    verify, names = set(rating.verify), rating.names

    def gears(part: str, key: str) -> dict[str, float | None]:
        return {name: found[part].get(name, {}).get(key) for name in names}

    values = {key: value for key, value in found.items() if key in symbols.PLASTIC}
    values |= {f"temperature.{part}": of for part, of in found["temperature"].items()}
    values |= {"static": gears("static", "sigma_Fmax"), "static_permitted": gears("static", "permitted")}
    values |= {"wear": gears("wear", "mean"), "wear_permitted": gears("wear", "permitted")}
    values["deformation_permitted"] = found["unconfirmed"]["permitted_deformation"]
    doubtful = {"k_theta": ("temperature.flank", "temperature.root"), "lambda_zul": ("deformation_permitted",)}
    doubtful |= {"S_Smin": ("static_permitted",)}
    marked = {key for symbol in verify for key in doubtful.get(symbol, (symbol,))}
    return [
        Quantity(f"plastic.{key}", symbol, values[key], key in marked)
        for key, symbol in symbols.PLASTIC.items()
        if key in values and not _is_empty(values[key])
    ]


def _is_empty(value: Any) -> bool:
    return all(each is None for each in value.values()) if isinstance(value, Mapping) else value is None


def strength_sections(rating: StrengthRating, name: str = "") -> tuple[Section, ...]:
    """Return the safeties, then factors by what they are of, a column for each gear, without what is not known; of a mesh its
    `name`.
    """
    document = rating.to_dict()
    groups = {"Safety": list(safety_quantities(rating, document)), **factor_quantities(rating, document)}
    groups |= {OF_PLASTIC: found} if (found := plastic_quantities(rating, document)) else {}
    before = f"{name}." if name else "strength."
    rows = {title: [_row(before, each, rating.names) for each in quantities] for title, quantities in groups.items()}
    blocks = tuple(each for title, of in rows.items() for each in block(title, filter(_is_known, of)))
    return (Section(tuple(rating.gear_names), blocks, name),)


def train_strength_sections(strength: TrainStrength) -> tuple[Section, ...]:
    """Return the least safeties of every gear, each with its mesh, then the sections of each mesh."""
    rows = []
    for name, gear in strength.members.items():
        least = [gear.least(part) for part in RatedPart]
        texts = tuple(ABSENT if each is None else f"{_text(each.safety)} ({each.mesh})" for each in least)
        values = tuple(None if each is None else each.safety for each in least)
        rows.append(Row(f"least.{name}", Symbol("", "", "", name, Better.HIGHER), values, texts))
    sections = [Section(tuple(f"S_{part.index}" for part in RatedPart), block("Least safeties", filter(_is_known, rows)))]
    for name, rating in strength.meshes.items():
        sections += strength_sections(rating, name)
    return tuple(sections)


def _is_known(row: Row) -> bool:
    return set(row.texts) != {ABSENT}


def _row(before: str, of: Quantity, names: PerGear[str]) -> Row:
    values = tuple(of.value[name] for name in names) if isinstance(of.value, Mapping) else (of.value,)
    symbol = of.symbol._replace(words=_SHORT.get(of.key, of.symbol.words))
    symbol = symbol._replace(source=f"{symbol.source} (unconfirmed)") if of.verify else symbol
    text = _hours if of.symbol.unit == "h" else _text
    return Row(f"{before}{of.key}", symbol, values, tuple(map(text, values)))


def _hours(value: float | str | None) -> str:
    """Return a life; beyond all machines no digits are told."""
    return f"> {LONGEST_LIFE:.0f}" if isinstance(value, float) and LONGEST_LIFE < value < math.inf else _text(value)


def _text(value: Any) -> str:
    if value is None:
        return ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value)
    text = f"{value:.4g}"
    text = f"{float(text):.0f}" if "e+" in text and abs(value) < _WHOLE else text
    return f"{text} (assumed)" if is_assumed(value) else text
