"""RexsModel: components with attributes and the relations between them, written as the XML of REXS and read back."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, NoReturn
from xml.sax.saxutils import escape, quoteattr

from gearcad.core.errors import SpecError, shown, shown_path
from gearcad.core.output import file_bytes, source_date
from gearcad.exchange.rexs_attributes import CUSTOM, READ_VERSIONS, UNITS, VERSION, custom_id, same_unit
from gearcad.exchange.xml_tree import DEEPEST, XmlElement, xml_tree
from gearcad.version import __version__

RexsValue = float | int | bool | str | tuple[float, ...]
"""Value of an attribute; a tuple is an array."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_FLAGS = {"true": True, "false": False}


class WrittenValue(NamedTuple):
    """A value as it is written in a file: its text, the texts of an array, and its unit."""

    text: str
    items: tuple[str, ...] = ()
    unit: str = ""


@dataclass(frozen=True)
class RexsComponent:
    """A component of a file with its attributes as they are written; messages call the file `file`."""

    number: int
    kind: str
    name: str
    written: Mapping[str, WrittenValue] = field(default_factory=lambda: MappingProxyType({}))
    file: str = ""

    def __str__(self) -> str:
        called = f", {shown(self.name, 40)}" if self.name else ""
        return f"component {self.number} ({shown(self.kind, 40)}{called})"

    def fault(self, attribute: str, text: str) -> NoReturn:
        """Raise SpecError about an attribute."""
        raise SpecError(f"{self.file}: {self}: {attribute}{text}")

    def float_of(self, attribute: str) -> float | None:
        """Return a number in the unit of REXS; None where the component has none. Raises SpecError."""
        written = self.written.get(attribute)
        if written is None or not written.text:
            return None
        self._require_unit(attribute, written)
        return self._float(attribute, written.text)

    def needed(self, attribute: str) -> float:
        """Return a number that must be there. Raises SpecError."""
        found = self.float_of(attribute)
        if found is None:
            unit = UNITS.get(attribute, "none")
            self.fault(attribute, " is missing: it must be given" + ("" if unit == "none" else f", in {unit}"))
        return found

    def whole(self, attribute: str) -> int | None:
        """Return a whole number, or None. Raises SpecError."""
        found = self.float_of(attribute)
        if found is not None and found != int(found):
            self.fault(attribute, f" = {found:g}: must be a whole number")
        return None if found is None else int(found)

    def needed_whole(self, attribute: str) -> int:
        """Return a whole number that must be there. Raises SpecError."""
        self.needed(attribute)
        found = self.whole(attribute)
        assert found is not None
        return found

    def flag(self, attribute: str) -> bool | None:
        """Return true or false, or None. Raises SpecError."""
        written = self.written.get(attribute)
        if written is None or not written.text:
            return None
        if written.text not in _FLAGS:
            self.fault(attribute, f" = {shown(written.text, 40)}: must be true or false")
        return _FLAGS[written.text]

    def text(self, attribute: str) -> str | None:
        """Return a text, or None."""
        written = self.written.get(attribute)
        return None if written is None or not written.text else written.text

    def vector(self, attribute: str) -> tuple[float, ...] | None:
        """Return the numbers of an array, or None. Raises SpecError."""
        written = self.written.get(attribute)
        if written is None or not written.items:
            return None
        self._require_unit(attribute, written)
        return tuple(self._float(attribute, each) for each in written.items)

    def custom(self, keys: Iterable[str]) -> dict[str, Any]:
        """Return the values of those keys that are kept as attributes of our own. Raises SpecError for what is no JSON."""
        found = {}
        for key in keys:
            if (text := self.text(custom_id(key))) is None:
                continue
            try:
                found[key] = _required_plain(json.loads(text))
            except (ValueError, RecursionError):
                self.fault(custom_id(key), f" = {shown(text, 40)}: must be a value in JSON")
        return found

    def list_of(self, attribute: str) -> list[str]:
        """Return a list of names that is kept as JSON; empty where there is none. Raises SpecError."""
        found = self.custom([attribute.removeprefix(CUSTOM)]).values()
        return [each for kept in found if isinstance(kept, list) for each in kept if isinstance(each, str)]

    def _float(self, attribute: str, text: str) -> float:
        if not _NUMBER.fullmatch(text) or not math.isfinite(number := float(text)):
            self.fault(attribute, f" = {shown(text, 40)}: must be a number with a decimal point")
        return number

    def _require_unit(self, attribute: str, written: WrittenValue) -> None:
        unit = UNITS.get(attribute)
        if unit is not None and not same_unit(written.unit, unit):
            self.fault(attribute, f": its unit is {shown(written.unit, 40)}, must be {unit}")


