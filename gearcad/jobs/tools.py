"""Verb `tools`: the shelf, and which of its tools would cut the gears of a design, with the root that each would leave."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from gearcad.core.errors import InputError, ParameterError, SpecError, as_path
from gearcad.core.output import json_text, staged_files
from gearcad.core.records import JsonObject, Role
from gearcad.designs import Design, PairDesign, PlanetaryDesign, RackPairDesign
from gearcad.designs.cells import cell_text, write_csv
from gearcad.designs.keys import DesignKind
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.premachining import Finishing
from gearcad.geometry.tool_outlines import cuts, fillet_distance, short_lead_module, with_tool
from gearcad.geometry.tool_shelf import Shelf
from gearcad.geometry.tool_tables import FILE, ShelfTool
from gearcad.jobs.job import Subject, as_design, with_summary
from gearcad.version import __version__

__all__ = ["CutGear", "ShelfTools", "ToolChoice", "ToolChoices", "tools", "write_tools"]

_ACCEPTED = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK_PAIR, DesignKind.PLANETARY)
_WHY = "tools cut gears; splines and trains of shafts have none from the shelf"


@dataclass(frozen=True, kw_only=True)
class ShelfTools:
    """The tools of a shelf, in the order in which a name is looked for."""

    tools: tuple[ShelfTool, ...]

    def to_dict(self) -> JsonObject:
        """Return the content of tools.json."""
        return {"kind": "tools", "gearcad": __version__, "tools": [tool.to_dict() for tool in self.tools]}


@dataclass(frozen=True, kw_only=True)
class ToolChoice:
    """A tool of the shelf that is of the size of a gear, and the `gear` as it would cut it, None where it cannot.

    `distance` (mm) is the greatest one between the roots, `clearance` (mm) the least of the mates' tips in the root, None
    without a mate. `faults` say why the tool does not hold. With a `short_lead` its module (mm) is another.
    """

    tool: ShelfTool
    asked: Gear
    gear: Gear | None
    distance: float | None = None
    clearance: float | None = None
    faults: tuple[str, ...] = ()
    short_lead: float | None = None

    @property
    def holds(self) -> bool:
        """Whether the tool leaves a gear that runs with its mates."""
        return not self.faults

    @property
    def residual_undercut(self) -> float | None:
        """s_pr (mm), negative where stock is left; 0 for a tool that makes all of the teeth."""
        return None if self.gear is None else self.gear.residual_undercut

    @property
    def wheel(self) -> Finishing | None:
        """The finishing that was assumed, which the spec has to have; None where the tool needs none, or the gear names it."""
        if self.gear is None or self.gear.finishing in (self.asked.finishing, Finishing()):
            return None
        return self.gear.finishing

    @property
    def root_difference(self) -> float | None:
        """Root diameter less that asked for (mm)."""
        return None if self.gear is None else self.gear.root_diameter - self.asked.root_diameter

    @property
    def form_difference(self) -> float | None:
        """Root form diameter less that asked for (mm)."""
        return None if self.gear is None else self.gear.form_diameter - self.asked.form_diameter

    def to_dict(self) -> JsonObject:
        """Return the choice as tools.json has it (mm)."""
        gear = self.gear
        found = self.tool.to_dict() | {
            "short_lead": self.short_lead is not None,
            "root_diameter": None if gear is None else gear.root_diameter,
            "root_difference": self.root_difference,
            "form_diameter": None if gear is None else gear.form_diameter,
            "form_difference": self.form_difference,
            "residual_undercut": self.residual_undercut,
            "undercut": None if gear is None else gear.undercut,
            "clearance": self.clearance,
            "fillet_distance": self.distance,
            "holds": self.holds,
            "faults": list(self.faults),
        }
        if self.wheel is not None:
            found["finishing"] = {name: getattr(self.wheel, name) for name in ("end_diameter", "wheel_tip_radius")}
        if gear is not None and self.short_lead is not None:
            pre = gear.premachining
            own = ("tool_addendum", "tool_tip_radius", "tool_pressure_angle")
            found["premachining"] = {name: getattr(pre, name) for name in own}
        return found


class CutGear(NamedTuple):
    """A gear of a design, and the tools that would cut it: the nearest to what is asked first."""

    gear: Gear
    choices: tuple[ToolChoice, ...]


@dataclass(frozen=True, kw_only=True)
class ToolChoices:
    """Tools that would cut each gear of a design, by the names of the gears."""

    name: str
    gears: Mapping[str, CutGear]

    @cached_property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about gears that no tool of the shelf cuts."""
        none = (name for name, each in self.gears.items() if not any(choice.holds for choice in each.choices))
        return tuple(f"{name}: no tool of the shelf leaves teeth that run" for name in none)

    def to_dict(self) -> JsonObject:
        """Return the content of tools.json."""
        document: JsonObject = {"kind": "tools", "name": self.name, "gearcad": __version__, "gears": {}}
        for name, each in self.gears.items():
            document["gears"][name] = {
                "tool": None if each.gear.tool is None else str(each.gear.tool),
                "teeth": each.gear.teeth,
                "normal_module": each.gear.normal_module,
                "pressure_angle": each.gear.rack.pressure_angle,
                "root_diameter": each.gear.root_diameter,
                "form_diameter": each.gear.form_diameter,
                "tools": [choice.to_dict() for choice in each.choices],
            }
        return with_summary(document, self.warnings)


