"""Sizing tasks of textbooks and tutorials: what they propose, and pairs that are as safe and no heavier."""

import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from support.specs import rate_document, read_tables

from gearcad import Load, Material
from gearcad.core.records import PerGear
from gearcad.designs import PairDesign
from gearcad.rating import RatingOptions
from gearcad.sizing import SizedPair, SizeTask, search_pairs

_TASKS = json.loads((Path(__file__).parents[1] / "data" / "sizing_tasks.json").read_text(encoding="utf-8"))["tasks"]
_NAMES = {entry["id"]: entry for entry in _TASKS}

STEEL = 7850e-9
"""kg/mm³."""


class _Published(NamedTuple):
    """A proposal as we rate it, both gears of the lesser face width: mass (kg) and least safeties."""

    mass: float
    flank: float
    root: float


def _torque(given: dict[str, Any]) -> float:
    """N·m on the pinion."""
    return float(given.get("torque") or given["power_kw"] * 30_000 / (math.pi * given["speed"]))


def _published(name: str, folder: Path) -> _Published:
    given, proposal = _NAMES[name]["given"], _NAMES[name]["proposal"]
    width = min(widths) if isinstance(widths := proposal["face_width"], list) else widths
    rack = {f"rack.{key}": value for key, value in proposal.get("rack", {}).items()}
    gears = {
        role: {"teeth": proposal["teeth"][place], "profile_shift": proposal["profile_shift"][place], "face_width": width} | rack
        for place, role in enumerate(("pinion", "wheel"))
    }
    common = {key: proposal[key] for key in ("normal_module", "helix_angle", "centre_distance") if key in proposal}
    tables = {
        "pair": common,
        **gears,
        "material": given["material"],
        "load": {"torque": _torque(given), "speed": given["speed"], "application_factor": given["application_factor"]},
        "rating": {"life": given["life"], "accuracy_grade": given["accuracy_grade"]},
    }
    safety = rate_document(tables, folder)["safety"]
    design = read_tables(tables, folder)
    assert isinstance(design, PairDesign)
    circles = sum(gear.tip_diameter**2 + gear.root_diameter**2 for gear in design.pair.gears)
    least = {part: min(safety[part].values()) for part in ("flank", "root")}
    return _Published(math.pi / 8 * circles * width * STEEL, **least)


def _found(name: str, published: _Published, **ranges: Any) -> SizedPair:
    """The lightest pair that is as safe as the published one."""
    given = _NAMES[name]["given"]
    material = Material(**given["material"])
    task = SizeTask(
        load=Load(torque=_torque(given), speed=given["speed"], application_factor=given["application_factor"]),
        ratio=given["ratio"],
        materials=PerGear(material, material),
        rating=RatingOptions(
            life=given["life"],
            accuracy_grade=given["accuracy_grade"],
            required_safety_flank=published.flank,
            required_safety_root=published.root,
        ),
        **ranges,
    )
    return search_pairs(task, count=1, errors=0).found[0]


def test_the_tutorials_pair_is_found_at_its_centre_distance(tmp_path: Path) -> None:
    """Among pinions of 15 to 18 teeth at 24 to 26 degrees the lightest is that of the tutorial: 16/43, 25 degrees, 14 mm."""
    published = _published("kisssoft_tutorial_8", tmp_path)
    ranges = {"teeth": (15, 18), "modules": (1.25, 1.5, 2.0), "helix_angles": (24.0, 25.0, 26.0), "shifts": (0.2, 0.3, 0.4)}
    found = _found("kisssoft_tutorial_8", published, centre_distance=48.9, **ranges)
    assert (*found.teeth, found.normal_module, found.helix_angle) == (16, 43, 1.5, 25)
    assert found.face_width == 14
    assert found.pinion_shift == pytest.approx(0.3215, abs=0.05)
    assert found.mass == pytest.approx(published.mass, rel=0.002)


@pytest.mark.long
@pytest.mark.parametrize("name", _NAMES)
def test_no_published_proposal_is_lighter(name: str, tmp_path: Path) -> None:
    published = _published(name, tmp_path)
    found = _found(name, published)
    assert found.mass < published.mass
    assert min(found.flank_safeties) >= published.flank
    assert min(found.root_safeties) >= published.root