def _required_plain(value: Any, depth: int = 0) -> Any:
    """Return a value that a key of a spec may have: a text, a number, true, false, or lists of these. Raises ValueError."""
    if isinstance(value, str):
        value.encode("utf-8")  # no half of a pair of surrogates, which no file can hold
    elif isinstance(value, list) and depth < DEEPEST:
        for each in value:
            _required_plain(each, depth + 1)
    elif not isinstance(value, int | float):
        raise ValueError(value)
    return value


class RexsRelation(NamedTuple):
    """A relation: its type, and the numbers of the components by their roles."""

    kind: str
    roles: Mapping[str, int]
    order: int | None = None


@dataclass(frozen=True)
class RexsModel:
    """A model as it is read from a file, with the attributes of the first load case on its components."""

    file: str
    version: str
    application: str
    components: Mapping[int, RexsComponent]
    relations: tuple[RexsRelation, ...]
    load_cases: int = 0

    def of_kind(self, *kinds: str) -> list[RexsComponent]:
        """Return the components of some types in the order of the file."""
        return [each for each in self.components.values() if each.kind in kinds]

    def related(self, kind: str, role: str, number: int) -> Iterator[RexsRelation]:
        """Yield the relations of a type in which a component has a role, ordered ones in their order."""
        yield from self._related.get((kind, role, number), ())

    @cached_property
    def _related(self) -> dict[tuple[str, str, int], list[RexsRelation]]:
        found: dict[tuple[str, str, int], list[RexsRelation]] = {}
        for each in sorted(self.relations, key=lambda relation: relation.order or 0):
            for role, number in each.roles.items():
                found.setdefault((each.kind, role, number), []).append(each)
        return found

    def parts(self, number: int, *kinds: str) -> list[RexsComponent]:
        """Return the parts of an assembly that are of some types."""
        parts = (each.roles["part"] for each in self.related("assembly", "assembly", number) if "part" in each.roles)
        return [self.components[part] for part in parts if self.components[part].kind in kinds]

    def referenced(self, number: int, *kinds: str) -> list[RexsComponent]:
        """Return the components of some types to which one refers."""
        names = (each.roles["referenced"] for each in self.related("reference", "origin", number) if "referenced" in each.roles)
        return [self.components[name] for name in names if self.components[name].kind in kinds]


class ModelBuilder:
    """Collects components and relations in the order in which they are written."""

    def __init__(self) -> None:
        self._components: list[tuple[str, str, dict[str, RexsValue]]] = []
        self._relations: list[tuple[str, int | None, dict[str, int]]] = []

    def add(self, kind: str, name: str = "", attributes: Mapping[str, RexsValue] | None = None) -> int:
        """Add a component and return its number."""
        self._components.append((kind, name, dict(attributes or {})))
        return len(self._components)

    def extend(self, number: int, attributes: Mapping[str, RexsValue]) -> None:
        """Add attributes to a component."""
        self._components[number - 1][2].update(attributes)

    def relate(self, kind: str, order: int | None = None, **roles: int) -> None:
        """Add a relation between components by their roles."""
        self._relations.append((kind, order, roles))

    def text(self) -> str:
        """Return the XML of REXS. Its date is that of SOURCE_DATE_EPOCH where this is set."""
        return "\n".join(self._lines()) + "\n"

    def _lines(self) -> Iterator[str]:
        date = (source_date() or datetime.now(UTC)).replace(microsecond=0).isoformat()
        yield '<?xml version="1.0" encoding="UTF-8"?>'
        yield (
            f'<model version="{VERSION}" applicationId="gearcad" applicationVersion={quoteattr(__version__)} date="{date}" '
            'applicationLanguage="en">'
        )
        yield "  <relations>"
        for number, (kind, order, roles) in enumerate(self._relations, 1):
            placed = "" if order is None else f' order="{order}"'
            yield f'    <relation id="{number}" type="{kind}"{placed}>'
            for role, part in roles.items():
                yield f'      <ref id="{part}" role="{role}" hint="{self._components[part - 1][0]}"/>'
            yield "    </relation>"
        yield "  </relations>"
        yield "  <components>"
        for number, (kind, name, attributes) in enumerate(self._components, 1):
            yield f'    <component id="{number}" type="{kind}" name={quoteattr(name)}>'
            for attribute, value in attributes.items():
                yield f'      <attribute id="{attribute}" unit="{UNITS.get(attribute, "none")}">{_written(value)}</attribute>'
            yield "    </component>"
        yield "  </components>"
        yield "</model>"


