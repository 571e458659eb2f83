"""Figures that the tables of a drawing must show, from the documents of `data` and of the tolerances, row by row."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from gearcad.core.quantities import symbols_of
from gearcad.drawing.assembly_sheets import member_title
from gearcad.drawing.drawing_subjects import DrawnGear, Mate, material_text, treatment_text
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.requirements import accuracy_grade_of, flank_roughness
from gearcad.drawing.words import SheetWords
from gearcad.geometry import NAMED_RACKS, FlankModification, Gear, Rack, RackPair
from gearcad.geometry.gear_tools import corner_radius, shaped
from gearcad.planetary import PlanetaryTrain
from gearcad.rating.tolerances import gear_tolerances
from gearcad.solids.train_plan import stage_keys

Document = Mapping[str, Any]
"""Part of the content of data.json."""

LENGTH = 3
"""Decimals of lengths (mm); small modules have one more."""

_SMALL_MODULE = 0.3
"""Module (mm) below which lengths have one more decimal."""

_SHORTEST, _COEFFICIENT = 6, 4
"""Decimals of inputs, which have no zeros at the end, and of coefficients and angles."""


@dataclass(frozen=True, kw_only=True)
class TableFigure:
    """What one row of a table must show: `words` and `symbol`, and the `values` in their order, each with its decimals.

    `text` is a whole text instead of values; `absent` is a dash with a reason. A row that is not `required` may be missing.
    """

    words: str
    symbol: str = ""
    values: Sequence[tuple[float, int]] = ()
    text: str = ""
    absent: bool = False
    required: bool = True


def gear_figures(drawn: DrawnGear, document: Document, words: SheetWords, options: DrawingOptions) -> list[TableFigure]:
    """Return the rows of the gear data table of a gear or a rack, `document` that of `data`."""
    decimals = LENGTH + (document["normal_module"] < _SMALL_MODULE)
    rows = _PartRows(drawn, document, words, decimals)
    own = rows.of_rack() if isinstance(drawn.gear, Rack) else rows.of_gear(drawn.gear)
    known = material_words(drawn, words, options)
    material = (rows.named(key, text=text, required=False) for key, text in known.items())
    return [*rows.common(), *own, *rows.last(), *material]


def material_words(drawn: DrawnGear, words: SheetWords, options: DrawingOptions) -> dict[str, str]:
    """Return material and heat treatment as far as they are known; a sheet has them in its table or its title block."""
    found = {"material": material_text(drawn, options, words), "heat_treatment": treatment_text(drawn, options, words)}
    return {key: text for key, text in found.items() if text}


_LENGTHS_OF_GEAR = {"reference_diameter": "d", "base_diameter": "d_b", "root_diameter": "d_f"}

_LENGTHS_OF_RACK = {
    "normal_pitch": ("p_n", "normal_pitch"),
    "reference_height": ("H_0", "height"),
    "tip_height": ("h_a", "tip_height"),
    "root_depth": ("h_f", "root_depth"),
    "normal_tooth_thickness": ("s_n", "normal_tooth_thickness"),
}

_TOLERANCES = {
    "ISO 1328-1:1995": ("f_pt", "F_p", "F_alpha", "F_beta", "F_r"),
    "ISO 1328-1:2013": ("f_pT", "F_pT", "F_alphaT", "F_betaT", "F_rT"),
}
"""Tolerances of the table by the standard, in their order."""

_TOLERANCE_WORDS = ("single_pitch", "cumulative_pitch", "profile_total", "helix_total", "runout")

_GREEK = {"alpha": "α", "beta": "β"}

_SHAPES = ("_length", "_shape", "_transition", "_source", "_rounding")
"""Endings of names in "modification" that are no amounts."""

_SYMBOLS = symbols_of(FlankModification)


@dataclass(frozen=True)
class _PartRows:
    """Rows of one part in the words of a sheet; lengths have `decimals` decimals."""

    drawn: DrawnGear
    data: Document
    words: SheetWords
    decimals: int

    def named(
        self,
        key: str,
        symbol: str = "",
        *values: tuple[float, int],
        text: str = "",
        absent: bool = False,
        required: bool = True,
        within: Mapping[str, object] | None = None,
    ) -> TableFigure:
        """Return a row by the key of its words; `within` are the values in braces."""
        label = self.words[f"data.{key}"].format(**(within or {}))
        return TableFigure(words=label, symbol=symbol, values=values, text=text, absent=absent, required=required)

    def length(self, key: str, symbol: str, value: float) -> TableFigure:
        return self.named(key, symbol, (abs(value), self.decimals))

    def common(self) -> Iterator[TableFigure]:
        """Yield the rows of kind, module, teeth, basic rack, pressure angle, helix angle and hand."""
        data, words, part = self.data, self.words, self.drawn.gear
        helix = data["helix_angle"]
        double = isinstance(part, Gear) and part.double_helix.present
        form = "rack" if isinstance(part, Rack) else "internal" if data["teeth"] < 0 else "external"
        kind = "double_helical" if double else "helical" if helix else "spur"
        yield self.named("kind", text=f"{words[f'data.{form}']}, {words[f'data.{kind}']}")
        pitch = (25.4 / data["normal_module"], _SHORTEST)
        yield self.named("normal_diametral_pitch", "P_nd", pitch, required=False)
        yield self.named("normal_module", "m_n", (data["normal_module"], _SHORTEST))
        yield self.named("teeth", "z", (data["teeth"], 0))
        yield from self._basic_rack()
        if "tool" in data:
            yield self.named("tool", text=f"{data['tool'].rpartition('/')[2]} ({data['tool_file']})")
        yield self.named("pressure_angle", "α_n", (data["rack"]["pressure_angle"], _SHORTEST))
        yield self.named("helix_angle", "β", (abs(helix), _COEFFICIENT))
        if helix:
            hands = [words["data.right"], words["data.left"]][:: 1 if helix > 0 else -1]
            both = " / ".join(hands[:: self.drawn.direction])
            yield self.named("hand_of_halves", text=both) if double else self.named("hand", text=hands[0])

    def _basic_rack(self) -> Iterator[TableFigure]:
        rack, part = self.data["rack"], self.drawn.gear
        dedendum = rack["dedendum"] if isinstance(part, Rack) else self._dedendum
        own = abs(dedendum - rack["dedendum"]) < 1e-9
        name = next((name for name, each in NAMED_RACKS.items() if own and each == part.rack), None)
        if name is not None and "premachining" not in self.data:
            yield self.named("basic_rack", text=name.replace("ISO53_", "ISO 53 "))
            return
        yield self.named("rack_addendum", "h_aP*", (rack["addendum"], _SHORTEST))
        if "premachining" in self.data:  # the tool of its rows makes the root
            return
        yield self.named("rack_dedendum", "h_fP*", (dedendum, _SHORTEST))
        full = rack["root_radius"] == "full"
        radius = (part.root_radius, _COEFFICIENT) if full else (float(rack["root_radius"]), _SHORTEST)
        yield self.named("rack_root_radius", "ρ_fP*", radius)

    @property
    def _dedendum(self) -> float:
        """Dedendum in modules, which the root diameter tells."""
        data = self.data
        return float((data["reference_diameter"] - data["root_diameter"]) / 2 / data["normal_module"] + data["profile_shift"])

    def of_gear(self, gear: Gear) -> Iterator[TableFigure]:
        """Yield the rows that only a gear has."""
        data = self.data
        shift = "profile_shift_of_ring" if gear.internal else "profile_shift"
        yield self.named(shift, "x", (data["profile_shift"], _COEFFICIENT))
        for key, symbol in _LENGTHS_OF_GEAR.items():
            yield self.length(key, symbol, data[key])
        yield self.named("tip_alteration", "k", (data["tip_alteration"], _COEFFICIENT), required=False)
        plain = data["undercut"] and "premachining" not in data
        yield self.length("undercut" if plain else "form_diameter", "d_Ff", data["form_diameter"])
        if offset := data["double_helix"]["offset"]:
            yield self.named("half_offset", "", (abs(offset) if abs(offset) == 0.5 else offset, _COEFFICIENT))
        yield self._grade()
        yield from self._thickness(gear)
        yield from self._mates()
        yield from self._tolerances(gear)

    def of_rack(self) -> Iterator[TableFigure]:
        """Yield the rows that only a rack has."""
        data = self.data
        for key, (symbol, name) in _LENGTHS_OF_RACK.items():
            yield self.length(key, symbol, data[name])
        if data["helix_angle"]:
            yield self.length("transverse_pitch", "p_t", data["transverse_pitch"])
        yield self.named("ball_diameter", "D_M", (data["pin_diameter"], _SHORTEST))
        over = data["over_pin"]
        yield self.named("over_pin", "M", absent=True) if over is None else self.length("over_pin", "M", over)
        yield from self._mates()
        yield self.named("tolerances", absent=True, within={"standard": self.drawn.accuracy.value})

    def _grade(self) -> TableFigure:
        grade = self.data["accuracy_grade"]
        grade = accuracy_grade_of(self.drawn) if grade is None else grade
        return self.named("accuracy", "", (grade, 0), within={"standard": self.drawn.accuracy.value})

    def _thickness(self, gear: Gear) -> Iterator[TableFigure]:
        """Yield the rows of tooth thickness, span, and size over or between balls and pins."""
        data, limits = self.data, self.data.get("thickness_limits")
        if limits is not None and (name := data["tooth_allowance"]) is not None:
            values = [(limits[f"allowance_{end}"], 0) for end in ("upper", "lower")]
            values = [(float(name), 0), *values] if name.isdigit() else values
            yield self.named("tooth_allowance", "A_sn", *values)
        yield self._gauge("normal_tooth_thickness", "normal_tooth_thickness", "s_n")
        name = "span_spaces" if gear.internal else "span_teeth"
        if data.get(name) is not None:
            yield self._gauge(name, "span_measurement", "W_k", {"k": data[name]})
        yield self.named("ball_diameter", "D_M", (data["ball_diameter"], _SHORTEST))
        name = "between_balls" if gear.internal else "over_balls"
        shift = 0.0 if gear.internal else data["pin_axial_shift"]
        either = not shift and not (gear.internal and data["helix_angle"])
        yield self._gauge(f"{name}_or_pins" if either else name, name, "M_dK")
        if shift:
            yield self._gauge("over_pins", "over_pins", "M_dR")

    def _gauge(self, key: str, name: str, symbol: str, within: Mapping[str, object] | None = None) -> TableFigure:
        """Return the row of a gauge's reading: its limits, else its value; absent where a notice says that it does not fit."""
        codes = {each["code"] for each in self.data["notices"]}
        limits = self.data.get("thickness_limits")
        if codes.intersection(_UNFIT.get(name, ())):
            return self.named(key, symbol, absent=True, within=within)
        names = [name] if limits is None else [f"{name}_{end}" for end in ("greatest", "least")]
        values = [value for each in names if (value := (self.data if limits is None else limits).get(each)) is not None]
        if len(values) < len(names):
            return self.named(key, symbol, absent=True, within=within)
        return self.named(key, symbol, *((value, self.decimals) for value in values), within=within)

    def _mates(self) -> Iterator[TableFigure]:
        """Yield the rows of the mates: distances, each once, and teeth."""
        seen = set[str]()
        for mate in self.drawn.mates:
            distance = self._distance(mate)
            shown = str([round(value, places) for value, places in distance.values])
            if shown not in seen:
                yield distance
            seen.add(shown)
            yield self.named("mate", "z", (float(mate.gear.teeth or 0), 0))

    def _distance(self, mate: Mate) -> TableFigure:
        if isinstance(mate.pair, RackPair):
            return self.length("mounting_distance", "H", mate.pair.mounting_distance)
        return self.named("centre_distance", "a", *distance_values(mate.pair.to_dict(), self.decimals))

    def _tolerances(self, gear: Gear) -> Iterator[TableFigure]:
        """Yield the tolerances (µm) of the grade, as `rate` has them."""
        standard = self.drawn.accuracy
        found = gear_tolerances(gear, accuracy_grade_of(self.drawn), standard).to_dict()
        for key, name in zip(_TOLERANCE_WORDS, _TOLERANCES[standard.value], strict=True):
            symbol, value = name, found[name]
            for word, letter in _GREEK.items():
                symbol = symbol.replace(word, letter)
            yield self.named(key, symbol, absent=True) if value is None else self.named(key, symbol, (value, 1))

    def last(self) -> Iterator[TableFigure]:
        """Yield the rows of roughness, modifications, cutter and chamfer."""
        data, part = self.data, self.drawn.gear
        given = data.get("flank_roughness")
        yield self.named("flank_roughness", "", (flank_roughness(self.drawn).value if given is None else given, 2))
        if (root := data.get("root_roughness")) is not None:
            yield self.named("root_roughness", "", (root, 2))
        if isinstance(part, Gear):
            yield from self._modifications()
            yield from self._premachining()
            yield from self._cutter(part)
        else:
            yield from self._rack_premachining()
        height = data["tip_chamfer"] if isinstance(part, Rack) else data["body"]["tip_chamfer"]
        if height:
            yield self.named("tip_chamfer", "h_K", (height, LENGTH), (45, 0))

    def _modifications(self) -> Iterator[TableFigure]:
        given = self.data["modification"]
        used = {name: value for name, value in given.items() if not name.endswith(_SHAPES) and value}
        for name, amount in used.items():
            lengths = [(length, LENGTH)] if (length := given.get(f"{name}_length")) else []
            yield self.named(name, _SYMBOLS[name].symbol, (amount, 2), *lengths)
            if (transition := given.get(f"{name}_transition")) is not None:
                yield self.named(f"{name}_transition", "t", (transition, LENGTH))
        if used:
            yield self.named("modifications", text=self.words["data.see_diagram"])

    def _premachining(self) -> Iterator[TableFigure]:
        """Yield the rows of the tool that cuts before finishing; its sizes from the inputs, those of gauges from the data."""
        pre, data = self.data.get("premachining"), self.data
        if pre is None:
            return
        module = data["normal_module"]
        depth = (data["reference_diameter"] - data["root_diameter"]) / 2 / module + data["profile_shift"]
        yield from self._tool(pre, depth)
        if pre["tool_pressure_angle"] is not None:
            angles = (math.radians(data["rack"]["pressure_angle"]), math.radians(pre["tool_pressure_angle"]))
            own = module * math.cos(angles[0]) / math.cos(angles[1])
            values = (own, _SHORTEST), (pre["tool_pressure_angle"], _COEFFICIENT)
            yield self.named("short_lead_tool", "m_0 / α_n0", *values)
        elif pre["tool_module"] is not None:
            angle = math.acos(module * math.cos(math.radians(data["rack"]["pressure_angle"])) / pre["tool_module"])
            yield self.named(
                "short_lead_tool", "m_0 / α_n0", (pre["tool_module"], _SHORTEST), (math.degrees(angle), _COEFFICIENT)
            )
        yield self._stock(pre)
        before = pre["precut"]
        if before["span_measurement"] is not None:
            within = {"k": str(before["span_teeth"])}
            yield self.named("precut_span", "W_k", (before["span_measurement"], self.decimals), within=within, required=False)
        for key in ("over_balls", "between_balls"):
            if before.get(key) is not None:
                values = (before[key], self.decimals), (before["ball_diameter"], _SHORTEST)
                yield self.named(f"precut_{key}", "M_dK / D_M", *values)

    def _tool(self, pre: Mapping[str, Any], addendum: float) -> Iterator[TableFigure]:
        yield self.named("tool_addendum", "h_aP0*", (addendum, _SHORTEST))
        yield self.named("tool_tip_radius", "ρ_aP0*", (pre["tool_tip_radius"], _SHORTEST))
        if pre["protuberance_angle"] is not None:
            values = (pre["protuberance"], _COEFFICIENT), (pre["protuberance_angle"], _COEFFICIENT)
            yield self.named("protuberance", "p_rP0", *values)

    def _stock(self, pre: Mapping[str, Any]) -> TableFigure:
        tolerance = [(pre["stock_tolerance"], _COEFFICIENT)] if pre["stock_tolerance"] else []
        return self.named("stock", "q", (pre["stock"], _COEFFICIENT), *tolerance)

    def _rack_premachining(self) -> Iterator[TableFigure]:
        """Yield the rows of the tool that cuts a rack before finishing, and of the height over a pin then."""
        if (pre := self.data.get("premachining")) is None:
            return
        yield from self._tool(pre, self.data["root_depth"] / self.data["normal_module"])
        yield self._stock(pre)
        before = pre["precut"]
        if before["over_pin"] is not None:
            values = (before["over_pin"], self.decimals), (before["pin_diameter"], _SHORTEST)
            yield self.named("precut_over_pin", "M / D_M", *values)

    def _cutter(self, gear: Gear) -> Iterator[TableFigure]:
        cutter, diameter = self.data["cutter"], self.data["cutter_tip_diameter"]
        if pre := self.data.get("premachining"):
            cutter = {"teeth": pre["cutter_teeth"], "profile_shift": pre["cutter_profile_shift"]}
        if shaped(gear):
            yield self.length("corner_radius", "ρ_a0", corner_radius(gear) * gear.normal_module)
        if cutter["teeth"] is None or diameter is None:
            return
        yield self.named("cutter_teeth", "z_0", (cutter["teeth"], 0))
        yield self.named("cutter_profile_shift", "x_0", (cutter["profile_shift"], _COEFFICIENT))
        yield self.length("cutter_tip_diameter", "d_a0", diameter)


