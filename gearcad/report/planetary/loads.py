"""What acts in a train, as tables: speeds, torques, power, phases and forces."""

from __future__ import annotations

from collections.abc import Mapping

from gearcad.planetary import MeshPhases, PlanetaryTrain
from gearcad.planetary.forces import TrainForces
from gearcad.planetary.harmonics import Excited, train_harmonics
from gearcad.planetary.power import PowerFlow
from gearcad.planetary.speeds import Speeds
from gearcad.plots.paper import short
from gearcad.plots.planetary.parts import power_ways, role_words
from gearcad.report.check.tables import Row
from gearcad.report.dynamics.tables import WordTable
from gearcad.schema import is_assumed

__all__ = ["force_table", "harmonic_table", "phase_table", "pin_rows", "power_rows", "speed_table"]

_NONE = "–"  # an en dash where there is no value


def speed_table(train: PlanetaryTrain, speeds: Speeds, flow: PowerFlow | None, unit: str) -> WordTable:
    """Members, shafts of stages and planets: what each is, its speed, and what acts on it from outside; no speeds at rest."""
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


def power_rows(train: PlanetaryTrain, flow: PowerFlow) -> list[Row]:
    """Efficiencies, losses, and how much rolls through the meshes."""
    assumed = is_assumed(flow.load.mesh_efficiency)
    source, losses = ("assumed", ": mesh_efficiency is not given, no losses are counted") if assumed else ("given", "")
    rows = [
        Row(
            f"efficiency of a mesh, {source}", "η", (short(flow.load.mesh_efficiency),), "", f"with the carrier at rest{losses}"
        ),
        Row(_from_to(train), "", (_percent(flow.efficiency),), "%", "without losses, assumed" if assumed else ""),
    ]
    if flow.efficiency_back is not None:
        words = "self-locking: the output cannot drive" if flow.self_locking else "not self-locking"
        words = "whether it is self-locking is not known: mesh_efficiency is not given" if assumed else words
        rows.append(Row(f"efficiency, {train.output} to {train.input}", "", (_percent(flow.efficiency_back),), "%", words))
    rolling = _NONE if flow.rolling_ratio is None else short(flow.rolling_ratio)
    rows.append(Row("power that rolls, seen from the carrier", "", (short(flow.rolling_power),), "W", ""))
    rows.append(Row("the same over what goes into the set", "", (rolling,), "", flow.circulation))
    rows += [Row(f"lost in {name}", "", (short(lost),), "W", "") for name, lost in flow.losses.items()]
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
    """What the first harmonics of each mesh do: the sums of the planets' forces over those in phase."""
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


def pin_rows(forces: TrainForces) -> list[Row]:
    """Forces on one pin."""
    pin = forces.pin
    rows = [
        Row("radial, outwards", "", (short(pin.radial),), "N", "from the teeth"),
        Row("tangential, counter-clockwise", "", (short(pin.tangential),), "N", "from the teeth"),
    ]
    if pin.centrifugal is not None:
        rows.append(
            Row(
                "centrifugal, outwards",
                "",
                (short(pin.centrifugal),),
                "N",
                "of the planet's own mass",
            )
        )
    known = "" if pin.centrifugal is not None else "without centrifugal force: the planet's mass is not known"
    rows.append(Row("size in the plane of rotation", "", (short(pin.size),), "N", known))
    rows.append(Row("axial", "", (short(pin.axial),), "N", ""))
    rows.append(Row("tilting moment on the planet", "", (short(pin.tilting_moment),), "N·m", "about the middle of its teeth"))
    return rows