def tools(subject: Subject | None = None, *, folder: Path | str = ".") -> ShelfTools | ToolChoices:
    """Return the tools of the shelf; of a gear, a pair or a design those that would cut its gears, with the root of each.

    `folder` is that of the design, whose `tools.csv` counts first. A tool fits by module and pressure angle, or as a hob with
    a short lead by its base pitch. The nearest to the root that is asked for comes first.

    >>> from gearcad import Gear
    >>> found = tools(Gear(teeth=20, normal_module=2, face_width=20))
    >>> found.gears["gear"].choices[0].tool.name
    'ISO 53 A'

    Raises ParameterError for what has no such gears, SpecError for a table with a fault.
    """
    shelf = Shelf(as_path("folder", folder))
    if subject is None:
        return ShelfTools(tools=_all_tools(shelf))
    design = as_design(subject)
    design.require_kind(*_ACCEPTED, why=_WHY)
    known = _all_tools(shelf)

    def cut(name: str, gear: Gear) -> CutGear:
        return CutGear(gear, _choices(gear, shelf, known, tuple(_mates(design, name))))

    return ToolChoices(name=design.name, gears={name: cut(name, gear) for name, gear in design.gears.items()})


def _all_tools(shelf: Shelf) -> tuple[ShelfTool, ...]:
    """Return the tools of all tables. Raises SpecError with a line for each fault."""
    found, faults = [], []
    for row in shelf.rows():
        try:
            found.append(row.tool)
        except SpecError as error:
            faults.append(str(error))
    if faults:
        raise SpecError("\n".join(faults))
    return tuple(found)


_ENDS = 16
"""Steps in which the end of a wheel is sought."""

_INTERFERENCE = "fillet-interference"


class Mating(NamedTuple):
    """A pair, and the gear of it in whose place others are tried."""

    pair: GearPair | RackPair
    role: Role

    @property
    def active_root(self) -> float:
        """Diameter (mm) down to which the mate's tip touches the flanks."""
        pair = self.pair
        return pair.active_root_diameter if isinstance(pair, RackPair) else pair.active_root_diameters.pick(self.role)

    def tried(self, gear: Gear) -> tuple[float, list[str]]:
        """Return the clearance (mm) of the mate's tip in the root of another gear, and what is wrong there."""
        if isinstance(self.pair, RackPair):
            rack_pair = replace(self.pair, pinion=gear)
            return rack_pair.tip_clearances.rack, _interference(rack_pair, "rack")
        pair = replace(self.pair, pinion=gear) if self.role is Role.PINION else replace(self.pair, wheel=gear)
        return pair.tip_clearances.pick(self.role.mate), _interference(pair, self.role.mate.value)


def _interference(pair: GearPair | RackPair, owner: str) -> list[str]:
    """Return what notices say of the interference of an owner's tip: "the wheel's tip reaches ..."."""
    told = [each.text for each in pair.notices if each.code == _INTERFERENCE]
    return [text for text in told if text.partition("'")[0].endswith(owner)]