_UNFIT = {
    "span_measurement": ("span-off-involute", "narrow-for-span"),
    "over_balls": ("balls-off-involute",),
    "between_balls": ("balls-off-involute",),
    "over_pins": ("balls-off-involute", "narrow-for-pins"),
}
"""Codes of notices that a gauge does not fit."""


def distance_values(pair: Document, decimals: int = LENGTH) -> list[tuple[float, int]]:
    """Return the centre distance (mm) of a pair, and the size of its allowance (mm) where it has a tolerance."""
    values = [(abs(pair["centre_distance"]), decimals)]
    if pair.get("centre_distance_tolerance") is not None:
        values.append((pair["backlash_limits"]["centre_distance_allowance"] / 1000, 4))
    return values


def pair_figures(data: Document, parts: Sequence[DrawnGear], words: SheetWords) -> list[TableFigure]:
    """Return the rows of the table of a pair, or of a pinion with a rack; `data` is the whole content of data.json."""
    first, second = (data[part.role] for part in parts)
    pair, rack = data["pair"], "mounting_distance" in data["pair"]
    rows = [
        _of_mesh(words, "mounting_distance", "H", (pair["mounting_distance"], LENGTH))
        if rack
        else _of_mesh(words, "centre_distance", "a", *distance_values(pair))
    ]
    if pair.get("axial_offset"):
        rows.append(_of_mesh(words, "axial_offset", "", (pair["axial_offset"], LENGTH), item="2"))
    rows.append(_of_mesh(words, "normal_module", "m_n", (first["normal_module"], _SHORTEST)))
    teeth = [(each["teeth"], 0) for each in (first, second)]
    rows.append(_of_mesh(words, "teeth", "z_1 / z_2", *teeth, first="1", second="2"))
    if rack:
        rows.append(_of_mesh(words, "rack_length", "L", (second["length"], LENGTH)))
        rows.append(_of_mesh(words, "travel", "", (pair["travel_per_revolution"], LENGTH)))
    else:
        rows.append(_of_mesh(words, "gear_ratio", "u", (pair["gear_ratio"], _COEFFICIENT)))
    if first["helix_angle"]:
        rows.append(_of_mesh(words, "helix_angle", "β", (abs(first["helix_angle"]), _COEFFICIENT), item="1"))
    for name, symbol in (("circumferential", "j_wt"), ("normal", "j_bn")):
        rows.append(_of_mesh(words, f"{name}_backlash", symbol, *_backlash(pair, name)))
    for item, part in enumerate(parts, 1):
        if isinstance(part.gear, Rack):
            rows.append(TableFigure(words=words["assembly.accuracy"].format(item=item), absent=True))
        else:
            rows.append(_of_mesh(words, "accuracy", "", (accuracy_grade_of(part), 0), item=item))
    return rows


