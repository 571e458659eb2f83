"""The materials of gears that mesh: [material] of all, a name in it for one, and a table of a gear's own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from gearcad.designs.spec import Given, Spec
from gearcad.errors import SpecError, format_number
from gearcad.material import Grade, Material, MaterialGroup, MaterialQuality, grade_of
from gearcad.schema import schema_of

__all__ = ["common_material", "materials_of"]

_TABLE = "material"


def materials_of(spec: Spec, gears: Sequence[str]) -> Material | dict[str, Material] | None:
    """That of all gears; by gear where any has its own; None where the spec says nothing. Raises SpecError.

    What stands in a gear's own table counts before its name in [material], and that before the rest of [material]. A name
    such as "Eh MQ" takes the place of group and quality, and a group or a quality that of such a name.
    """
    common = _common(spec, gears)
    own = {gear: _own(spec, gear) for gear in gears}
    if not any(own.values()):
        return common_material(spec, gears) if common else None
    return {gear: _made(spec, gear, _merged(common, layers)) for gear, layers in own.items()}


def common_material(spec: Spec, gears: Sequence[str]) -> Material:
    """That of what has none of its own. Raises SpecError."""
    values = {key: given.value for key, given in _common(spec, gears).items()}
    return spec.simple(_TABLE, Material, values=values)


def _common(spec: Spec, gears: Sequence[str]) -> dict[str, Given]:
    """What [material] says of all gears."""
    common = {key: given for key, given in spec.given_of(_TABLE).items() if key not in gears}
    for key in common.keys() - schema_of(Material).keys():
        full = f"{_TABLE}.{key}"
        there = f"those here are {' and '.join(gears)}" if gears else "here it is that of [material]: write name"
        raise SpecError(f"{spec.where(full)}: {full}: is the material of one gear among several; {there}", full)
    return common


def _own(spec: Spec, gear: str) -> list[Mapping[str, Given]]:
    """What a spec says of the material of one gear, the last of which counts most."""
    layers: list[Mapping[str, Given]] = []
    if (named := spec.values.get(f"{_TABLE}.{gear}")) is not None:
        if not isinstance(named.value, str) or grade_of(named.value) is None:
            raise SpecError(f"{spec.where(named.key)}: {named.key} = {format_number(named.value)}: {_permitted()}", named.key)
        layers.append({"name": named})
    if table := spec.given_of(f"{gear}.{_TABLE}"):
        layers.append(table)
    return layers


def _permitted() -> str:
    groups = ", ".join(group.value for group in MaterialGroup)
    qualities = ", ".join(quality.value for quality in MaterialQuality)
    return f'must be a group and a quality of ISO 6336-5, such as "Eh MQ": {groups}; {qualities}'


def _merged(common: Mapping[str, Given], layers: Sequence[Mapping[str, Given]]) -> dict[str, Given]:
    """The values of all layers, each in place of those before it."""
    merged = dict(common)
    for layer in layers:
        if "name" in layer and _grade(layer["name"]) is not None:
            merged = {key: given for key, given in merged.items() if key not in Grade._fields}
        elif not layer.keys().isdisjoint(Grade._fields) and (grade := _grade(name := merged.get("name"))) and name:
            del merged["name"]
            merged |= {key: name._replace(value=value) for key, value in grade._asdict().items()}
        merged |= layer
    return merged


def _grade(name: Given | None) -> Grade | None:
    return grade_of(name.value) if name is not None and isinstance(name.value, str) else None


def _made(spec: Spec, gear: str, values: Mapping[str, Given]) -> Material:
    """The material of a gear; errors name the key that was written."""
    for key, given in values.items():
        spec.values[f"{gear}.{_TABLE}.{key}"] = given
    return spec.simple(f"{gear}.{_TABLE}", Material, values={key: given.value for key, given in values.items()})
