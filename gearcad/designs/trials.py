"""Faults of single values of a design: each is tried among values that are sound, so that no fault hides another."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from functools import lru_cache

from gearcad.designs.design import DesignKind
from gearcad.designs.keys import FIELDS, MAIN_TABLES, OF_SETS, SHARED, Cell
from gearcad.designs.reader import design_from_values
from gearcad.designs.train_keys import ALL, TrainKey
from gearcad.designs.train_values import missing_fault, missing_keys
from gearcad.errors import GeometryError, SpecError
from gearcad.geometry.diametral import MODULE_OR_PITCH
from gearcad.per_gear import Role

__all__ = ["fault_alone", "missing_faults", "permitted_alone"]

Where = Callable[[str], str]

_REQUIRED: dict[str, Cell] = {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "height": 20.0}
"""What a gear or a rack cannot do without, as far as they have it, and values that fit each other."""

_TOOTHED = {
    kind: tuple(table for table in tables if table in FIELDS and table != "pair") for kind, tables in MAIN_TABLES.items()
}
_SOUND = {
    kind: {f"{owner}.{field}": value for field, value in _REQUIRED.items() for owner in owners if field in FIELDS[owner]}
    for kind, owners in _TOOTHED.items()
}

_TEETH = {"sun": 24, "planet": 21, "planet_2": 18, "sun_2": 27, "ring": -66, "ring_2": -63}
_SETS = {
    "planet_2": ("sun", "planet", "planet_2", "ring"),
    "sun_2": ("sun", "sun_2", "planet"),
    "ring_2": ("ring", "ring_2", "planet"),
}
"""The gears of a set that has the second of a kind."""

_RINGS: dict[str, dict[str, Cell]] = {
    owner: {f"{owner}.teeth": -70, f"{owner}.profile_shift": -0.3} for owner in ("gear", "wheel")
}
"""What makes rings of these sound gears: diameters and centre distances are negative beside them."""


def _sound_set(owner: str) -> dict[str, Cell]:
    """Values of a set of planets among which those of a table are tried."""
    gears = _SETS.get(owner, ("sun", "planet", "ring"))
    train: dict[str, Cell] = {"planets": 3, "input": gears[0], "output": "carrier"}
    made = {f"{DesignKind.PLANETARY.value}.{field}": value for field, value in train.items()}
    for gear in gears:
        made |= {f"{gear}.{field}": _REQUIRED[field] for field in ("normal_module", "face_width")} | {
            f"{gear}.teeth": _TEETH[gear]
        }
    return made


def _sound_train(key: str, value: Cell) -> dict[str, Cell]:
    """Values of a train among which one is tried, on parts of its key's name."""
    found = TrainKey.of(key)
    name = "part" if found is None or found.name in ("", ALL) else found.name
    gear = f"other than {name}"
    teeth = len(value) if isinstance(value, tuple) else 20  # deviations are as many
    mesh: dict[str, Cell] = {"pinion": name, "wheel": gear, "base_radii": (50.0, 100.0), "stiffness": 500.0, "teeth": teeth}
    made: dict[str, Cell] = {f"inertia.{each}.inertia": 0.1 for each in (name, gear)}
    made |= {f"shaft.{name}.{field}": each for field, each in {"start": name, "end": "ground"}.items()}
    made[f"shaft.{name}.torsional_stiffness"] = 1e4
    made |= {f"mesh.{name}.{field}": each for field, each in mesh.items()}
    return made


def fault_alone(key: str, value: Cell, where: Where, *, of: DesignKind | None = None) -> SpecError | None:
    """What is wrong with a value whatever the others are; `where` locates a key for the message.

    `of` is the kind of design where it is a train or a planetary train.
    """
    if of is DesignKind.TRAIN:
        return _fault_in_train(key, value, where)
    owner, _, field = key.partition(".")
    kind = of or _home(key)
    others = (_sound_set(owner) if of else _SOUND[kind]) | ({"load.torque": 1.0} if owner == "load" else {})
    if owner in ("pair", DesignKind.PLANETARY.value):
        # What the gears have of their own would win.
        others = {other: given for other, given in others.items() if not other.endswith(f".{field}")}
    if field in MODULE_OR_PITCH:
        others = {other: given for other, given in others.items() if other.partition(".")[2] not in MODULE_OR_PITCH}
    for ring in ({}, *(rings for name, rings in _RINGS.items() if name == owner or (name == "wheel" and owner == "pair"))):
        error = _fault({**others, **ring, key: value}, kind, where)
        if error is None or error.key != key or isinstance(error.__cause__, GeometryError):
            return None
    return error


