"""Tables of a planetary train: its gears, assembly, speeds, torques, power, phases and forces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from gearcad.core.records import Role, is_assumed
from gearcad.geometry import Gear, GearPair
from gearcad.planetary import MeshPhases, PlanetaryTrain
from gearcad.planetary.poses import Excited, train_harmonics
from gearcad.planetary.power import PowerFlow, TrainForces
from gearcad.planetary.train import least_gap
from gearcad.planetary.train_data import Speeds
from gearcad.plots.paper import short
from gearcad.plots.planetary import power_ways, role_words, stage_gear
from gearcad.report.document import ReportRow
from gearcad.report.dynamics_tables import WordTable

_LISTED = 6
"""Largest number of angles that have room in a line."""


def gear_table(train: PlanetaryTrain) -> WordTable:
    """All gears with their signs: the set's, then those of stages."""
    heads = ("gear", "", "z", "m_n, mm", "β, °", "x", "b, mm", "d, mm", "d_b, mm", "d_a, mm", "d_f, mm")
    rows = [(name, what, *_gear(gear)) for name, what, gear in _gears(train)]
    return WordTable(heads, rows, 2)


def _gears(train: PlanetaryTrain) -> Iterator[tuple[str, str, Gear]]:
    for central in train.centrals:
        yield central.name, "ring" if central.gear.internal else "sun", central.gear
    for rim in train.rims:
        yield rim.name, f"planet, {train.planets} of them" if train.planets > 1 else "planet", rim.gear
    for stage in train.stages:
        for role, shaft in ((Role.PINION, stage.pinion), (Role.WHEEL, stage.wheel)):
            yield stage_gear(stage, role), f"{stage.name}, turns with {shaft}", stage.pair.gears.pick(role)


def _gear(gear: Gear) -> tuple[str, ...]:
    diameters = (gear.reference_diameter, gear.base_diameter, gear.tip_diameter, gear.root_diameter)
    numbers = (gear.normal_module, gear.helix_angle, gear.profile_shift, gear.face_width, *diameters)
    return (str(gear.teeth), *map(short, numbers))


def mesh_table(train: PlanetaryTrain) -> WordTable:
    """All pairs that mesh; centre distances are signed, those of rings below 0."""
    heads = (
        "mesh",
        "z",
        "a, mm",
        "without backlash, mm",
        "Σx",
        "α_wt, °",
        "ε_α",
        "ε_β",
        "backlash j_wt, mm",
    )
    rows = [_mesh(mesh.name, (mesh.central.gear, mesh.rim.gear), mesh.pair) for mesh in train.meshes]
    rows += [_mesh(stage.name, (stage.pair.pinion, stage.pair.wheel), stage.pair) for stage in train.stages]
    return WordTable(heads, rows, 2)


def _mesh(name: str, gears: tuple[Gear, Gear], pair: GearPair) -> tuple[str, ...]:
    """A row; the teeth of the gears in the order of their names in that of the mesh."""
    numbers = (
        pair.centre_distance,
        pair.centre_distance_for(pair.profile_shift_sum),
        pair.profile_shift_sum,
        pair.working_transverse_pressure_angle,
        pair.transverse_contact_ratio,
        pair.overlap_ratio,
        _rounded(pair.circumferential_backlash),
    )
    return (name, " / ".join(str(gear.teeth) for gear in gears), *map(short, numbers))


