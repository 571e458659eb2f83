"""Results on the page: every figure is that of check.json or dynamics.json, and of the inputs that it is said to be of."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.commands import invoke

from gearcad.core.units import UnitSystem
from gearcad.designs.reader import starter_text
from gearcad.page.run_process import ANALYSES, design_of, mesh_pair
from gearcad.page.runs import Run, Runs, RunState
from gearcad.page.shown_results import FILE, read_shown
from gearcad.page.words import PageLanguage, PageWords

ENOUGH = 300.0
QUICK = '\n[check]\npositions = 12\nrefinement = 0.5\nconvergence = "off"\nbody_teeth = 5\ntorques = [20.0]\n'

PAIR = """
[pair]
normal_module = 3
face_width = 12
tooth_thinning = 0.05
[pinion]
teeth = 21
profile_shift = 0.2
[pinion.modification]
tip_relief = 20
tip_relief_length = 2
tip_relief_shape = "parabolic"
[wheel]
teeth = 32
[load]
torque = 120
speed = 1500
"""


@pytest.fixture(scope="module")
def runs() -> Iterator[Runs]:
    made = Runs()
    yield made
    made.close()


def _done(runs: Runs, kind: str, text: str, name: str = "mine") -> Run:
    run = runs.start(kind, text, name, Path(), {})
    assert run.ended.wait(ENOUGH)
    assert run.state is RunState.DONE, run.line
    return run


def _document(run: Run, name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((run.folder / name).read_text(encoding="utf-8"))
    return found


@pytest.fixture(scope="module")
def plane(runs: Runs) -> Run:
    return _done(runs, "check-2d", PAIR + QUICK)


@pytest.fixture(scope="module")
def solid(runs: Runs) -> Run:
    return _done(runs, "check-3d", PAIR + QUICK)


def _shown(run: Run) -> dict[str, Any]:
    found = read_shown(run.folder)
    assert found is not None
    return found


def test_curves_are_those_of_the_file(plane: Run) -> None:
    document, shown = _document(plane, "check.json"), _shown(plane)
    assert shown["curves"] == document["mesh_cycle"]
    for key, value in shown["summary"].items():
        assert value == document["summary"][key]
    assert FILE not in plane.files, "it is no result for the user"


@pytest.mark.parametrize("model", ["plane", "solid"])
def test_roots_are_as_stressed_as_the_file_says(model: str, request: pytest.FixtureRequest) -> None:
    run = request.getfixturevalue(model)
    cycle, shown = _document(run, "check.json")["mesh_cycle"], _shown(run)
    for role in ("pinion", "wheel"):
        greatest = max(max(row) for row in shown["roots"][role]["stress"])
        assert greatest == pytest.approx(max(cycle[f"root_stress_{role}"]), abs=0.051)  # one decimal is sent
    if model == "plane":
        # At each position the greatest of all teeth is what the file has, to the decimal that is sent.
        place = np.array(shown["roots"]["pinion"]["place"])
        rows = np.array(shown["roots"]["pinion"]["stress"]).max(axis=1)
        for angle, stress in zip(cycle["roll_angle"], cycle["root_stress_pinion"], strict=True):
            at = shown["pitch_point"] + math.radians(angle) * shown["base"]
            here = np.abs((place - at) / shown["base_pitch"] - np.round((place - at) / shown["base_pitch"])) < 1e-3
            assert rows[here].max() == pytest.approx(stress, abs=0.051)


def test_pressures_and_shares_are_those_of_the_file(plane: Run) -> None:
    cycle, shown = _document(plane, "check.json")["mesh_cycle"], _shown(plane)
    of_file = sorted(
        (shown["pitch_point"] + math.radians(angle) * shown["base"] + pair * shown["base_pitch"], share, pressure or 0.0)
        for angle, shares, pressures in zip(cycle["roll_angle"], cycle["load_share"], cycle["contact_pressure"], strict=True)
        for pair, share, pressure in zip(cycle["pairs"], shares, pressures, strict=True)
        if share
    )
    contacts = shown["contacts"]
    rows = zip(contacts["place"], contacts["share"], [pressure or 0.0 for pressure in contacts["pressure"]], strict=True)
    assert np.array(of_file) == pytest.approx(np.array(list(rows)), abs=1e-4)  # places have four decimals


def test_pattern_of_solids_is_that_of_the_file(solid: Run) -> None:
    document, shown = _document(solid, "check.json"), _shown(solid)
    pressures = [pressure for position in document["load_distribution"] for line in position for pressure in line["pressure"]]
    pattern = np.array(shown["pattern"]["pressure"], float)
    assert np.nanmax(pattern) == pytest.approx(max(pressures), abs=0.051)
    rolls = [roll for position in document["load_distribution"] for line in position for roll in line["pinion_roll_length"]]
    assert min(rolls) <= min(shown["pattern"]["pinion"]) <= max(shown["pattern"]["pinion"]) <= max(rolls)
    assert shown["pattern"]["across"] == pytest.approx(document["face"]["across"], abs=1e-4)


def test_coloured_flanks_of_bodies_lie_on_the_gears(solid: Run) -> None:
    pair = design_of(PAIR, "mine", Path()).pair  # type: ignore[attr-defined]
    for role, gear in pair.gears.items():
        points = np.array(_shown(solid)["teeth"][role.value]["pressure"]["points"]).reshape(-1, 3)
        radius, angle = np.hypot(*points[:, :2].T), np.arctan2(points[:, 1], points[:, 0])
        # The half angle of a tooth from its thickness at the reference circle and the involute function (ISO 21771).
        r, alpha = gear.reference_diameter / 2, math.radians(20)
        at = np.arccos(gear.base_diameter / 2 / radius)
        half = gear.transverse_tooth_thickness / 2 / r + math.tan(alpha) - alpha - (np.tan(at) - at)
        assert angle == pytest.approx(half, abs=2e-5)
        assert 0 <= points[:, 2].min() < points[:, 2].max() <= gear.face_width


def test_what_is_drawn_is_what_the_file_has(plane: Run, solid: Run) -> None:
    pytest.importorskip("nicegui")
    from gearcad.page.panels.results import coloured_kinds, drawn_part, views_of

    german = PageWords.of(PageLanguage.GERMAN)
    document, shown = _document(plane, "check.json"), _shown(plane)
    cycle = document["mesh_cycle"]
    curves, flank = views_of(shown, german)
    *shares, errors, stiffness = ([value for _, value in series["data"]] for series in curves["option"]["series"])
    assert errors == cycle["transmission_error"] and stiffness == cycle["mesh_stiffness"]
    assert np.transpose(shares) == pytest.approx(100 * np.array(cycle["load_share"]), rel=1e-12)
    for series in curves["option"]["series"]:
        assert [angle for angle, _ in series["data"]] == cycle["roll_angle"]
    pressure = document["summary"]["contact_pressure"]
    assert f"{pressure:.1f} MPa".replace(".", ",") in curves["told"]
    assert flank["option"]["visualMap"]["max"] == pressure
    curves, flank = views_of(shown, PageWords.of(PageLanguage.ENGLISH, UnitSystem.INCH))
    *_, errors, stiffness = ([value for _, value in series["data"]] for series in curves["option"]["series"])
    assert errors == pytest.approx([each / 0.0254 for each in cycle["transmission_error"]])  # 1 µin is 0.0254 µm
    assert stiffness == pytest.approx([each * 25.4 * 0.0254 / 4.4482216152605 for each in cycle["mesh_stiffness"]])
    assert [each["unit"] for each in curves["curves"]] == ["%", "µin", "lbf/(in·µin)"]
    assert f"{pressure / 6.894757293168:.2f} ksi" in curves["told"]
    assert flank["option"]["visualMap"]["max"] == pytest.approx(pressure / 6.894757293168)
    drawn = drawn_part(shown)
    assert drawn is not None and drawn["limits"]["pressure"] == pressure
    design = design_of(PAIR, "mine", Path())
    kinds = coloured_kinds(_shown(solid), design, german)
    assert [kind["key"] for kind in kinds] == ["pressure", "stress"]
    assert [(on["role"], on["teeth"]) for on in kinds[0]["on"]] == [("pinion", 21), ("wheel", 32)]


def test_each_mesh_has_its_own_operating_point() -> None:
    pytest.importorskip("nicegui")
    from gearcad.page.panels.results import views_of

    content = {
        "kind": "dynamics",
        "speed": [1.0, 2.0],
        "kv": {"first": [1.1, 1.2], "second": [1.3, 1.4]},
        "kv_down": {"first": [1.1, 1.25]},
        "kv_iso6336": None,
        "operating": {"speed": 2.0, "kv": {"first": 1.2, "second": 1.4}},
    }
    (view,) = views_of(content, PageWords.of(PageLanguage.ENGLISH))
    marked = {each["name"]: each["markPoint"]["data"] for each in view["option"]["series"] if "markPoint" in each}
    assert marked == {"K_v, first": [{"coord": [2.0, 1.2]}], "K_v, second": [{"coord": [2.0, 1.4]}]}


def test_a_plane_check_colours_no_bodies(plane: Run, solid: Run) -> None:
    assert _shown(plane)["teeth"] == {}
    assert set(_shown(solid)["teeth"]) == {"pinion", "wheel"}


@pytest.mark.long
def test_meshes_of_a_train_are_checked_as_their_specs_are(runs: Runs, tmp_path: Path) -> None:
    name, text = starter_text("planetary-24-21-66")
    spec = tmp_path / name
    spec.write_text(text + QUICK.replace("torques = [20.0]", "torques = [4.0]"), encoding="utf-8")
    run = _done(runs, "check-2d-second", spec.read_text(encoding="utf-8"), spec.stem)
    assert invoke("planetary", str(spec), "-o", str(tmp_path / "out")).exit_code == 0
    (mesh,) = tmp_path.glob("out/**/ring-planet.toml")
    assert invoke("check", str(mesh), "--model", "2d", "-o", str(tmp_path / "check")).exit_code == 0
    (of_command,) = tmp_path.glob("check/**/check.json")
    document = json.loads(of_command.read_text(encoding="utf-8"))
    shown = _shown(run)
    assert shown["mesh"] == 1
    assert shown["curves"]["transmission_error"] == pytest.approx(document["mesh_cycle"]["transmission_error"], rel=1e-9)
    assert shown["torque"] == pytest.approx(document["load"]["torque"], rel=1e-9)


def test_only_trains_with_a_load_offer_checks_of_their_meshes() -> None:
    planetary = design_of(starter_text("planetary-24-21-66")[1], "train", Path())
    pair = design_of(PAIR, "mine", Path())
    of_meshes = {key for key, kind in ANALYSES.items() if kind.mesh is not None}
    assert {key for key in of_meshes if ANALYSES[key].accepts(planetary)} == of_meshes
    assert not any(ANALYSES[key].accepts(pair) for key in of_meshes)
    assert not ANALYSES["check-2d"].accepts(planetary)
    sun, ring = (mesh_pair(planetary, mesh, shared=False) for mesh in (0, 1))
    assert (sun.name, ring.name) == ("planetary-24-21-66-sun-planet", "planetary-24-21-66-ring-planet")


@pytest.mark.long
def test_factors_over_speed_are_those_of_the_file(runs: Runs) -> None:
    run = _done(runs, "dynamics", starter_text("reducer-21-43")[1], "reducer-21-43")
    document, shown = _document(run, "dynamics.json"), _shown(run)
    assert shown["speed"] == document["speed"]
    assert shown["kv"] == document["chart"]["kv"]
    assert shown["kv_iso6336"] == document["chart"]["kv_iso6336"]
    assert shown["operating"]["speed"] == document["course"]["speed"] == 1450
    assert shown["operating"]["kv"]["mesh"] == document["course"]["kv"][0]
