"""Gearboxes of planetary sets for tests: Ravigneaux sets, and the sets of the planetary trains of the tests."""

from dataclasses import replace

from gearcad.geometry import Gear
from gearcad.planetary.gearbox import Gearbox, GearboxState
from gearcad.planetary.gearbox_sets import MemberSet, SetCentral, SetGear, SetGearing, SetPlanet
from support.planetary_trains import TRAINS

THINNING = 0.06


def _gear(teeth: int, helix: float = 0.0, **given: float) -> Gear:
    values = {"normal_module": 2.0, "face_width": 20.0, "helix_angle": helix, "tooth_thinning": THINNING}
    return Gear(**{"teeth": teeth, **values, **given})  # type: ignore[arg-type]


def ravigneaux(small: int, short: int, large: int, long: int, planets: int, helix: float = 0.0) -> MemberSet:
    """A set whose ring has large + 2 long teeth: all but the short planets stand at one distance without shifts."""
    ring = large + 2 * long
    gears = {
        "small": SetGear(gear=_gear(small, helix)),
        "large": SetGear(gear=_gear(large, -helix), axial_position=25.0),
        "ring": SetGear(gear=_gear(-ring, helix, tip_alteration=-0.25), axial_position=25.0),
        "long": SetGear(gear=_gear(long, helix, face_width=45.0)),
        "short": SetGear(gear=_gear(short, -helix)),
    }
    return MemberSet(
        name="r",
        centrals=(
            SetCentral(name="small", teeth=small, meshes="short"),
            SetCentral(name="large", teeth=large, meshes="long"),
            SetCentral(name="ring", teeth=-ring, meshes="long"),
        ),
        planets=(SetPlanet(name="long", teeth=long), SetPlanet(name="short", teeth=short, meshes="long")),
        gearing=SetGearing(planets=planets, gears=gears),
    )


def meshing_planets(sun: int, first: int, second: int, ring: int, planets: int) -> MemberSet:
    """Sun, two planets that mesh with each other, and a ring; the outer planets stand as the ring takes them."""
    gears = {
        "sun": SetGear(gear=_gear(sun)),
        "ring": SetGear(gear=_gear(-ring, tip_alteration=-0.25)),
        "inner": SetGear(gear=_gear(first)),
        "outer": SetGear(gear=_gear(second)),
    }
    return MemberSet(
        name="s",
        centrals=(SetCentral(name="sun", teeth=sun, meshes="inner"), SetCentral(name="ring", teeth=-ring, meshes="outer")),
        planets=(SetPlanet(name="inner", teeth=first), SetPlanet(name="outer", teeth=second, meshes="inner")),
        gearing=SetGearing(planets=planets, gears=gears),
    )


def of_train(kind: str, planets: int | None = None) -> MemberSet:
    """The set of a planetary train of the tests, whose planets stand at equal angles."""
    train = TRAINS[kind]
    gears = {rim.name: SetGear(gear=rim.gear, axial_position=rim.axial_position) for rim in train.rims}
    for mesh in train.meshes:
        low = mesh.rim.axial_position + (mesh.rim.gear.face_width - mesh.central.gear.face_width) / 2
        gears[mesh.central.name] = SetGear(gear=mesh.central.gear, axial_position=low)
    first = train.rims[0].name
    gears[first] = replace(gears[first], centre_distance=float(train.centre_distance))
    rims = tuple(
        SetPlanet(name=rim.name, teeth=rim.gear.teeth, beside="" if rim.name == first else first) for rim in train.rims
    )
    centrals = tuple(
        SetCentral(name=mesh.central.name, teeth=mesh.central.gear.teeth, meshes=mesh.rim.name) for mesh in train.meshes
    )
    gearing = SetGearing(planets=planets or train.planets, gears=gears)
    return MemberSet(name="s", centrals=centrals, planets=rims, gearing=gearing)


def box_of(each: MemberSet, entering: str, leaving: str, state: GearboxState) -> Gearbox:
    return Gearbox(name="box", sets=(each,), input=entering, output=leaving, states=(state,))
