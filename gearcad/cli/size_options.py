"""Options of the command `size`, of pairs and of planetary sets, and the task of sets that they make."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.core.errors import ParameterError, as_choice
from gearcad.jobs.size_options import SIZE_OPTIONS

if TYPE_CHECKING:
    from gearcad.material import Material
    from gearcad.sizing.planetary_sets import SetSizeTask


Command = TypeVar("Command", bound=Callable[..., Any])

_SECOND = "Modules of ISO 54 series II within a range, too."
_RATING = "Any key of [rating], such as helix_modification=crowning; repeat it."


def size_options(command: Command) -> Command:
    """The options of a task."""
    command = click.option("--rating", "rating", multiple=True, metavar="KEY=VALUE", help=_RATING)(command)
    command = click.option("--second-series", is_flag=True, help=_SECOND)(command)
    for option in reversed(SIZE_OPTIONS):
        name = f"--{option.name.replace('_', '-')}"
        command = click.option(name, option.name, type=option.type, metavar=option.metavar, help=option.help)(command)
    return command


_OPTIONS: tuple[tuple[str, dict[str, Any]], ...] = (
    (
        "--type",
        {"metavar": "TYPES", "help": "Sets: A sun and ring, B stepped planets, C two suns, D two rings.  [default: A]"},
    ),
    ("--planets", {"metavar": "N[:N]", "help": "Sets: how many planets.  [default: 3:5]"}),
    ("--input-torque", {"type": float, "metavar": "NM", "help": "Sets: on the input; --torque is its old name."}),
    ("--output-torque", {"type": float, "metavar": "NM", "help": "Sets: on the output."}),
    ("--ring-teeth", {"metavar": "Z[:Z]", "help": "Sets: of rings.  [default: 30:200]"}),
    ("--fixed", {"metavar": "MEMBER", "help": "Sets: sun, ring, carrier, sun_2 or ring_2; so for --in and --out."}),
    ("--in", {"metavar": "MEMBER", "help": "Sets: the input."}),
    ("--out", {"metavar": "MEMBER", "help": "Sets: the output."}),
    ("--mesh-load-factor", {"type": float, "metavar": "K_G", "help": "Sets: K_gamma.  [default: by the planets, ABS]"}),
)

_OF_PAIRS = (
    *(
        "centre_distance",
        "max_mass",
        "shift",
        "shift_sum",
        "max_width",
        "contact_ratio",
        "tip_thickness",
        "rack",
        "by",
        "errors",
    ),
)
"""Options of pairs that sets do not have."""

_PLAIN = {"fixed": "fixed", "in": "input", "out": "output", "ratio_tolerance": "tolerance"}
_RANGES = ("planets", "teeth", "ring_teeth")


def set_options(command: Command) -> Command:
    """The options of planetary sets."""
    for name, how in reversed(_OPTIONS):
        command = click.option(name, name.lstrip("-").replace("-", "_"), **how)(command)
    text = "Planetary sets in place of pairs; speed of the input."
    return click.option("--planetary", is_flag=True, help=text)(command)


def require_no_sets(given: Mapping[str, Any]) -> None:
    """Raise ParameterError for an option of sets where pairs are wanted."""
    for option, _ in _OPTIONS:
        name = option.lstrip("-").replace("-", "_")
        if given[name] is not None:
            raise ParameterError(name, given[name], "applies to planetary sets only: needs --planetary")


def set_task_of(given: Mapping[str, Any]) -> SetSizeTask:
    """The task of the options that are given. Raises ParameterError."""
    from gearcad.jobs.size_options import ends_of, load_of, material_of, modules_of, rating_of, values_of
    from gearcad.planetary.members import SetType
    from gearcad.planetary.tooth_numbers import SearchTask
    from gearcad.sizing.planetary_sets import SetSizeTask

    for name in _OF_PAIRS:
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
    from gearcad.jobs.size_options import material_of

    if given["wheel_material"] is None and given["wheel_hardness"] is None:
        return None
    name, hardness = given["material" if given["wheel_material"] is None else "wheel_material"], given["wheel_hardness"]
    found: Material = material_of("wheel_material", name, hardness)
    return found


def _single(name: str, values: tuple[float, ...]) -> float:
    if len(values) != 1:
        raise ParameterError(name, list(values), "must be one number with --planetary, of the first sun or ring")
    return values[0]