def assembly_rows(train: PlanetaryTrain) -> list[ReportRow]:
    """Return the rows of the conditions for assembly of the train, with their numbers."""
    distance = float(train.centre_distance)
    rows = [ReportRow("centre distance of both meshes", "a", (short(distance),), "mm", "planets turn on one axis")]
    if train.planets > 1:
        gap = least_gap(train)
        apart = 2 * distance * math.sin(math.radians(gap.angle) / 2)
        first, second = (planet + 1 for planet in gap.planets)
        rows.append(
            ReportRow(
                f"axes of planets {first} and {second}, the nearest", "", (short(apart),), "mm", f"{short(gap.angle)}° apart"
            )
        )
        for rim in train.rims:
            tip = rim.gear.tip_diameter
            rows.append(
                ReportRow(f"room between tips of {rim.name}", "", (short(apart - tip),), "mm", f"tip diameter {short(tip)} mm")
            )
    rows += [
        ReportRow(
            "places where the teeth let a planet stand",
            "q",
            (str(train.positions),),
            "",
            "of a full turn, by the teeth of all gears",
        ),
        ReportRow("places for a planet", "q/N", (short(train.positions / train.planets),), "", _spacing(train)),
        ReportRow("angles of the planets", "ψ", (_angles(train),), "°", "from +x, counter-clockwise"),
        ReportRow(
            "pull of the planets outwards, of one", "|Σ exp(iψ)|", (short(_rounded(train.unbalance)),), "", _balance(train)
        ),
    ]
    return rows


def _angles(train: PlanetaryTrain) -> str:
    """All of them, or of many the first and the last: the phases have all."""
    words = list(map(short, train.angles))
    return ", ".join(words if len(words) <= _LISTED else [*words[:2], "...", words[-1]])


def _spacing(train: PlanetaryTrain) -> str:
    if train.positions % train.planets == 0:
        return "whole: equal angles let the teeth fit"
    return f"not whole: angles are multiples of 360°/{train.positions} from the first"


def _balance(train: PlanetaryTrain) -> str:
    if _rounded(train.unbalance):
        return "they do not balance each other" if train.planets > 1 else "a planet alone is not balanced"
    return "they balance each other"


def _rounded(value: float) -> float:
    """Return the value, or 0 if it is only rounding."""
    return value if abs(value) > 1e-9 else 0.0


_NONE = "–"  # an en dash where there is no value


def speed_table(train: PlanetaryTrain, speeds: Speeds, flow: PowerFlow | None, unit: str) -> WordTable:
    """Return the table of members, shafts of stages and planets: kind, speed and outer torque of each.

    At rest it has no speeds.
    """
    rests = not any(speeds.members.values())

    def turned(value: float) -> str:
        return _NONE if rests else short(value)

    heads: tuple[str, ...] = ("member or shaft", "", f"speed, {unit}")
    if flow is not None:
        heads = (*heads, "torque from outside, N·m", "power in, W", "torque on the set, N·m")
    rows: list[tuple[str, ...]] = []
    ways = power_ways(train, flow)
    for name, speed in speeds.members.items():
        row: tuple[str, ...] = (name, role_words(train, name, ways), turned(speed))
        if flow is not None:
            of_set = short(flow.set_torques[name]) if name in flow.set_torques else _NONE
            row = (*row, short(flow.torques.get(name, 0.0)), turned(flow.powers.get(name, 0.0)), of_set)
        rows.append(row)
    blank = (_NONE,) * (len(heads) - 3)
    rows.append(("planets", "", turned(speeds.planet), *blank))
    rows.append(("planets on their pins", "against the carrier", turned(speeds.planet_relative), *blank))
    return WordTable(heads, rows, 2)


def power_rows(train: PlanetaryTrain, flow: PowerFlow) -> list[ReportRow]:
    """Return rows of efficiencies, losses, and the power that flows through the meshes."""
    assumed = is_assumed(flow.load.mesh_efficiency)
    source, losses = ("assumed", ": mesh_efficiency is not given, no losses are counted") if assumed else (flow.source, "")
    rows = [
        ReportRow(
            f"efficiency of a mesh, {source}", "η", (short(flow.load.mesh_efficiency),), "", f"with the carrier at rest{losses}"
        ),
        ReportRow(_from_to(train), "", (_percent(flow.efficiency),), "%", "without losses, assumed" if assumed else ""),
    ]
    if flow.efficiency_back is not None:
        words = "self-locking: the output cannot drive" if flow.self_locking else "not self-locking"
        words = "whether it is self-locking is not known: mesh_efficiency is not given" if assumed else words
        rows.append(
            ReportRow(f"efficiency, {train.output} to {train.input}", "", (_percent(flow.efficiency_back),), "%", words)
        )
    rolling = _NONE if flow.rolling_ratio is None else short(flow.rolling_ratio)
    rows.append(ReportRow("power that rolls, seen from the carrier", "", (short(flow.rolling_power),), "W", ""))
    rows.append(ReportRow("the same over what goes into the set", "", (rolling,), "", flow.circulation))
    rows += [ReportRow(f"lost in {name}", "", (short(lost),), "W", "") for name, lost in flow.losses.items()]
    return rows


