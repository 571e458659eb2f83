"""Random pairs with everything that a file of REXS may have to carry, and what differs between two designs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

from gearcad.core.errors import GearcadError
from gearcad.designs import Design
from gearcad.designs.design import tables_of_text
from gearcad.designs.reader import design_from_tables
from gearcad.designs.spec_writers import SpecTables, toml_text


def random_pairs(count: int, seed: int) -> Iterator[Design]:
    """Yield so many pairs; those that the random numbers make impossible are tried again."""
    dice, made = Random(seed), 0
    while made < count:
        try:
            design = design_of(toml_text(_tables(dice)))
        except GearcadError:
            continue
        made += 1
        yield design


def design_of(text: str) -> Design:
    """Return the design of the text of a spec."""
    tables, where = tables_of_text(text, "random.toml", Path())
    return design_from_tables(tables, where=where, default_name="random")


def differences(first: Design, second: Design) -> list[tuple[str, Any, Any]]:
    """Return the figures of two designs that differ by more than 1e-12 of their size, with their names."""
    ours, theirs = dict(_flat(first.to_dict())), dict(_flat(second.to_dict()))
    assert len(ours) > 40
    return [(key, ours.get(key), theirs.get(key)) for key in {**ours, **theirs} if not _same(ours.get(key), theirs.get(key))]


def _flat(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, each in value.items():
            yield from _flat(each, f"{name}.{key}")
    elif isinstance(value, list | tuple):
        yield f"{name}.count", len(value)
        for at, each in enumerate(value):
            yield from _flat(each, f"{name}[{at}]")
    else:
        yield name, value


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, float) and isinstance(other, float):
        return one == other or math.isclose(one, other, rel_tol=1e-12, abs_tol=1e-12)
    return bool(one == other and type(one) is type(other))


def _size(dice: Random, low: float, high: float) -> float:
    """Return a number with all its digits, or a short one as people type it."""
    value = dice.uniform(low, high)
    return value if dice.random() < 0.5 else round(value, 2)


def _tables(dice: Random) -> SpecTables:
    module = _size(dice, 1.0, 6.0)
    ring, single_helix = dice.random() < 0.25, dice.choice([0.0, _size(dice, 5.0, 28.0)])
    pair: dict[str, Any] = {"name": f"pair-{dice.randrange(1000)}", "face_width": _size(dice, 8 * module, 14 * module)}
    pair["helix_angle"] = single_helix
    pair |= {
        "helix_angle": single_helix,
    }
    if dice.random() < 0.2:
        pair["normal_diametral_pitch"] = 25.4 / module
    else:
        pair["normal_module"] = module
    zero = dice.random() < 0.3
    teeth = dice.randrange(17, 34)
    wheel_teeth = -dice.randrange(60, 120) if ring else dice.randrange(24, 90)
    angle = dice.choice([20.0, 20.0, 17.5, 25.0])
    pinion, wheel = (dict(_gear(dice, module, angle, internal=is_ring)) for is_ring in (False, ring))
    pinion["teeth"], wheel["teeth"] = teeth, wheel_teeth
    shifts = (0.0, 0.0) if zero else (_size(dice, 0.0, 0.5), _size(dice, -0.3, 0.4))
    pinion["profile_shift"], wheel["profile_shift"] = shifts
    if dice.random() < 0.2:
        pair["centre_distance_tolerance"] = "js7"
    tables: SpecTables = {"pair": pair, "pinion": pinion, "wheel": wheel}
    _beside(dice, tables)
    if dice.random() < 0.4:
        tables |= _shafts(dice, pair["face_width"], pinion, wheel, ring=ring)
    return tables


def _gear(dice: Random, module: float, angle: float, *, internal: bool) -> Iterator[tuple[str, Any]]:
    yield "rack.pressure_angle", angle
    kind = dice.choice(["rack", "full", "cut", "cutter", "finished"])
    if internal and dice.random() < 0.7:
        kind = "cutter"
    if kind == "cutter":
        yield from {"cutter.teeth": dice.randrange(20, 30), "cutter.profile_shift": _size(dice, -0.1, 0.2)}.items()
        yield "cutter.tip_radius", _size(dice, 0.0, 0.2)
    elif kind == "cut":
        yield from {"rack.addendum": _size(dice, 0.9, 1.0), "rack.dedendum": _size(dice, 1.2, 1.3)}.items()
        yield "rack.root_radius", _size(dice, 0.2, 0.3)
    elif kind == "full" and angle == 20.0 and not internal:
        yield "rack.root_radius", "full"
    elif kind == "finished" and not internal:
        yield from {"premachining.stock": _size(dice, 0.03, 0.08) * module, "premachining.tool_tip_radius": 0.25}.items()
        if dice.random() < 0.5:
            yield from {"premachining.protuberance": 0.12 * module, "premachining.protuberance_angle": 8.0}.items()
        yield "premachining.tool_addendum", _size(dice, 1.35, 1.4)
    if dice.random() < 0.5:
        yield "tooth_thinning", _size(dice, 0.0, 0.04) * module
    elif dice.random() < 0.4:
        yield "tooth_allowance", dice.choice(["cd25", "e26", "bc24"])
    if not internal and dice.random() < 0.4:
        yield from {"body.bore": round(4 * module, 1), "body.end_chamfer": 0.1 * module}.items()
    if dice.random() < 0.3:
        yield "body.tip_chamfer", _size(dice, 0.02, 0.06) * module
    for amount, length in (("tip_relief", 0.2 * module), ("root_relief", 0.1 * module), ("end_relief", 2 * module)):
        if dice.random() < 0.4:
            yield from {f"modification.{amount}": _size(dice, 3.0, 20.0), f"modification.{amount}_length": length}.items()
    for key in ("profile_crowning", "lead_crowning", "pressure_angle_modification", "helix_angle_modification", "twist"):
        if dice.random() < 0.3:
            yield f"modification.{key}", _size(dice, 1.0, 9.0)
    yield from {"flank_roughness": _size(dice, 1.0, 6.0), "root_roughness": _size(dice, 6.0, 20.0)}.items()


def _beside(dice: Random, tables: SpecTables) -> None:
    steel = {"youngs_modulus": _size(dice, 2.0e5, 2.1e5), "poisson_ratio": 0.3, "density": _size(dice, 7700.0, 7900.0)}
    hard = {"name": "steel & <iron>", "group": "Eh", "quality": "MQ", "hardness": 700.0, "contact_endurance_limit": 1500.0}
    if dice.random() < 0.4:
        tables["material"] = {**steel, **hard}
    elif dice.random() < 0.5:
        tables["pinion.material"] = {**hard, "core_hardness": 30.0, "root_endurance_limit": 460.0}
        if dice.random() < 0.5:
            tables["wheel.material"] = {**steel, "name": "42CrMo4", "group": "V", "hardness": 300.0, "yield_strength": 800.0}
    if dice.random() < 0.7:
        tables["load"] = {"torque": _size(dice, 5.0, 400.0) * dice.choice([1, 1, -1])}
        if dice.random() < 0.7:
            tables["load"] |= {"speed": _size(dice, 10.0, 3000.0), "application_factor": _size(dice, 1.0, 1.75)}
        oil = {"oil_viscosity_40": 220.0, "oil_viscosity_100": 19.0, "oil_density": _size(dice, 850.0, 900.0)}
        tables["rating"] = {**oil, "oil_temperature": _size(dice, 40.0, 90.0), "life": 20000.0, "accuracy_grade": 6}
    if dice.random() < 0.3:
        tables["mounting"] = {"misalignment": _size(dice, 1.0, 9.0)}
    if dice.random() < 0.3:
        tables["drawing"] = {"title": 'Rädersatz "A" <1> & 2', "number": "00-1"}


def _shafts(dice: Random, width: float, pinion: dict[str, Any], wheel: dict[str, Any], *, ring: bool) -> SpecTables:
    tables: SpecTables = {"shafts": {"mesh_angle": _size(dice, -90.0, 90.0), "gravity": [0.0, 0.0, -9.81]}}
    for name, gear in (("pinion", pinion), ("wheel", wheel)):
        ends = [_size(dice, 20.0, 60.0), width, _size(dice, 20.0, 60.0)]
        gear["mesh_position"], gear["coupling"] = ends[0] + width / 2, dice.choice([0.0, sum(ends)])
        if name == "wheel" and ring:
            gear["mesh_position"] = ends[0] + 0.5 * width
        tables[f"{name}.shaft"] = [
            {"length": length, "outer_diameter": _size(dice, 20.0, 40.0), "inner_diameter": dice.choice([0.0, 6.0])}
            for length in ends
        ]
        first: dict[str, Any] = {"name": "fixed", "position": 10.0, "radial_stiffness": _size(dice, 50.0, 400.0)}
        first |= {"axial_stiffness": dice.choice(["rigid", 60.0]), "tilting_stiffness": _size(dice, 0.0, 50.0)}
        kinds: dict[str, dict[str, Any]] = {
            "deep groove": {"C": 27000.0, "C0": 15300.0, "f0": 13.8, "pitch_diameter": 53.5},
            "tapered": {"C": 45000.0, "C0": _size(dice, 40000.0, 50000.0), "e": 0.37, "Y": 1.6, "pushes": "right"},
            "cylindrical": {"C": _size(dice, 4e4, 6e4), "C0": 52000.0, "C_u": 6400.0},
        }
        kind = dice.choice([*kinds, None])
        second: dict[str, Any] = {"position": sum(ends) - 10.0, "offset": [_size(dice, -9.0, 9.0), 3.0]}
        if kind is not None:
            second |= {"kind": kind, **kinds[kind]}
        tables[f"{name}.bearing"] = [first, second]
        if dice.random() < 0.5:
            force: dict[str, Any] = {"position": 5.0, "force": [_size(dice, -50.0, 50.0), 20.0, 7.0]}
            force |= dice.choice([{"at": [_size(dice, 1.0, 30.0), 4.0]}, {"moment": [1.5, _size(dice, 0.1, 2.0)]}, {}])
            tables[f"{name}.force"] = [force]
    return tables
