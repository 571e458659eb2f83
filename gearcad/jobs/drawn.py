"""What the sheets of a design are made from: its gears with material and accuracy, and what they make together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.designs import GearDesign, PairDesign, PlanetaryDesign, RackDesign, RackPairDesign, ToothedDesign
from gearcad.drawing.subject import DrawnGear, DrawnPair, DrawnTrain, Mate
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.material import Material
from gearcad.planetary.materials import material_of
from gearcad.rating.options import RatingOptions
from gearcad.schema import is_assumed

__all__ = ["drawn_assembly", "drawn_gears"]


def drawn_gears(design: ToothedDesign) -> tuple[DrawnGear, ...]:
    """Each gear or rack of a design, with those it engages with; of those of a train that are alike in all the first."""
    if isinstance(design, RackDesign):
        return (DrawnGear(role="rack", gear=design.rack, material=design.material),)
    if isinstance(design, GearDesign):
        return (_drawn(design, "gear", design.gear, design.material),)
    if isinstance(design, RackPairDesign):
        return _of_pair(design, ("pinion", "rack"), design.pair)
    if isinstance(design, PairDesign):
        return _of_pair(design, ("pinion", "wheel"), design.pair)
    if isinstance(design, PlanetaryDesign):
        return tuple(_of_train(design))
    raise NotImplementedError(type(design))


def drawn_assembly(design: ToothedDesign) -> DrawnPair | DrawnTrain | None:
    """What the gears of a design make together; None of one that is by itself."""
    if isinstance(design, PairDesign | RackPairDesign):
        first, second = drawn_gears(design)
        return DrawnPair(name=design.name, pair=design.pair, parts=(first, second))
    if isinstance(design, PlanetaryDesign):
        return DrawnTrain(name=design.name, train=design.train, parts=tuple(_gears_of_train(design)))
    return None


def _of_pair(
    design: PairDesign | RackPairDesign, roles: tuple[str, str], pair: GearPair | RackPair
) -> tuple[DrawnGear, DrawnGear]:
    gears: tuple[Gear, Gear | Rack] = (pair.pinion, pair.wheel if isinstance(pair, GearPair) else pair.rack)
    materials = (None, None) if design.material is None else design.materials
    first, second = (
        _drawn(design, role, gear, material, (_mate(design, other, mate, pair),))
        for role, gear, material, other, mate in zip(roles, gears, materials, roles[::-1], gears[::-1], strict=True)
    )
    return first, second


def _of_train(design: PlanetaryDesign) -> Iterator[DrawnGear]:
    """Those that differ in more than their name and mates."""
    seen: list[tuple[object, ...]] = []
    for drawn in _gears_of_train(design):
        what = (replace(drawn.gear, name="any"), drawn.material, drawn.grade, design.drawings.get(drawn.role))
        if what not in seen:
            seen.append(what)
            yield drawn


def _gears_of_train(design: PlanetaryDesign) -> Iterator[DrawnGear]:
    """All of them, by the names of members, rims, and gears of stages."""
    mates: dict[str, tuple[Mate, ...]] = {}
    meshes = [(mesh.pair, (mesh.central.name, mesh.rim.name)) for mesh in design.train.meshes]
    meshes += [(stage.pair, (stage.pair.pinion.name, stage.pair.wheel.name)) for stage in design.train.stages]
    gears = design.train.gears
    for pair, (first, second) in meshes:
        for name, other in ((first, second), (second, first)):
            mates[name] = (*mates.get(name, ()), _mate(design, other, gears[other], pair))
    for name, gear in gears.items():
        material = None if design.material is None else material_of(design.material, name)
        yield _drawn(design, name, gear, material, mates[name])


def _mate(design: ToothedDesign, name: str, gear: Gear | Rack, pair: GearPair | RackPair) -> Mate:
    own = design.drawings.get(name)
    return Mate(name=name, number=own.number or "" if own is not None else "", gear=gear, pair=pair)


def _drawn(
    design: ToothedDesign, role: str, gear: Gear | Rack, material: Material | None, mates: tuple[Mate, ...] = ()
) -> DrawnGear:
    """With the accuracy that its rating goes by, its own before that of all."""
    rating: RatingOptions | None = getattr(design, "rating", None)
    grade = gear.accuracy_grade if isinstance(gear, Gear) else None
    if grade is None and rating is not None and not is_assumed(rating.accuracy_grade):
        grade = rating.accuracy_grade
    accuracy = (rating or RatingOptions()).accuracy
    return DrawnGear(role=role, gear=gear, material=material, accuracy=accuracy, grade=grade, mates=mates)