def _from_to(train: PlanetaryTrain) -> str:
    if train.fixed is None:
        return "efficiency: all power that goes out over all that goes in"
    return f"efficiency, {train.input} to {train.output}"


def _percent(share: float | None) -> str:
    if share is None:
        return _NONE
    return short(100 * share) if share > 0 else "none: it locks"


def phase_table(train: PlanetaryTrain, phases: Mapping[str, MeshPhases]) -> WordTable:
    """Phases of both meshes by planets, in base pitches."""
    rows = [
        (name, str(planet), short(angle), f"{ahead:.4f}", f"{relative:.4f}")
        for name, each in phases.items()
        for planet, (angle, ahead, relative) in enumerate(zip(train.angles, each.ahead, each.relative, strict=True), 1)
    ]
    return WordTable(("mesh", "planet", "at, °", "ahead, base pitches", "against planet 1"), rows)


def harmonic_table(train: PlanetaryTrain, phases: Mapping[str, MeshPhases]) -> WordTable:
    """Return the table of the first harmonics of each mesh: sums of the planets' forces over those in phase."""
    rows = [
        (f"{each.harmonic} × {name}", _excites(each.excited), f"{each.torque:.3f}", f"{each.force:.3f}")
        for name, sums in train_harmonics(train, dict(phases)).items()
        for each in sums
    ]
    return WordTable(("harmonic", "modes that it can excite", "torque", "force"), rows, 2)


def _excites(excited: Excited) -> str:
    kinds = [kind for kind, shaken in zip(("rotational", "translational"), excited, strict=True) if shaken]
    return " and ".join(kinds) or "only those in which members rest"


def force_table(forces: TrainForces) -> WordTable:
    """Forces of all meshes."""
    heads = ("mesh", "", "along the line of action, N", "tangential, N", "radial, N", "axial, N")
    rows = []
    for meshes, what in ((forces.meshes, "on one planet"), (forces.stages, "on the wheel")):
        for name, force in meshes.items():
            numbers = (force.normal, force.tangential, force.radial, force.axial)
            rows.append((name, what, *map(short, numbers)))
    return WordTable(heads, rows, 2)


def pin_rows(forces: TrainForces) -> list[ReportRow]:
    """Forces on one pin."""
    pin = forces.pin
    rows = [
        ReportRow("radial, outwards", "", (short(pin.radial),), "N", "from the teeth"),
        ReportRow("tangential, counter-clockwise", "", (short(pin.tangential),), "N", "from the teeth"),
    ]
    if pin.centrifugal is not None:
        rows.append(
            ReportRow(
                "centrifugal, outwards",
                "",
                (short(pin.centrifugal),),
                "N",
                "of the planet's own mass",
            )
        )
    known = "" if pin.centrifugal is not None else "without centrifugal force: the planet's mass is not known"
    rows.append(ReportRow("size in the plane of rotation", "", (short(pin.size),), "N", known))
    rows.append(ReportRow("axial", "", (short(pin.axial),), "N", ""))
    rows.append(
        ReportRow("tilting moment on the planet", "", (short(pin.tilting_moment),), "N·m", "about the middle of its teeth")
    )
    return rows