def _of_mesh(words: SheetWords, key: str, symbol: str, *values: tuple[float, int], **within: object) -> TableFigure:
    return TableFigure(words=words[f"assembly.{key}"].format(**within), symbol=symbol, values=values)


def _backlash(pair: Document, name: str) -> list[tuple[float, int]]:
    """Greatest and least backlash (mm) by its name ("normal"), or the nominal one where nothing has a tolerance."""
    limits = pair.get("backlash_limits")
    if limits is None:
        return [(pair[f"{name}_backlash"], LENGTH)]
    return [(limits[f"{name}_{end}"], LENGTH) for end in ("greatest", "least")]


def train_figures(data: Document, train: PlanetaryTrain, words: SheetWords) -> list[TableFigure]:
    """Return the rows of the table of a planetary train; `data` is the whole content of data.json."""
    own = data["planetary"]
    keys = [*(each.name for each in train.centrals), *(each.name for each in train.rims)]
    keys += [key for pair in stage_keys(train) for key in pair]
    items = {key: number for number, key in enumerate(keys, 1)}
    titles = {name: member_title(train, name, words) for name in (own["input"], own["output"], own["fixed"]) if name}
    ends = [titles[own[end]] for end in ("input", "output")]
    if own["ratio"] is None:
        rows = [TableFigure(words=words["assembly.input_output"], text=" / ".join(ends))]
    else:
        first, last = map(words.within_text, ends)
        rows = [_of_mesh(words, "ratio", "i", (own["ratio"], _COEFFICIENT), input=first, output=last)]
    fixed = titles[own["fixed"]] if own["fixed"] else words["assembly.no_fixed"]
    rows.append(TableFigure(words=words["assembly.fixed"], text=fixed))
    rows.append(_of_mesh(words, "planets", "N", (own["planets"], 0)))
    rows.append(_of_mesh(words, "centre_distance", "a", (abs(own["centre_distance"]), LENGTH)))
    for mesh in train.meshes:
        gears = (mesh.central.name, mesh.rim.name)
        rows += _of_two(data, gears, own["meshes"][mesh.name], items, words)
    for stage, gears in zip(train.stages, stage_keys(train), strict=True):
        pair, named = own["stages"][stage.name], _items_of(gears, items)
        rows.append(_of_mesh(words, "stage_distance", "a", *distance_values(pair), **named))
        rows += _of_two(data, gears, pair, items, words)
    return rows


def _of_two(
    data: Document, gears: tuple[str, str], pair: Document, items: Mapping[str, int], words: SheetWords
) -> Iterator[TableFigure]:
    """Yield the rows of two gears of a train in mesh: module, teeth and backlash."""
    module, named = data[gears[0]]["normal_module"], _items_of(gears, items)
    yield _of_mesh(words, "mesh", "m_n; z", (module, _SHORTEST), *((data[name]["teeth"], 0) for name in gears), **named)
    yield _of_mesh(words, "mesh_backlash", "j_bn", *_backlash(pair, "normal"), **named)


def _items_of(gears: tuple[str, str], items: Mapping[str, int]) -> dict[str, int]:
    return dict(zip(("first", "second"), (items[name] for name in gears), strict=True))
