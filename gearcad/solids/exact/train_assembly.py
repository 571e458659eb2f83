"""A planetary train posed in mesh: every part named and coloured, alike ones one solid, planets as assemblies of their rims."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.planetary import PlanetaryTrain
from gearcad.solids.colours import TRAIN_COLOURS
from gearcad.solids.exact.cad import cad_assembly
from gearcad.solids.exact.carrier import carrier_boundary
from gearcad.solids.exact.forms import ORIGIN, Point
from gearcad.solids.exact.products import AssembledProduct, Occurrence, SolidProduct, placed
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.train_layout import Standing, TrainLayout
from gearcad.solids.train_plan import TrainPlan

if TYPE_CHECKING:
    import cadquery

__all__ = ["train_assembly", "train_product"]


def train_assembly(
    train: PlanetaryTrain, *, carrier_angle: float = 0.0, carrier: bool = False, exploded: bool = False
) -> cadquery.Assembly:
    """The train with its axis on z, its carrier turned by `carrier_angle` (degrees), backlash split evenly.

    Its parts are called as members and rims are, and `planet_1` and so on, which are assemblies where planets are stepped.
    `carrier` adds pins and plates; `exploded` moves members apart along the axis. Raises GeometryError for rings without a
    rim, bodies that stand in each other, and a carrier for planets without bores.
    """
    return cad_assembly(train_product(TrainPlan.of(train, carrier_angle=carrier_angle, carrier=carrier, exploded=exploded)))


def train_product(plan: TrainPlan) -> AssembledProduct:
    """The assembly of a plan; bodies that are alike are one product."""
    layout = plan.layout
    train, parts = layout.train, _parts(layout)
    found = [_occurrence(standing, parts) for standing in layout.centrals]
    for planet in layout.planets:
        if train.stepped:
            axle = planet[0].axle
            rims = tuple(_occurrence(standing, parts, origin=(axle.x, axle.y)) for standing in planet)
            body = AssembledProduct(f"{train.name} {axle.name}", rims)
            found.append(Occurrence(axle.name, body, placed((axle.x, axle.y, 0.0))))
        else:
            found.append(_occurrence(planet[0], parts))
    found += [_occurrence(standing, parts) for standing in layout.stages]
    if plan.carrier is not None:
        name = layout.carrier.name
        product = SolidProduct(f"{train.name} {name}", carrier_boundary(plan.carrier), TRAIN_COLOURS["carrier"][0])
        found.append(Occurrence(name, product, placed()))
    return AssembledProduct(train.name, tuple(found))


def _parts(layout: TrainLayout) -> dict[str, SolidProduct]:
    """The bodies of a train by their keys."""
    return {key: SolidProduct(body.name, gear_boundary(body.gear), body.colour) for key, body in layout.bodies.items()}


def _occurrence(standing: Standing, parts: dict[str, SolidProduct], origin: Point = ORIGIN) -> Occurrence:
    """A body in its place, seen from an axis through `origin` (x, y)."""
    x, y, z = standing.offset
    frame = placed((x - origin[0], y - origin[1], z), standing.rotation)
    return Occurrence(standing.name, parts[standing.body.key], frame)
