"""Random gears and pairs over the whole parameter space that is promised, valid or not."""

import re
from dataclasses import fields, replace
from typing import Any

import numpy as np
from hypothesis import strategies as st

from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, GeometryError, Rack, RackPair
from gearcad.core.errors import InputError
from gearcad.geometry import HubSide
from support.modified import roll_ends

MOST_TEETH = 300


def _number(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False, allow_infinity=False)


def _often(value: Any, rest: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """The ordinary value half of the time."""
    return st.one_of(st.just(value), rest)


TEETH = st.one_of(st.integers(3, 12), st.integers(8, 60), st.integers(3, MOST_TEETH))
MODULE = st.one_of(st.just(1.0), _number(0.1, 20), _number(0.01, 200))
HELIX = st.one_of(st.just(0.0), _number(0.001, 60), _number(-60, -0.001))
SHIFT = st.one_of(st.just(0.0), _number(-0.4, 0.6), _number(-0.4, 0.6), _number(-1.5, 1.5), _number(-5, 5))
THINNING = _often(0.0, _number(0, 0.15))
PRESSURE_ANGLE = st.one_of(st.sampled_from([20.0, 14.5, 25.0, 30.0]), _number(12, 32), _number(5, 45))


@st.composite
def basic_racks(draw: st.DrawFn, pressure_angle: float) -> dict[str, Any]:
    """A rack: standard, or a drawn addendum with some bottom clearance; the tip radius up to a little beyond the full one."""
    addendum = draw(_often(1.0, _number(0.4, 1.4)))
    dedendum = addendum + draw(_often(0.25, _number(0.02, 0.6)))
    rack = BasicRack(pressure_angle=pressure_angle, addendum=addendum, dedendum=dedendum, root_radius="full")
    share = draw(st.one_of(st.sampled_from([0.8, 0.5, 0.0]), _number(0, 1.02)))
    drawn = draw(_often(max(share * rack.full_root_radius(), 0.0), st.sampled_from(["full", 0.38])))
    return {"pressure_angle": pressure_angle, "addendum": addendum, "dedendum": dedendum, "root_radius": drawn}


@st.composite
def _bodies(draw: st.DrawFn) -> dict[str, Any]:
    """Parts of a body in normal modules (and per module of reference diameter, which `build_gear` knows)."""
    return {
        "bore": draw(_often(0.0, _number(0, 0.9))),
        "keyway": draw(_often(0.0, _number(0.05, 0.5))),
        "hub": draw(_often(0.0, _number(0.1, 0.95))),
        "hub_side": draw(st.sampled_from(HubSide)),
        "end_chamfer": draw(_often(0.0, _number(0.05, 1))),
        "end_chamfer_angle": draw(_number(10, 70)),
        "tip_chamfer": draw(_often(0.0, _number(0.002, 0.5))),
    }


@st.composite
def gear_inputs(draw: st.DrawFn) -> dict[str, Any]:
    """Inputs of one gear; lengths in normal modules, overrides as changes of the derived radii."""
    return {
        "teeth": draw(TEETH),
        "normal_module": draw(MODULE),
        "helix_angle": draw(HELIX),
        "profile_shift": draw(SHIFT),
        "tip_alteration": draw(_often(0.0, _number(-0.4, 0.3))),
        "thinning": draw(THINNING),
        "width": draw(_number(0.5, 15)),
        "rack": draw(basic_racks(draw(PRESSURE_ANGLE))),
        "tip_change": draw(_often(None, _number(-0.6, 0.4))),
        "root_change": draw(_often(None, _number(-0.6, 0.8))),
        "body": draw(_bodies()),
    }


def _owned(owner: str, kind: type[Any], **inputs: Any) -> Any:
    """A part of a gear; its errors name it as the gear's user knows it."""
    try:
        return kind(**inputs)
    except InputError as error:
        raise error.within(owner) from None


def build_gear(inputs: dict[str, Any]) -> Gear:
    """The gear of some drawn inputs; raises GearcadError where there is none."""
    m, body, shift = inputs["normal_module"], inputs["body"], inputs["profile_shift"]
    plain = {
        "teeth": inputs["teeth"],
        "normal_module": m,
        "face_width": inputs["width"] * m,
        "helix_angle": inputs["helix_angle"],
        "profile_shift": shift,
        "tip_alteration": inputs["tip_alteration"],
        "tooth_thinning": inputs["thinning"] * m,
        "rack": _owned("rack", BasicRack, **inputs["rack"]),
    }
    core = max(inputs["teeth"] - 2 * (inputs["rack"]["dedendum"] - shift), 0.0) * m
    bore = body["bore"] * core
    made = _owned(
        "body",
        Body,
        bore=bore,
        keyway_width=body["keyway"] * bore,
        keyway_depth=body["keyway"] * bore / 2,
        hub_diameter=body["hub"] * core,
        hub_length=m if body["hub"] * core else 0.0,
        hub_side=body["hub_side"],
        end_chamfer=body["end_chamfer"] * m,
        end_chamfer_angle=body["end_chamfer_angle"],
        tip_chamfer=body["tip_chamfer"] * m,
    )
    gear = Gear(**plain)
    given = {}
    for end in ("tip", "root"):
        if inputs[f"{end}_change"] is not None:
            given[f"{end}_diameter"] = getattr(gear, f"{end}_diameter") + 2 * m * inputs[f"{end}_change"]
    return Gear(**plain, **given, body=made)


_AMOUNTS = {name: st.one_of(st.just(0.0), st.floats(-0.03, 0.03)) for name in ("profile_crowning", "lead_crowning", "twist")}
_AMOUNTS |= {name: st.one_of(st.just(0.0), st.floats(0.0, 0.05)) for name in ("tip_relief", "root_relief", "end_relief")}
_AMOUNTS |= {name: st.floats(-0.03, 0.03) for name in ("pressure_angle_modification", "helix_angle_modification")}

MODIFICATIONS = st.one_of(st.none(), st.fixed_dictionaries({**_AMOUNTS, "share": st.floats(0.02, 0.5)}))
"""Amounts in normal modules, and the lengths of reliefs as a share of the flank."""


def modified(gear: Gear, drawn: dict[str, float] | None) -> Gear:
    """The gear with modified flanks; raises GeometryError where they do not fit."""
    if drawn is None:
        return gear
    first, last = roll_ends(gear)
    lengths = {f"{end}_relief_length": drawn["share"] * (last - first) for end in ("tip", "root")}
    amounts = {name: np.clip(1000 * drawn[name] * gear.normal_module, -999, 999) for name in _AMOUNTS}
    modification = FlankModification(**lengths, end_relief_length=drawn["share"] * gear.face_width, **amounts)
    return replace(gear, modification=modification)


@st.composite
def pair_inputs(draw: st.DrawFn) -> dict[str, Any]:
    """Inputs of a pair: two gears that share what they must, and how they are set up."""
    angle = draw(PRESSURE_ANGLE)
    first = draw(basic_racks(angle))
    second = draw(_often(first, basic_racks(angle)))
    gears = [
        {
            "teeth": draw(TEETH),
            "profile_shift": draw(SHIFT),
            "thinning": draw(THINNING),
            "width": draw(_number(1, 15)),
            "tip_chamfer": draw(_often(0.0, _number(0.01, 0.2))),
            "rack": rack,
        }
        for rack in (first, second)
    ]
    return {
        "normal_module": draw(MODULE),
        "helix_angle": draw(HELIX),
        "gears": gears,
        "spread": draw(_often(None, _number(0, 0.4))),
        "shortened": draw(st.booleans()),
        "axial_offset": draw(_often(0.0, _number(-5, 5))),
    }


def build_pair(inputs: dict[str, Any]) -> GearPair:
    """The pair of some drawn inputs; raises GearcadError where there is none."""
    m = inputs["normal_module"]

    def gear(index: int, k: float) -> Gear:
        one = inputs["gears"][index]
        return Gear(
            teeth=one["teeth"],
            normal_module=m,
            face_width=one["width"] * m,
            helix_angle=(1, -1)[index] * inputs["helix_angle"],
            profile_shift=one["profile_shift"],
            tip_alteration=k,
            tooth_thinning=one["thinning"] * m,
            rack=BasicRack(**one["rack"]),
            body=Body(tip_chamfer=one["tip_chamfer"] * m),
        )

    def pair(k: float, distance: float | None) -> GearPair:
        return GearPair(pinion=gear(0, k), wheel=gear(1, k), centre_distance=distance, axial_offset=inputs["axial_offset"] * m)

    # A short tip for the first look, so that a clash of the full tips does not hide the pair that shortening allows.
    first = pair(-0.3 if inputs["shortened"] else 0.0, None)
    distance = None if inputs["spread"] is None else first.centre_distance + inputs["spread"] * m
    spread = first if distance is None else pair(first.pinion.tip_alteration, distance)
    return pair(spread.tip_alteration if inputs["shortened"] else 0.0, distance)


FIELDS = {
    "": {field.name for field in fields(Gear)},
    "rack.": {field.name for field in fields(BasicRack)},
    "body.": {field.name for field in fields(Body)},
}


def names_a_field(error: InputError) -> bool:
    """Whether the error is one line that names a field a user can change, as seen from a gear."""
    owner, _, name = error.parameter.rpartition(".")
    known = {prefix for prefix, names in FIELDS.items() if name in names}
    return "\n" not in str(error) and (f"{owner}." if owner else "") in known


@st.composite
def rack_inputs(draw: st.DrawFn) -> dict[str, Any]:
    """Inputs of a rack by itself; lengths in normal modules, that of the rack in pitches."""
    return {
        "normal_module": draw(MODULE),
        "helix_angle": draw(HELIX),
        "thinning": draw(THINNING),
        "tip_alteration": draw(_often(0.0, _number(-0.4, 0.3))),
        "tip_chamfer": draw(_often(0.0, _number(0.002, 0.5))),
        "width": draw(_number(0.5, 15)),
        "below": draw(_number(0.11, 8)),
        "pitches": draw(st.one_of(st.integers(1, 12), _number(1, 12))),
        "rack": draw(basic_racks(draw(PRESSURE_ANGLE))),
    }


def build_rack(inputs: dict[str, Any]) -> Rack:
    """The rack of some drawn inputs; raises GearcadError where there is none."""
    m, pitches = inputs["normal_module"], inputs["pitches"]
    pitch = np.pi * m / np.cos(np.radians(inputs["helix_angle"]))
    return Rack(
        **{"teeth": pitches} if isinstance(pitches, int) else {"length": pitches * pitch},
        normal_module=m,
        face_width=inputs["width"] * m,
        height=(inputs["rack"]["dedendum"] + inputs["below"]) * m,
        helix_angle=inputs["helix_angle"],
        tip_alteration=inputs["tip_alteration"],
        tooth_thinning=inputs["thinning"] * m,
        tip_chamfer=inputs["tip_chamfer"] * m,
        rack=_owned("rack", BasicRack, **inputs["rack"]),
    )


@st.composite
def rack_pair_inputs(draw: st.DrawFn) -> dict[str, Any]:
    """Inputs of a pinion and a rack that share what they must; `spread` is how much farther than r + x m_n they stand."""
    angle = draw(PRESSURE_ANGLE)
    first = draw(basic_racks(angle))
    return {
        "rack": draw(rack_inputs()) | {"rack": draw(_often(first, basic_racks(angle)))},
        "pinion": first,
        "teeth": draw(TEETH),
        "profile_shift": draw(SHIFT),
        "thinning": draw(THINNING),
        "width": draw(_number(1, 15)),
        "tip_chamfer": draw(_often(0.0, _number(0.01, 0.2))),
        "spread": draw(_often(0.0, _number(-0.1, 0.4))),
    }


def build_rack_pair(inputs: dict[str, Any]) -> RackPair:
    """The pair of some drawn inputs; raises GearcadError where there is none."""
    rack, m = build_rack(inputs["rack"]), inputs["rack"]["normal_module"]
    pinion = Gear(
        teeth=inputs["teeth"],
        normal_module=m,
        face_width=inputs["width"] * m,
        helix_angle=-rack.helix_angle,
        profile_shift=inputs["profile_shift"],
        tooth_thinning=inputs["thinning"] * m,
        rack=_owned("rack", BasicRack, **inputs["pinion"]),
        body=Body(tip_chamfer=inputs["tip_chamfer"] * m),
    )
    usual = pinion.reference_diameter / 2 + (pinion.profile_shift + inputs["spread"]) * m
    return RackPair(pinion=pinion, rack=rack, mounting_distance=usual)


def permitted_beside(error: GeometryError, parameter: str, text: str) -> float:
    """The permitted value that a refusal names: one line about this parameter, with this text and a limit."""
    assert error.parameter == parameter
    assert text in str(error)
    assert "\n" not in str(error)
    wording = re.search(r"must be (at most|at least|above|below|between|)\D*?(-?\d+(?:\.\d+)?)", error.permitted)
    assert wording, error.permitted
    return float(wording[2]) + {"above": 1e-6, "below": -1e-6, "between": 1e-6}.get(wording[1], 0.0)
