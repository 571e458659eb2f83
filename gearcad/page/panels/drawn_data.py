"""Data of the drawn panels: transverse section, solid bodies and planetary study, found without NiceGUI."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache, wraps
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

import numpy as np

from gearcad.core.errors import GearcadError
from gearcad.core.quantities import assumed_values
from gearcad.core.records import Floats, PerGear, Role
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import RackDesign, SplineDesign, ToothedDesign
from gearcad.designs.pair_designs import PairDesign, RackPairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.shaft_spec import ShaftDesign
from gearcad.designs.train_designs import TrainDesign
from gearcad.geometry import Gear, Rack
from gearcad.geometry.bore_teeth import bore_teeth
from gearcad.geometry.curves import parameters_within
from gearcad.geometry.gear_data import first_touch, section_turn
from gearcad.geometry.path_of_contact import PathOfContact
from gearcad.geometry.spline_standards import HUB
from gearcad.jobs.build import given_speeds, require_bodies, seated_shafts
from gearcad.jobs.planetary import planetary
from gearcad.page.panels.train_stands import TrainGear, TrainStands, train_stands
from gearcad.planetary.members import SetMesh
from gearcad.planetary.train_data import shafts_of
from gearcad.solids import FileOptions
from gearcad.solids.body_plan import BEARING_COLOUR, PART_COLOURS, SHAFT_COLOURS, STAGE_COLOURS, STEEL, Colour
from gearcad.solids.facets.tessellation import tessellate, tessellate_rack
from gearcad.solids.files.shaft_products import turned_facets
from gearcad.solids.files.train_products import section_angle, turns_of
from gearcad.solids.shaft_plan import TurnedPlan
from gearcad.solids.train_plan import TrainLayout

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy


AnyDesign = TypeVar("AnyDesign", bound=Design)
Found = TypeVar("Found")


def of_last(find: Callable[[AnyDesign], Found]) -> Callable[[AnyDesign], Found]:
    """Return a function that keeps its result for the last design, equal in what is given and in what is assumed.

    Designs hold dictionaries, so they have no hash, which `functools.lru_cache` would need.
    """
    last: list[tuple[AnyDesign, Found]] = []

    @wraps(find)
    def found_of(design: AnyDesign) -> Found:
        for of, found in last:
            if of == design and [*assumed_values(of)] == [*assumed_values(design)]:
                return found
        found = find(design)
        last[:] = [(design, found)]
        return found

    return found_of


CHORD = 2e-4
"""Error of outlines, in normal modules: seen only where a flank fills the window."""

_DIGITS = 5
"""Number of decimals of a coordinate in mm."""


def turns(gear: Gear, rotation: float, z: float) -> list[list[float]]:
    """Return the turn (rad) of sections at heights of the first gear (mm), as [height, turn] rows to interpolate linearly."""
    own = np.array([0.0, gear.face_width])
    if gear.double_helix.present:
        middle = gear.face_width / 2
        own = np.array([0.0, middle, np.nextafter(middle, gear.face_width), gear.face_width])
    table: list[list[float]] = np.column_stack([own + z, rotation + section_turn(gear, own)]).tolist()
    return table


def drift(rack: Rack, travel: float, z: float) -> list[list[float]]:
    """Return the displacement (mm) of sections of a rack at heights (mm), as [height, displacement] rows."""
    return [[z, travel], [z + rack.face_width, travel + rack.drift * rack.face_width]]


def mesh_of(pinion: Gear, path: PathOfContact[float], angle: float, length: float | None) -> dict[str, Any]:
    """Return the mesh of the first two bodies for the scene: at turn 0 a pinion tooth points to the mate; `length`: T1T2 (mm).

    `side` is 1 where the pinion's left flanks touch when those of the first body do, -1 where its right flanks do.
    """
    return {
        "of": [0, 1],
        "towards": 0.0,
        "side": 1,
        "base": pinion.base_diameter / 2,
        "angle": math.radians(angle),
        "path": list(path),
        "pitch": pinion.transverse_base_pitch,
        "length": length,
        "first": first_touch(pinion, pinion.profile, angle),
    }


def body_of(
    name: str,
    gear: Gear,
    colour: Colour,
    place: tuple[float, float],
    turned: Iterable[Iterable[float]],
    ratio: float,
    beside: Mapping[str, float] | None = None,
    *,
    rest: float = 0.0,
    slack: float = 0.0,
) -> dict[str, Any]:
    """A gear where it stands; `beside` are further circles by what they are called.

    Its keyway and bolt holes are turned by `rest` (rad), whatever the height. It turns by `slack` (rad) until the left flanks
    of the first body touch.
    """
    body = gear.body
    splined = {} if (spline := bore_teeth(gear)) is None else {"spline": _spline(spline)}
    return splined | {
        "name": name,
        "colour": colour_of(colour),
        "place": list(place),
        "turns": turned,
        "rest": rest,
        "ratio": ratio,
        "slack": slack,
        "teeth": gear.teeth,
        "tooth": _listed(gear.profile.points(CHORD * gear.normal_module)),
        "bore": body.bore,
        "keyway": [body.keyway_width, body.keyway_depth],
        "bolts": [body.bolt_circle, body.bolt_holes, body.bolt_diameter],
        "rim": body.rim_diameter,
        "circles": {
            "tip": abs(gear.tip_diameter),
            "reference": abs(gear.reference_diameter),
            "base": abs(gear.base_diameter),
            "form": abs(gear.form_diameter),
            "root": abs(gear.root_diameter),
            **(beside or {}),
        },
    }


def rack_of(
    rack: Rack, place: tuple[float, float], angle: float, travel: Iterable[Iterable[float]], ratio: float, slack: float = 0.0
) -> dict[str, Any]:
    """A rack where it stands, its own x axis at an angle (rad); lines are heights above its reference line.

    It moves by `slack` (mm) until the left flanks of the first body touch.
    """
    error, profile = CHORD * rack.normal_module, rack.profile
    half = np.concatenate([curve.points(parameters_within(curve, error))[:-1] for curve in profile.curves])
    tooth = np.concatenate([half, [[0.0, profile.tip_height]], half[::-1] * [-1, 1]])
    return {
        "name": "rack",
        "colour": colour_of(PART_COLOURS["rack"]),
        "place": list(place),
        "angle": angle,
        "turns": travel,
        "ratio": ratio,
        "slack": slack,
        "pitch": profile.pitch,
        "length": rack.length,
        "height": rack.height,
        "tooth": _listed(tooth),
        "circles": {"tip": rack.tip_height, "reference": 0.0, "form": -rack.form_depth, "root": -rack.root_depth},
    }


def _spline(teeth: Gear) -> list[Any]:
    """Return the number of teeth of a splined bore, and the outline of tooth 0 (mm)."""
    return [teeth.tooth_count, _listed(teeth.profile.points(CHORD * teeth.normal_module))]


def colour_of(colour: Colour) -> str:
    """Return a colour as CSS text, `rgb(r, g, b)`."""
    return f"rgb({', '.join(str(round(255 * share)) for share in colour)})"


def _listed(points: Floats) -> list[float]:
    listed: list[float] = points.round(_DIGITS).ravel().tolist()
    return listed


def plain(found: Any) -> Any:
    """Return the data to send, with subclasses of float replaced by plain floats."""
    if isinstance(found, Mapping):
        return {key: plain(value) for key, value in found.items()}
    if isinstance(found, (list, tuple)):
        return [plain(value) for value in found]
    return float(found) if isinstance(found, float) else found


def train_section(design: PlanetaryDesign) -> dict[str, Any]:
    """Gears that mesh are cut by one plane, in the middle of their teeth; planets and what is of their meshes go round."""
    layout = layout_of(design)
    ratios = ratios_of(design, layout)
    orbit, (slacks, of_planets) = ratios[layout.carrier.name], _slacks(layout)
    bodies, numbers = [], {}
    for number, standing in enumerate(layout.standing):
        numbers[standing.name] = number
        turned = [[0.0, section_angle(layout, standing)]]
        place, gear = (standing.axle.x, standing.axle.y), standing.body.gear
        axle, rest = standing.axle.name, math.radians(standing.rotation)
        slack = of_planets if standing.axle.on else slacks[axle]
        body = body_of(standing.name, gear, standing.body.colour, place, turned, ratios[axle], rest=rest, slack=slack)
        bodies.append(body | {"orbit": orbit if standing.axle.on else 0.0})
    meshes = list(_meshes(layout, numbers, orbit))
    return {"bodies": bodies, "meshes": meshes, "heights": [0.0, 0.0], "pitch": roll_pitch(design, ratios)}


@of_last
def layout_of(design: PlanetaryDesign) -> TrainLayout:
    """Return the layout of the train: the places of all its gears and axles."""
    return TrainLayout(design.train, design.train.pose())


def ratios_of(design: PlanetaryDesign, layout: TrainLayout) -> dict[str, float]:
    """Turns of all axles by name, seen from what carries each, while the input turns once (the carrier, if that stands)."""
    turns = turns_of(layout, given_speeds(design))
    once = turns[design.train.input] or turns[layout.carrier.name]
    return {name: turn / once for name, turn in turns.items()}


def roll_pitch(design: PlanetaryDesign, ratios: dict[str, float]) -> float:
    """Return the angle (rad) by which the input turns while a tooth of the first central passes a planet."""
    central, carrier = design.train.centrals[0], design.train.carrier.name
    return 2 * math.pi / abs(central.gear.teeth * (ratios[central.name] - ratios[carrier]))


def _slacks(layout: TrainLayout) -> tuple[dict[str, float], float]:
    """Return the turns (rad) that bring left flanks into contact: of shafts by name, and of the planets.

    After them the left flanks of the first central touch those of the planets, and these those of the second. The first central
    and the carrier stay; stages keep their backlash split.
    """
    first, second = layout.train.meshes
    planet = _slack(first, first.rim_role)
    moved = -_slack(second, second.central_role) - planet * second.rim.gear.teeth / second.central.gear.teeth
    shafts = shafts_of(layout.train).items()
    found = {name: moved * float(shaft.speed_ratio) * (shaft.member == second.central.name) for name, shaft in shafts}
    return found, planet


def _slack(mesh: SetMesh, role: Role) -> float:
    """Return the turn (rad) of one gear until the left flanks of the pinion touch, if the backlash is split at first."""
    return mesh.pair.circumferential_backlash / mesh.pair.working_pitch_diameters.pick(role)


def _meshes(layout: TrainLayout, numbers: dict[str, int], orbit: float) -> Iterator[dict[str, Any]]:
    """Yield the meshes of all planets; `towards` is the direction (rad) of the pinion's mate.

    One side of a planet's teeth touches the first central, the other side the second.
    """
    for planet in layout.planets:
        for mesh, side in zip(layout.train.meshes, (1, -1), strict=True):
            (rim,) = (standing for standing in planet if standing.body.key == mesh.rim.name)
            members = {mesh.central_role: mesh.central.name, mesh.rim_role: rim.name}
            away = math.atan2(rim.axle.y, rim.axle.x)
            back = math.pi if mesh.rim_role is Role.PINION and mesh.external else 0.0
            pair = mesh.pair
            drawn = mesh_of(pair.pinion, pair.path_of_contact, pair.working_transverse_pressure_angle, pair.base_tangent.length)
            of = [numbers[members[role]] for role in Role]
            yield drawn | {"of": of, "towards": away + back, "orbit": orbit, "side": side}


@of_last
def section_of(design: Design) -> dict[str, Any] | None:
    """Bodies of a design with teeth, their meshes, heights at which it can be cut, and the pitch by which it is rolled (rad).

    A body has a place, an outline of one tooth (mm), and over the height (mm, of the first) how far it is turned (rad, a rack
    moved, mm); `ratio` is how far it turns (or moves, mm) while the first turns by a radian. None for kinds without teeth.
    """
    if isinstance(design, PairDesign):
        return _of_pair(design)
    if isinstance(design, RackPairDesign):
        return _of_rack_pair(design)
    if isinstance(design, RackDesign):
        return _content(
            [rack_of(design.rack, (0.0, 0.0), 0.0, drift(design.rack, 0.0, 0.0), 0.0)], [], _heights(design.rack), 0.0
        )
    if isinstance(design, PlanetaryDesign):
        return train_section(design)
    if isinstance(design, SplineDesign):
        return _of_spline(design)
    if isinstance(design, TrainDesign):
        return _of_pairs(stands) if (stands := stands_of(design)) is not None else None
    if isinstance(design, ToothedDesign) and (gear := design.gears.get("gear")) is not None:
        body = body_of("gear", gear, STEEL, (0.0, 0.0), turns(gear, 0.0, 0.0), 1.0)
        return _content([body], [], _heights(gear), 2 * math.pi / gear.tooth_count)
    return None


@of_last
def stands_of(design: TrainDesign) -> TrainStands | None:
    """Return where the gears of a train of pairs stand; None for a train without, or whose places contradict each other."""
    return train_stands(design)


def _of_pairs(stands: TrainStands) -> dict[str, Any]:
    """Return the section of a train of pairs: each gear is cut in the middle of its teeth, as all that mesh are."""
    bodies, meshes = [], []
    for each in stands.gears:
        x, y, z = each.place
        turned = [[0.0, each.rotation + float(section_turn(each.gear, np.array([each.cut - z]))[0])]]
        drawn = body_of(
            each.name, each.gear, _colour_of(each), (x, y), turned, each.ratio, rest=each.rotation, slack=each.slack
        )
        bodies.append(drawn)
    for stand in stands.pairs:
        pair, angle = stand.pair, stand.pair.working_transverse_pressure_angle
        path = mesh_of(pair.pinion, pair.path_of_contact, angle, pair.base_tangent.length)
        meshes.append(path | {"of": list(stand.gears), "towards": stand.towards, "side": stand.side})
    return _content(bodies, meshes, (0.0, 0.0), 2 * math.pi / stands.gears[0].gear.tooth_count)


def _colour_of(gear: TrainGear) -> Colour:
    """Return the colour of a gear of a train; stages that are next to each other have different ones."""
    own = (PART_COLOURS["pinion"], PART_COLOURS["wheel"]) if gear.stage % 2 == 0 else STAGE_COLOURS
    return own[gear.role is Role.WHEEL]


def _of_spline(design: SplineDesign) -> dict[str, Any]:
    """Return the section of a shaft and the hub on it, which turn together."""
    joint, bodies = design.spline, []
    slack = (joint.built_play or 0.0) / joint.reference_diameter
    for name, (gear, body) in zip(design.gears, _splined(design), strict=True):
        turned = turns(gear, body.rotation, 0.0)
        own = slack if name == HUB else 0.0
        bodies.append(body_of(name, gear, body.colour, (0.0, 0.0), turned, 1.0, rest=body.rotation, slack=own))
    return _content(bodies, [], (0.0, joint.length), 2 * math.pi / joint.count)


def _splined(design: SplineDesign) -> Iterator[tuple[Gear, DrawnBody]]:
    """Yield the shaft and the hub on it with their bodies, the hub turned by half a pitch."""
    for name, gear in design.gears.items():
        rotation = math.radians(design.spline.hub_rotation) if name == HUB else 0.0
        yield gear, DrawnBody(name, "", PART_COLOURS[name], rotation=rotation)


def _of_pair(design: PairDesign) -> dict[str, Any]:
    pair = design.pair
    pose, pitches, active = pair.wheel_pose(), pair.working_pitch_diameters, pair.active_root_diameters
    angle = pair.working_transverse_pressure_angle
    rest, ratio = math.radians(pose.rotation), -pair.pinion.teeth / pair.wheel.teeth
    turned, slack = turns(pair.wheel, rest, pose.z), pair.circumferential_backlash / pitches.wheel
    colours = PART_COLOURS["pinion"], PART_COLOURS["wheel"]
    beside = [{"active": abs(active.pick(role)), "pitch": abs(pitches.pick(role))} for role, _ in pair.gears.items()]
    bodies = [
        body_of("pinion", pair.pinion, colours[0], (0.0, 0.0), turns(pair.pinion, 0.0, 0.0), 1.0, beside[0]),
        body_of("wheel", pair.wheel, colours[1], (pose.x, 0.0), turned, ratio, beside[1], rest=rest, slack=slack),
    ]
    low, high = max(0.0, pose.z), min(pair.pinion.face_width, pose.z + pair.wheel.face_width)
    mesh = mesh_of(pair.pinion, pair.path_of_contact, angle, pair.base_tangent.length)
    return _content(bodies, [mesh], (low, high), 2 * math.pi / pair.pinion.tooth_count)


def _of_rack_pair(design: RackPairDesign) -> dict[str, Any]:
    pair = design.pair
    pose, pinion = pair.rack_pose(), pair.pinion
    beside = {"active": pair.active_root_diameter, "pitch": 2 * pair.pitch_radius}
    body = body_of("pinion", pinion, PART_COLOURS["pinion"], (0.0, 0.0), turns(pinion, 0.0, 0.0), 1.0, beside)
    travel = drift(pair.rack, pose.y, pose.z)
    slack = -pair.circumferential_backlash / 2
    rack = rack_of(pair.rack, (pose.x, 0.0), math.radians(pose.rotation), travel, pair.pitch_radius, slack)
    rack["circles"] |= {"pitch": pair.pitch_line_height, "active": -pair.active_root_depth}
    mesh = mesh_of(pinion, pair.path_of_contact, pair.working_transverse_pressure_angle, None)
    low = max(0.0, pose.z)
    heights = low, low + pair.common_width
    return _content([body, rack], [mesh], heights, 2 * math.pi / pinion.teeth)


def _content(bodies: list[Any], meshes: list[Any], heights: tuple[float, float], pitch: float) -> dict[str, Any]:
    return {"bodies": bodies, "meshes": meshes, "heights": list(heights), "pitch": pitch}


def _heights(cut: Gear | Rack) -> tuple[float, float]:
    return 0.0, cut.face_width


_NO_BODIES = "This kind of design has no bodies."

_CHORD = 0.01
"""Error of facets, in normal modules: bodies are looked at."""

_MOST_KEPT = 48
"""Surfaces that are kept, for all sessions: what did not change is not made again."""

_SHORT = 1 << 16
"""Vertices that two bytes can number."""


class DrawnSurface(NamedTuple):
    """A closed surface: numbers of vertices and triangles, coordinates (mm) and corners; by what it is known."""

    key: str
    content: bytes


class DrawnBody(NamedTuple):
    """A body where it stands (mm, rad), and how far it turns (rad), goes round or slides along y (mm) with the first gear."""

    name: str
    surface: str
    colour: Colour
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: float = 0.0
    ratio: float = 1.0
    orbit: float = 0.0
    slide: float = 0.0


class Bodies(NamedTuple):
    """The bodies of a design, and their surfaces, which are `error` (mm) off at the most; `why_not` where there are none."""

    bodies: tuple[DrawnBody, ...] = ()
    surfaces: Mapping[str, bytes] = {}
    error: float = 0.0
    why_not: str = ""


def bodies_of(design: Design) -> Bodies:
    """Return the bodies of a design with teeth, or of a shaft, or the reason why there are none."""
    if not isinstance(design, ToothedDesign | TrainDesign | ShaftDesign):
        return Bodies(why_not=_NO_BODIES)
    if isinstance(design, TrainDesign) and stands_of(design) is None:
        return Bodies(why_not=_NO_BODIES)
    try:
        if not isinstance(design, TrainDesign):
            require_bodies(cast("ToothedDesign", design), FileOptions())
        stood = list(_standing(design))
    except GearcadError as error:
        return Bodies(why_not=str(error))
    found = [surface_of(cut) for cut, _ in stood]
    bodies = tuple(body._replace(surface=surface.key) for (_, body), surface in zip(stood, found, strict=True))
    return Bodies(bodies, dict(found), max(_error(cut) for cut, _ in stood))


@lru_cache(maxsize=_MOST_KEPT)
def surface_of(cut: Gear | Rack | TurnedPlan) -> DrawnSurface:
    """Return the surface of a gear, a rack or a shaft. Raises GeometryError for a ring without a rim."""
    if isinstance(cut, TurnedPlan):
        facets = turned_facets(cut, _error(cut))
    else:
        facets = tessellate(cut, _error(cut)) if isinstance(cut, Gear) else tessellate_rack(cut, _error(cut))
    counts = np.array([len(facets.vertices), len(facets.faces)], "<u4")
    corners = facets.faces.astype("<u2" if len(facets.vertices) < _SHORT else "<u4")
    content = counts.tobytes() + facets.vertices.astype("<f4").tobytes() + corners.tobytes()
    return DrawnSurface(hashlib.blake2b(content, digest_size=12).hexdigest(), content)


_CHORD_OF_SHAFT = 5e-4
"""Error of the facets of a shaft, in its largest diameter."""


def _error(cut: Gear | Rack | TurnedPlan) -> float:
    return _CHORD_OF_SHAFT * cut.largest if isinstance(cut, TurnedPlan) else _CHORD * cut.normal_module


def _standing(design: ToothedDesign | TrainDesign | ShaftDesign) -> Iterator[tuple[Gear | Rack | TurnedPlan, DrawnBody]]:
    """Yield each gear, rack and shaft with its body, whose surface is not known yet; gears first."""
    if isinstance(design, ShaftDesign):
        yield TurnedPlan(design.shaft), DrawnBody("shaft", "", STEEL)
    elif isinstance(design, PairDesign):
        pair, pose = design.pair, design.pair.wheel_pose()
        place, rotation = (pose.x, 0.0, pose.z), math.radians(pose.rotation)
        ratio = -pair.pinion.teeth / pair.wheel.teeth
        yield pair.pinion, DrawnBody("pinion", "", PART_COLOURS["pinion"])
        yield pair.wheel, DrawnBody("wheel", "", PART_COLOURS["wheel"], place, rotation, ratio)
        for shaft in seated_shafts(design):
            colour, own = PerGear(*SHAFT_COLOURS).pick(shaft.role), (shaft.x, 0.0, shaft.z)
            turned = 1.0 if shaft.role is Role.PINION else ratio
            yield shaft.plan, DrawnBody(shaft.name, "", colour, own, math.radians(shaft.rotation), turned)
            for plan, z in shaft.rings.values():
                yield plan, DrawnBody("bearing", "", BEARING_COLOUR, (shaft.x, 0.0, z), ratio=0.0)
    elif isinstance(design, RackPairDesign):
        yield from _with_rack(design)
    elif isinstance(design, RackDesign):
        yield design.rack, DrawnBody("rack", "", STEEL, ratio=0.0)
    elif isinstance(design, PlanetaryDesign):
        yield from _of_train(design)
    elif isinstance(design, SplineDesign):
        yield from _splined(design)
    elif isinstance(design, TrainDesign):
        stands = stands_of(design)
        for each in () if stands is None else stands.gears:
            yield each.gear, DrawnBody(each.name, "", _colour_of(each), each.place, each.rotation, each.ratio)
        for body, ratio in () if stands is None else stands.shafts:
            own, turned = (body.x, body.y, body.z), math.radians(body.rotation)
            yield body.plan, DrawnBody(body.name, "", SHAFT_COLOURS[0], own, turned, ratio)
    else:
        for name, gear in design.gears.items():
            yield gear, DrawnBody(name, "", STEEL)


def _with_rack(design: RackPairDesign) -> Iterable[tuple[Gear | Rack, DrawnBody]]:
    pair, pose = design.pair, design.pair.rack_pose()
    place, rotation = (pose.x, pose.y, pose.z), math.radians(pose.rotation)
    rack = DrawnBody("rack", "", PART_COLOURS["rack"], place, rotation, ratio=0.0, slide=pair.pitch_radius)
    return (pair.pinion, DrawnBody("pinion", "", PART_COLOURS["pinion"])), (pair.rack, rack)


def _of_train(design: PlanetaryDesign) -> Iterator[tuple[Gear | Rack, DrawnBody]]:
    layout = layout_of(design)
    ratios = ratios_of(design, layout)
    for standing in layout.standing:
        body, orbit = standing.body, ratios[layout.carrier.name] if standing.axle.on else 0.0
        rotation, ratio = math.radians(standing.rotation), ratios[standing.axle.name]
        yield body.gear, DrawnBody(standing.name, "", body.colour, standing.offset, rotation, ratio, orbit)


@of_last
def train_study(design: Design) -> PlanetaryStudy:
    """Return the study of a train. Finite elements compute the stiffness of its meshes, which takes a second."""
    return planetary(design)