def _written(value: RexsValue) -> str:
    """Return the content of an attribute."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"<array>{''.join(f'<c>{_written(each)}</c>' for each in value)}</array>"
    if isinstance(value, str):
        return escape(value)
    return repr(float(value)) if isinstance(value, float) else repr(int(value))


def read_model(path: Path | str) -> RexsModel:
    """Return the model of a file of REXS. Raises SpecError, one line that names the file and what is wrong."""
    file = shown_path(path)
    try:
        content = file_bytes(Path(path))
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise SpecError(f"{file}: cannot be read ({reason}); give a file of REXS (.rexs)") from error
    if content.startswith(b"PK"):
        raise SpecError(f"{file}: is a ZIP archive: unpack it, and give the .rexs file that is in it")
    if content.lstrip()[:1] == b"{":
        raise SpecError(f"{file}: is REXS in JSON, which is not read: save it as XML (.rexs)")
    return model_of(content, file)


def model_of(content: bytes, file: str) -> RexsModel:
    """Return the model of the bytes of a file. Raises SpecError."""
    root = xml_tree(content, file)
    version = root.attributes.get("version", "")
    if root.name != "model":
        raise SpecError(f"{file}: its outermost element is {shown(root.name, 40)}, that of REXS is model")
    if version not in READ_VERSIONS:
        permitted = f"must be from {READ_VERSIONS[0]} to {READ_VERSIONS[-1]}"
        raise SpecError(f"{file}: model: version = {shown(version, 40) or 'missing'}: {permitted}")
    components: dict[int, RexsComponent] = {}
    for section in root.all("components"):
        for element in section.all("component"):
            component = _component(element, file)
            if component.number in components:
                raise SpecError(f"{file}: {component}: its id is there twice")
            components[component.number] = component
    cases = [case for spectrum in root.all("load_spectrum") for case in spectrum.all("load_case")]
    for element in (each for case in cases[:1] for each in case.all("component")):
        loaded = _component(element, file)
        if (own := components.get(loaded.number)) is None:
            raise SpecError(f"{file}: load case: {loaded}: there is no component of this id")
        components[own.number] = replace(own, written=MappingProxyType({**own.written, **loaded.written}))
    relations = [_relation(each, components, file) for section in root.all("relations") for each in section.all("relation")]
    application = root.attributes.get("applicationId", "")
    return RexsModel(file, version, application, MappingProxyType(components), tuple(relations), len(cases))


def _component(element: XmlElement, file: str) -> RexsComponent:
    number = _whole(element.attributes.get("id"), "component", file)
    written = {}
    for each in element.all("attribute"):
        if not (name := each.attributes.get("id", "")):
            raise SpecError(f"{file}: component {number}: an attribute has no id")
        items = tuple(item.text for array in each.all("array") for item in array.all("c"))
        written[name] = WrittenValue(each.text, items, each.attributes.get("unit", "").strip())
    kind, name = element.attributes.get("type", ""), element.attributes.get("name", "")
    return RexsComponent(number, kind, " ".join(name.split()), MappingProxyType(written), file)


def _relation(element: XmlElement, components: Mapping[int, RexsComponent], file: str) -> RexsRelation:
    kind = element.attributes.get("type", "")
    roles = {}
    for each in element.all("ref"):
        number = _whole(each.attributes.get("id"), f"relation {shown(kind, 40)}", file)
        if number not in components:
            raise SpecError(f"{file}: relation {shown(kind, 40)}: there is no component {number}")
        roles[each.attributes.get("role", "")] = number
    order = element.attributes.get("order")
    return RexsRelation(kind, MappingProxyType(roles), None if order is None else _whole(order, "relation, order", file))


def _whole(text: str | None, what: str, file: str) -> int:
    if text is None or not re.fullmatch(r"\d{1,9}", text.strip(), re.ASCII):
        written = "missing" if text is None else shown(text, 40)
        raise SpecError(f"{file}: {what}: id = {written}: must be a whole number")
    return int(text)


def in_order(parts: Sequence[RexsComponent], attribute: str) -> list[RexsComponent]:
    """Return components in the order of a number of theirs. Raises SpecError where one has none."""
    return sorted(parts, key=lambda each: each.needed(attribute))
