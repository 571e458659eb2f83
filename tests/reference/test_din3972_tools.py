"""Tools of DIN 3972 on the shelf: against the table printed in the standard, and against a sweep of the tool as printed."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from gearcad import Gear
from gearcad.geometry.premachining import Finishing
from gearcad.geometry.tool_shelf import ToolName

DATA = Path(__file__).parent.parent / "data"
LINES = (DATA / "din3972_tools.csv").read_text(encoding="utf-8").splitlines()[1:]
TABLE = list(csv.DictReader(LINES))

MISPRINTS = {(1.5, "stock_IV"), (2.0, "addendum_III"), *((m, "addendum_IV") for m in (3.5, 3.75, 4.5, 5.5))}
"""Cells that differ from the formulas printed beside the table by more than half of their last digit."""


def cut(profile: str, module: float) -> Gear:
    """A gear of 40 teeth; a wheel grinds what the tools III and IV leave."""
    wheel = Finishing(end_diameter=39.2 * module, wheel_tip_radius=max(0.2 * module, 0.34))
    ground = {"finishing": wheel} if profile in ("III", "IV") else {}
    return Gear(teeth=40, normal_module=module, face_width=10.0, tool=f"DIN 3972 {profile}", **ground)


@pytest.mark.parametrize("profile", ["I", "II", "III", "IV"])
def test_every_tool_is_that_of_the_table(profile: str) -> None:
    for line in TABLE:
        module, printed = float(line["module"]), line[f"addendum_{profile}"]
        if not printed:
            continue
        gear = cut(profile, module)
        assert isinstance(gear.tool, ToolName) and gear.tool.tool is not None
        assert gear.root_radius * module == pytest.approx(float(line["tip_radius"]), abs=1e-9)
        figures = {f"addendum_{profile}": gear.tool.tool.addendum(module) * module, f"stock_{profile}": gear.stock}
        for name, value in figures.items():
            if text := line.get(name, ""):
                digit = 10.0 ** -len(text.partition(".")[2])
                most = 1.6 if (module, name) in MISPRINTS else 0.5 + 1e-9
                assert abs(value - float(text)) <= most * digit, (module, name)


@pytest.mark.parametrize(("profile", "module"), [("III", 4.0), ("IV", 2.5), ("IV", 10.0)])
def test_the_root_is_that_of_the_tool_as_it_is_printed(profile: str, module: float) -> None:
    """Sweep the tool, whose teeth are half a pitch thick, set further out until its flanks leave the stock."""
    line = next(each for each in TABLE if float(each["module"]) == module)
    factor = 0.25 if profile == "III" else 0.6
    addendum, radius = 1.25 * module + factor * math.cbrt(module), float(line["tip_radius"])
    angle, rolling, gear = math.radians(20), 20 * module, cut(profile, module)
    out = factor * math.cbrt(module)  # stock/sin 20 deg
    middle = math.pi * module / 4 - (addendum - radius) * math.tan(angle) - radius / math.cos(angle)
    turns = np.linspace(0, math.pi / 2 - angle, 181)
    u, v = middle + radius * np.sin(turns), radius - addendum - radius * np.cos(turns) + out
    rolls = np.linspace(-3.6, 3.6, 5401)[:, None] * module / rolling
    x, y = u - rolling * rolls, rolling + v
    radii, angles = np.hypot(x, y), np.arctan2(x, y) + rolls
    assert gear.root_diameter == pytest.approx(2 * (rolling - addendum + out), abs=1e-9)
    for wanted in np.linspace(radii.min() + 0.02 * module, radii.min() + 0.3 * module, 5):
        near = np.abs(radii - wanted) < 0.004 * module
        swept = math.pi / 40 - float(angles[near].max())
        # the places near a radius are up to .004 m off it, where the fillet is at most as steep as a flank
        half = [math.radians(gear.precut.profile.half_angle(wanted + side * 0.004 * module)) for side in (-1, 1)]
        assert min(half) - 1e-4 <= swept <= max(half) + 1e-4


def test_misprints_are_those_of_the_reference() -> None:
    """The six cells that another reading of the standard found."""
    told = json.loads((DATA / "din3972_misprints.json").read_text(encoding="utf-8"))
    named = {"stock_IV_printed": "stock_IV", "h_III_printed": "addendum_III", "h_IV_printed": "addendum_IV"}
    assert {(float(each["module"]), next(named[key] for key in each if key in named)) for each in told} == MISPRINTS
