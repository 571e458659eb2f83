"""Gears, pairs and trains to be drawn, with material, heat treatment and surface quality."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.core.records import is_assumed
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.words import SheetWords
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.gear_parts import HubSide
from gearcad.geometry.spline_part import Spline
from gearcad.material import Material, MaterialGroup, grade_of
from gearcad.planetary import PlanetaryTrain
from gearcad.rating.tolerances import Accuracy
from gearcad.solids.shaft_plan import SeatedShaft


@dataclass(frozen=True, kw_only=True)
class Mate:
    """A gear that engages with another: its name, its number ("" if it has none), and the pair that they make."""

    name: str
    number: str = ""
    gear: Gear | Rack
    pair: GearPair | RackPair


@dataclass(frozen=True, kw_only=True)
class DrawnGear:
    """A gear by its role among others ("pinion", "sun", "gear"), what it is made of, and how accurate its flanks are.

    `grade` is its accuracy grade, None where nobody gave one; it is then assumed, and the sheet says so.
    """

    role: str
    gear: Gear | Rack
    material: Material | None = None
    accuracy: Accuracy = Accuracy.ISO_1995
    grade: int | None = None
    mates: tuple[Mate, ...] = ()
    spline: Spline | None = None
    """The splined shaft or hub whose outline the gear is; None for a gear."""

    @property
    def direction(self) -> int:
        """Direction of z in the section on the sheet: 1 to the right, -1 to the left; 1 for racks and rings. The end of an
        external gear that has a hub is at the left. Without a hub, or with one at both ends, the end at z = face width is
        there.
        """
        part = self.gear
        if isinstance(part, Rack) or part.internal or (part.body.hub_length and part.body.hub_side is HubSide.BACK):
            return 1
        return -1


@dataclass(frozen=True, kw_only=True)
class DrawnPair:
    """A pair by its name, its two parts: the pinion, then what it meshes with (wheel, ring or rack), and their shafts."""

    name: str
    pair: GearPair | RackPair
    parts: tuple[DrawnGear, DrawnGear]
    shafts: tuple[SeatedShaft, ...] = ()


@dataclass(frozen=True, kw_only=True)
class DrawnTrain:
    """A planetary train by its name, and those of its gears that have more data than the train itself gives.

    The `role` of each part is the name of its member, rim, or gear of a stage.
    """

    name: str
    train: PlanetaryTrain
    parts: tuple[DrawnGear, ...] = ()


_BRINELL = (
    MaterialGroup.STRUCTURAL_STEEL,
    MaterialGroup.CAST_STEEL,
    MaterialGroup.NODULAR_IRON,
    MaterialGroup.FERRITIC_NODULAR_IRON,
    MaterialGroup.MALLEABLE_IRON,
    MaterialGroup.GREY_IRON,
)
"""Groups whose hardness ISO 6336-5 gives in HBW; all others are in HV."""

_IRON = _BRINELL[2:]
"""Groups of cast iron: an unnamed material has their name."""

_STEEL = Material().name
"""Material of gears without a named one."""


def material_text(drawn: DrawnGear, options: DrawingOptions, words: SheetWords) -> str:
    """Return the material as the sheet names it: as given for the sheet, else the name of the material; "" if unknown.

    A material without a name is called by its group. Without a group either, the text says that steel is assumed.
    """
    if options.material is not None:
        return options.material
    material = drawn.material
    if material is None:
        return ""
    if not is_assumed(material.name) and material.name != _STEEL and grade_of(material.name) is None:
        return material.name
    group = material.group
    if group is not None and (group in _IRON or (material.plastic and is_assumed(material.name))):
        return words[f"data.group_{group.name.lower()}"]
    unknown = material.group is None and is_assumed(material.name)
    return f"{words['data.steel']} ({words['data.assumed']})" if unknown else words["data.steel"]


def treatment_text(drawn: DrawnGear, options: DrawingOptions, words: SheetWords) -> str:
    """Return the heat treatment as given, else the treatment of the material group with its hardness; "" if unknown. The case
    depth follows.
    """
    text = options.heat_treatment or ("" if drawn.material is None else _of_group(drawn.material, words))
    depth = options.case_depth or ""
    if depth and not depth.upper().startswith("CHD"):
        depth = f"CHD {depth}"
    return ", ".join(filter(None, (text, depth)))


def _of_group(material: Material, words: SheetWords) -> str:
    group = material.group
    treated = "" if group is None or material.plastic else words[f"data.group_{group.name.lower()}"]
    if material.hardness is None:
        return treated
    scale = "HBW" if group in _BRINELL else "HV"
    return ", ".join(filter(None, (treated, f"{words.shortest(material.hardness, 1)} {scale}")))