def _fault_in_train(key: str, value: Cell, where: Where) -> SpecError | None:
    """The same in a train: names of other parts are for the whole row to judge."""
    found = TrainKey.of(key)
    if found is None or found.schema.members == (str,) or found.name == ALL:
        return None
    sound = _sound_train(key, value)
    shaped = {other: given for other, given in sound.items() if not other.endswith(".torsional_stiffness")}
    shaped |= {f"shaft.{found.name or 'part'}.{field}": 1.0 for field in ("length", "diameter")}
    for rest in (sound, shaped):
        error = _fault({**rest, key: value}, DesignKind.TRAIN, where)
        if error is None or error.key != key or isinstance(error.__cause__, GeometryError):
            return None
    return error


def _home(key: str) -> DesignKind:
    """The kind of design among whose sound values a key is tried."""
    owner = key.partition(".")[0]
    if owner == "rack":
        return DesignKind.RACK
    if key in ("pair.mounting_distance", "material.rack"):
        return DesignKind.RACK_PAIR
    if key in (f"material.{role.value}" for role in Role):
        return DesignKind.PAIR
    return DesignKind.PAIR if owner in MAIN_TABLES[DesignKind.PAIR] else DesignKind.GEAR


@lru_cache(maxsize=4096, typed=True)
def permitted_alone(key: str, value: Cell, *, of: DesignKind | None = None) -> bool:
    """True if a value is not wrong by itself. The rows of a table share many of theirs."""
    return fault_alone(key, value, where=str, of=of) is None


def missing_faults(given: Collection[str], kind: DesignKind, where: Where) -> Iterator[SpecError]:
    """The faults of values that are not among the keys `given`; what both gears may share is missed once."""
    if kind is DesignKind.TRAIN:
        yield from (missing_fault(key, where) for key in missing_keys(given))
        return
    if kind is DesignKind.PLANETARY:
        yield from _missing_of_set(given, where)
        return
    for field in _REQUIRED:
        fields = MODULE_OR_PITCH if field in MODULE_OR_PITCH else ("teeth", "length") if field == "teeth" else (field,)
        for owner in (each for each in _TOOTHED[kind] if f"{each}.{field}" in _SOUND[kind]):
            if not any(f"{table}.{each}" in given for each in fields for table in (owner, "pair")):
                yield from _fault_without(f"{owner}.{field}", _SOUND[kind], kind, where)
                if field in SHARED:
                    break
    if "load.torque" not in given and any(key.startswith("load.") for key in given):
        yield from _fault_without("load.torque", _SOUND[kind] | {"load.speed": 0.0}, kind, where)


def _missing_of_set(given: Collection[str], where: Where) -> Iterator[SpecError]:
    """Those of a planetary train; which gears its set lacks is said where it is read."""
    kind, main = DesignKind.PLANETARY, DesignKind.PLANETARY.value
    for table in OF_SETS:
        if any(key.startswith(f"{table}.") for key in given) and f"{table}.teeth" not in given:
            yield from _fault_without(f"{table}.teeth", _sound_set(table), kind, where)
    for field in ("planets", "input", "output"):
        if f"{main}.{field}" not in given:
            yield from _fault_without(f"{main}.{field}", _sound_set(""), kind, where)


def _fault_without(key: str, values: Mapping[str, Cell], kind: DesignKind, where: Where) -> Iterator[SpecError]:
    error = _fault({other: value for other, value in values.items() if other != key}, kind, where)
    if error is not None:
        yield error


def _fault(values: Mapping[str, Cell], kind: DesignKind, where: Where) -> SpecError | None:
    try:
        design_from_values(values, kind, where=where, default_name="trial")
    except SpecError as error:
        return error
    return None
