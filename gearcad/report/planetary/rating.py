"""The rating of a train's meshes and stages, as a table: a row for each gear."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from gearcad.dynamics.planetary.mesh_rating import TrainRating
from gearcad.per_gear import Role
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import short
from gearcad.plots.planetary.parts import stage_gear
from gearcad.rating.rate import Rating
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.sections import Section, Table, said

__all__ = ["section_of_rating"]

_NONE = "–"  # an en dash where there is no value


def section_of_rating(train: PlanetaryTrain, rating: TrainRating) -> Section:
    """Stresses of all gears, load factors, and what cannot be rated."""
    heads = ("mesh", "gear", "K_A", "K_γ", "K_v", "σ_H0, MPa", "σ_H, MPa", "σ_F0, MPa", "σ_F, MPa", "Y_M")
    rows = [*_of_set(train, rating), *_of_stages(train, rating)]
    unread = [each.verify for each in rating.meshes.values()] + [each.verify for each in rating.stages.values()]
    note = said("rating_note", list(dict.fromkeys(chain.from_iterable(unread))))
    tables = (Table("", grid=WordTable(heads, rows, 2), note=note, symbols=True),) if rows else ()
    unrated = tuple(said("unrated", name, why) for name, why in rating.unrated.items())
    return Section("Rating of the meshes", words=(said("rating_words", rating), *unrated), tables=tables)


def _of_set(train: PlanetaryTrain, rating: TrainRating) -> Iterator[tuple[str, ...]]:
    for mesh in train.meshes:
        if (found := rating.meshes.get(mesh.name)) is None:
            continue
        factors = (found.load.application_factor, found.load.mesh_load_factor.value, found.dynamic_factor)
        names = {mesh.central_role: mesh.central.name, mesh.rim_role: mesh.rim.name}
        for role in (mesh.central_role, mesh.rim_role):
            bends = short(found.mean_stress_factor.pick(role))
            yield (mesh.name, names[role], *map(_or_none, factors), *_stresses(found.rating, role), bends)


def _of_stages(train: PlanetaryTrain, rating: TrainRating) -> Iterator[tuple[str, ...]]:
    for stage in train.stages:
        if (found := rating.stages.get(stage.name)) is not None:
            for role in Role:
                factors = (short(found.application_factor), _NONE, _NONE)
                yield (stage.name, stage_gear(stage, role), *factors, *_stresses(found, role), _NONE)


def _stresses(rating: Rating, role: Role) -> tuple[str, ...]:
    """Nominal contact stress and that under the load factors, the same in the root."""
    values = (
        rating.flank.nominal_stress,
        rating.contact_stresses.pick(role),
        rating.roots.pick(role).nominal_stress,
        rating.root_stresses.pick(role),
    )
    return tuple(map(short, values))


def _or_none(value: float | None) -> str:
    return _NONE if value is None else short(value)
