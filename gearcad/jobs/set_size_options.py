"""Options of a search for planetary sets, and the task that they make with those that sets share with pairs.

The command `size --planetary` has an option for each, and the page a field.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import ParameterError, as_choice
from gearcad.jobs.size_options import (
    SIZE_OPTIONS,
    SizeOption,
    ends_of,
    load_of,
    material_of,
    modules_of,
    option_fields,
    rating_of,
    values_of,
)

if TYPE_CHECKING:
    from gearcad.core.quantities import FieldSchema
    from gearcad.material import Material
    from gearcad.sizing.planetary_sets import SetSizeTask


SET_OPTIONS = (
    SizeOption("type", str, "TYPES", "A sun and ring, B stepped planets, C two suns, D two rings.  [default: A]"),
    SizeOption("planets", str, "N[:N]", "how many planets.  [default: 3:5]"),
    SizeOption("input_torque", float, "NM", "on the input; --torque is its old name.", "task.input_torque"),
    SizeOption("output_torque", float, "NM", "on the output.", "task.output_torque"),
    SizeOption("ring_teeth", str, "Z[:Z]", "of rings.  [default: 30:200]"),
    SizeOption("fixed", str, "MEMBER", "sun, ring, carrier, sun_2 or ring_2; so for --in and --out."),
    SizeOption("in", str, "MEMBER", "the input."),
    SizeOption("out", str, "MEMBER", "the output."),
    SizeOption("mesh_load_factor", float, "K_G", "K_gamma.  [default: by the planets, ABS]", "task.mesh_load_factor"),
)
"""The options that only a search for sets has, in the order of use."""

OF_PAIRS = (
    *("centre_distance", "max_mass", "shift", "shift_sum", "max_width", "contact_ratio", "tip_thickness", "rack", "tool", "by"),
    *("friction", "errors"),
)
"""Options of pairs that sets do not have."""

_PLAIN = {"fixed": "fixed", "in": "input", "out": "output", "ratio_tolerance": "tolerance"}
_RANGES = ("planets", "teeth", "ring_teeth")

_OF_SETS = {
    "ratio": "sets.ratio",
    "ratio_tolerance": "sets.tolerance",
    "speed": "task.speed",
    "helix_angle": "sets.helix_angle",
    "width_ratio": "task.width_ratio",
    "max_diameter": "task.max_diameter",
}
"""Fields of the task that options of pairs set in a search for sets."""


def shared_options() -> tuple[SizeOption, ...]:
    """Return the options of pairs that sets have, too, without the torque, which sets call that of the input."""
    return tuple(option for option in SIZE_OPTIONS if option.name not in (*OF_PAIRS, "torque"))


@cache
def set_option_fields() -> Mapping[str, FieldSchema]:
    """Return the field of the task that an option sets, by the name of the option, for its words, unit and range."""
    from gearcad.core.quantities import schema_of
    from gearcad.planetary.tooth_numbers import SearchTask
    from gearcad.sizing.planetary_sets import SetSizeTask

    owners = {"task": schema_of(SetSizeTask), "sets": schema_of(SearchTask)}
    own = {option.name: option.field for option in SET_OPTIONS if option.field} | _OF_SETS
    parted = {name: field.partition(".") for name, field in own.items()}
    return {**option_fields(), **{name: owners[table][field] for name, (table, _, field) in parted.items()}}


def set_task_of(given: Mapping[str, Any]) -> SetSizeTask:
    """The task of the options that are given. Raises ParameterError."""
    from gearcad.planetary.members import SetType
    from gearcad.planetary.tooth_numbers import SearchTask
    from gearcad.sizing.planetary_sets import SetSizeTask

    for name in OF_PAIRS:
        if given.get(name) is not None:
            raise ParameterError(name, given[name], "applies to pairs only: leave it out with --planetary")
    for needed, what in (("ratio", "speed of the input over that of the output"), ("material", 'such as "Eh MQ"')):
        if given[needed] is None:
            raise ParameterError(needed, None, f"must be given, {what}")
    fields: dict[str, Any] = {field: given[name] for name, field in _PLAIN.items() if given[name] is not None}
    fields |= {name: ends_of(name, given[name]) for name in _RANGES if given[name] is not None}
    if given["type"] is not None:
        fields["types"] = tuple(as_choice("type", each.strip().upper(), SetType) for each in given["type"].split(","))
    if given["helix_angle"] is not None:
        fields["helix_angle"] = _single("helix_angle", values_of("helix_angle", given["helix_angle"]))
    others: dict[str, Any] = {name: given[name] for name in ("mesh_load_factor", "max_diameter") if given[name] is not None}
    if given["width_ratio"] is not None:
        others["width_ratio"] = max(values_of("width_ratio", given["width_ratio"]))
    if given["module"] is not None or given["second_series"]:
        others["modules"] = modules_of("0.5:50" if given["module"] is None else given["module"], second=given["second_series"])
    torques: dict[str, Any] = {name: given[name] for name in ("input_torque", "output_torque") if given[name] is not None}
    if len(torques) > 1 or (torques and (given["torque"] is not None or given["power"] is not None)):
        name, value = torques.popitem()
        permitted = "must be the only one of --input-torque, --output-torque, --power and --torque"
        raise ParameterError(name, value, permitted, "N·m")
    if not torques and given["torque"] is None and given["power"] is None:
        raise ParameterError("input_torque", None, "must be given, in N·m, or --output-torque, or --power in kW")
    load = load_of({**given, "torque": 1.0} if torques else given)
    if not torques:
        torques = {"torque" if given["power"] is None else "input_torque": load.torque}
    return SetSizeTask(
        sets=SearchTask(ratio=given["ratio"], module=1.0, **fields),
        **torques,
        speed=load.speed,
        application_factor=load.application_factor,
        material=material_of("material", given["material"], given["hardness"]),
        ring_material=_of_rings(given),
        rating=rating_of(given),
        **others,
    )


def _of_rings(given: Mapping[str, Any]) -> Material | None:
    """The one of a wheel is here that of rings."""
    if given["wheel_material"] is None and given["wheel_hardness"] is None:
        return None
    name, hardness = given["material" if given["wheel_material"] is None else "wheel_material"], given["wheel_hardness"]
    found: Material = material_of("wheel_material", name, hardness)
    return found


def _single(name: str, values: tuple[float, ...]) -> float:
    if len(values) != 1:
        raise ParameterError(name, list(values), "must be one number with --planetary, of the first sun or ring")
    return values[0]
