"""A planetary train posed in mesh: every part named and coloured, alike ones one solid, planets as assemblies of their rims."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.planetary import PlanetaryTrain
from gearcad.solids.colours import TRAIN_COLOURS
from gearcad.solids.exact.carrier import carrier_solid
from gearcad.solids.exact.solid import gear_solid
from gearcad.solids.train_layout import Standing
from gearcad.solids.train_plan import TrainPlan

if TYPE_CHECKING:
    import cadquery

__all__ = ["PRODUCT", "assembly_of", "train_assembly"]

PRODUCT = "product"
"""In the metadata of a part of an assembly: what it is called as a product, where its own name is that of one of many."""


def train_assembly(
    train: PlanetaryTrain, *, carrier_angle: float = 0.0, carrier: bool = False, exploded: bool = False
) -> cadquery.Assembly:
    """The train with its axis on z, its carrier turned by `carrier_angle` (degrees), backlash split evenly.

    Its parts are called as members and rims are, and `planet_1` and so on, which are assemblies where planets are stepped.
    `carrier` adds pins and plates; `exploded` moves members apart along the axis. Raises GeometryError for rings without a
    rim, bodies that stand in each other, and a carrier for planets without bores.
    """
    return assembly_of(TrainPlan.of(train, carrier_angle=carrier_angle, carrier=carrier, exploded=exploded))


def assembly_of(plan: TrainPlan) -> cadquery.Assembly:
    """The assembly of a plan."""
    import cadquery

    layout = plan.layout
    solids = {key: gear_solid(body.gear) for key, body in layout.bodies.items()}
    assembly = cadquery.Assembly(name=layout.train.name)
    for standing in layout.centrals:
        _add(assembly, standing, solids)
    for planet in layout.planets:
        if layout.train.stepped:
            axle = planet[0].axle
            body = cadquery.Assembly(name=axle.name, metadata={PRODUCT: f"{layout.train.name} {axle.name}"})
            for standing in planet:
                _add(body, standing, solids, origin=(axle.x, axle.y))
            assembly.add(body, loc=cadquery.Location(cadquery.Vector(axle.x, axle.y, 0)))
        else:
            _add(assembly, planet[0], solids)
    for standing in layout.stages:
        _add(assembly, standing, solids)
    if plan.carrier is not None:
        name = layout.carrier.name
        colour = cadquery.Color(*TRAIN_COLOURS["carrier"][0], 1.0)
        product = {PRODUCT: f"{layout.train.name} {name}"}
        assembly.add(carrier_solid(plan.carrier), name=name, color=colour, metadata=product)
    return assembly


def _add(
    assembly: cadquery.Assembly,
    standing: Standing,
    solids: dict[str, cadquery.Solid],
    origin: tuple[float, float] = (0.0, 0.0),
) -> None:
    """Add a body in its place, seen from an axis through `origin` (x, y)."""
    import cadquery

    x, y, z = standing.offset
    offset = cadquery.Vector(x - origin[0], y - origin[1], z)
    place = cadquery.Location(offset, cadquery.Vector(0, 0, 1), standing.rotation)
    colour = cadquery.Color(*standing.body.colour, 1.0)
    product = {PRODUCT: standing.body.name}
    assembly.add(solids[standing.body.key], name=standing.name, loc=place, color=colour, metadata=product)