def _mates(design: Design, name: str) -> Iterator[Mating]:
    """Yield the meshes of a gear of a design."""
    if isinstance(design, PairDesign):
        yield Mating(design.pair, Role(name))
    elif isinstance(design, RackPairDesign):
        yield Mating(design.pair, Role.PINION)
    elif isinstance(design, PlanetaryDesign):
        gear = design.gears[name]
        for pair in (*(mesh.pair for mesh in design.train.meshes), *(stage.pair for stage in design.train.stages)):
            yield from (Mating(pair, role) for role, each in pair.gears.items() if each == gear)


def _choices(gear: Gear, shelf: Shelf, known: tuple[ShelfTool, ...], mates: tuple[Mating, ...]) -> tuple[ToolChoice, ...]:
    """Return the tools for a gear. Of rows of one name that counts which a design takes, and those with a short lead."""
    fitting: list[ShelfTool] = []
    for name in dict.fromkeys(tool.name for tool in known):
        with suppress(InputError):
            fitting.append(shelf.find(name, gear.normal_module))
        fitting += [tool for tool in known if tool.name == name and short_lead_module(tool, gear) is not None]
    found = [_choice(gear, tool, mates) for tool in dict.fromkeys(fitting) if cuts(tool, gear)]
    return tuple(sorted(found, key=lambda each: (each.distance is None, each.distance or 0.0)))


def _made(gear: Gear, tool: ShelfTool, mates: tuple[Mating, ...]) -> Gear | InputError:
    """Return a gear as a tool would cut it, or why it cannot.

    A wheel ends at the root form circle that is asked for; where the root lets it not, as deep as it can before the circle down
    to which the mates touch.
    """
    try:
        return with_tool(gear, tool)
    except InputError as error:
        if mates and error.parameter == "finishing.end_diameter":
            first, last = gear.form_diameter, min(mate.active_root for mate in mates)
            for part in range(1, _ENDS + 1):
                with suppress(InputError):
                    return with_tool(gear, tool, first + (last - first) * part / _ENDS)
        return error


def _choice(gear: Gear, tool: ShelfTool, mates: tuple[Mating, ...]) -> ToolChoice:
    lead = short_lead_module(tool, gear)
    made = _made(gear, tool, mates)
    if isinstance(made, InputError):
        return ToolChoice(tool=tool, asked=gear, gear=None, faults=(str(made),), short_lead=lead)
    clearances, faults = list[float](), list[str]()
    for mate in mates:
        try:
            clearance, told = mate.tried(made)
        except InputError as error:
            faults.append(str(error))
            continue
        clearances.append(clearance)
        faults += told
        if clearance <= 0:
            faults.append(f"the tip of the mate reaches {-clearance:.4g} mm into the root")
    return ToolChoice(
        tool=tool,
        asked=gear,
        gear=made,
        distance=fillet_distance(gear.profile, made.profile),
        clearance=min(clearances, default=None),
        faults=tuple(dict.fromkeys(faults)),
        short_lead=lead,
    )


def write_tools(result: ShelfTools | ToolChoices, folder: Path) -> list[Path]:
    """Write tools.json, and tools.csv with the tools as a table for other designs. Raises OutputError, ParameterError."""
    listed = result.tools if isinstance(result, ShelfTools) else _found_tools(result)
    if not listed:
        raise ParameterError("output", str(folder), "must be left out: no tool of the shelf would cut these gears")
    with staged_files(folder) as staging:
        (staging / "tools.json").write_text(json_text(with_summary(result.to_dict())), encoding="utf-8", newline="\n")
        write_tool_table(listed, staging / FILE)
    return [folder / "tools.json", folder / FILE]


def _found_tools(result: ToolChoices) -> tuple[ShelfTool, ...]:
    return tuple(dict.fromkeys(choice.tool for each in result.gears.values() for choice in each.choices))


def write_tool_table(listed: Sequence[ShelfTool], path: Path) -> None:
    """Write a table of tools that a design can use."""
    keys = list(dict.fromkeys(key for tool in listed for key in tool.keys))
    rows = [
        [tool.name, cell_text(tool.normal_module), *(cell_text(tool.keys.get(key)) for key in keys), cell_text(tool.source)]
        for tool in listed
    ]
    write_csv(rows, ["name", "normal_module", *keys, "source"], path)
