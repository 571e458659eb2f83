"""Section, bodies and load shares that the page shows: flanks touch where it says."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad.core.records import Floats
from gearcad.core.runtime import templates
from gearcad.designs.pair_designs import PairDesign
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.reader import design_from_tables, read_spec
from gearcad.page.panels.drawn_data import bodies_of, plain, section_of, surface_of
from gearcad.page.panels.views import section_in, shares_of
from gearcad.page.words import PageLanguage, PageWords

CHORD = 2e-4
"""Of the outlines, in normal modules."""

ROLLS = np.linspace(-0.2, 0.2, 10)


_OF_MESH = """
[[train.mesh]]
name = "{name}"
pinion = "{name} pinion"
wheel = "{name} wheel"
mesh_angle = {angle}
pair = {{ normal_module = {module}, face_width = {width}, tooth_thinning = 0.05, {more} }}
"""


def _tree(folder: Path) -> Path:
    """Write a train of five pairs on six axes: an idler, two meshes of one shaft, a wheel that drives, and a ring."""
    pairs = {
        "first": (0.0, 2.0, 24.0, "helix_angle = 15, pinion = {teeth = 18}, wheel = {teeth = 54}"),
        "idler": (70.0, 2.0, 24.0, "helix_angle = -15, pinion = {teeth = 54}, wheel = {teeth = 31}"),
        "side": (-20.0, 2.5, 20.0, "pinion = {teeth = 20, profile_shift = 0.2}, wheel = {teeth = 33}"),
        "driven": (200.0, 3.0, 30.0, "pinion = {teeth = 17, profile_shift = 0.3}, wheel = {teeth = 45}"),
        "ring": (45.0, 1.5, 18.0, "pinion = {teeth = 22}, wheel = {teeth = -70}"),
    }
    names = {"idler pinion": "first wheel"}
    meshes = "".join(
        _OF_MESH.format(name=name, angle=angle, module=module, width=width, more=more)
        for name, (angle, module, width, more) in pairs.items()
    )
    for old, new in names.items():
        meshes = meshes.replace(f'"{old}"', f'"{new}"')
    inertias = [f"{name} {role}" for name in pairs for role in ("pinion", "wheel") if f"{name} {role}" not in names]
    joined = [("idler wheel", "side pinion"), ("idler wheel", "driven wheel"), ("driven pinion", "ring pinion")]
    text = '[train]\nname = "tree"\n' + "".join(f'[[train.inertia]]\nname = "{each}"\ninertia = 0.01\n' for each in inertias)
    for start, end in joined:
        text += f'[[train.shaft]]\nname = "to {end}"\nstart = "{start}"\nend = "{end}"\ntorsional_stiffness = 1e5\n'
    (spec := folder / "tree.toml").write_text(text + meshes, encoding="utf-8")
    return spec


def _content(spec: str | Path) -> dict[str, Any]:
    content = section_of(read_spec(spec if isinstance(spec, Path) else templates() / f"{spec}.toml"))
    assert content is not None
    return content


def _module(body: dict[str, Any]) -> float:
    """Transverse module (mm) of a gear or a rack."""
    return float(body["circles"]["reference"] / abs(body["teeth"]) if "teeth" in body else body["pitch"] / math.pi)


def _turned(points: Floats, angle: float) -> Floats:
    cosine, sine = math.cos(angle), math.sin(angle)
    return points @ np.array([[cosine, sine], [-sine, cosine]])


def _stand(body: dict[str, Any], height: float, roll: float, side: int) -> float:
    """As the script of the section has it."""
    turns = (body["ratio"] + body.get("orbit", 0.0)) * roll
    return float(np.interp(height, *np.transpose(body["turns"]))) + turns + side * body["slack"]


def _outline(body: dict[str, Any], stand: float, roll: float) -> Floats:
    tooth = np.reshape(body["tooth"], (-1, 2))
    if "teeth" in body:
        count = abs(body["teeth"])
        return np.concatenate([_turned(tooth, stand + 2 * math.pi * n / count) for n in range(count)]) + _turned(
            np.array(body["place"]), body.get("orbit", 0.0) * roll
        )
    drift = stand  # of the lowest section, where the ends of the rack are of no account
    middles = (np.arange(round(body["length"] / body["pitch"])) + 0.5) * body["pitch"]
    points = np.concatenate([tooth + np.array([middle + drift, 0.0]) for middle in middles])
    return _turned(points, body["angle"]) + body["place"]


def _off(outline: Floats, point: Floats) -> float:
    """Distance of a point from a chain of straight pieces."""
    ends, steps = outline[:-1] - point, np.diff(outline, axis=0)
    share = np.clip(-(ends * steps).sum(-1) / np.maximum((steps**2).sum(-1), 1e-30), 0, 1)
    return float(np.hypot(*(ends + share[:, None] * steps).T).min())


@pytest.mark.parametrize(
    "name",
    [
        *("reducer-21-43", "volvo-13-44", "fzg-c", "double-23-81", "ring-22-70", "rack"),
        *("planetary-24-21-66", "planetary-alm", "planetary-differential", "train-pairs", "tree", "two-stage"),
    ],
)
@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_flanks_touch_where_it_says(name: str, side: int, tmp_path: Path) -> None:
    content = _content(_tree(tmp_path) if name == "tree" else name)
    low, high = content["heights"]
    rolls = ROLLS if len(content["meshes"]) == 1 else ROLLS[:3]
    for roll, height in zip(rolls, np.linspace(low, high, len(rolls)), strict=True):
        for mesh in content["meshes"]:
            bodies = [content["bodies"][number] for number in mesh["of"]]
            gone = mesh.get("orbit", 0.0) * roll
            stands = [_stand(body, height, roll, side) for body in bodies]
            outlines = [_outline(body, stand, roll) for body, stand in zip(bodies, stands, strict=True)]
            place = _turned(np.array(bodies[0]["place"]), gone)
            towards = mesh["towards"] + gone
            first = mesh["first"] + side * mesh["side"] * mesh["base"] * (stands[0] - towards)
            start, *_, end = mesh["path"]
            numbers = range(math.ceil((start - first) / mesh["pitch"]), math.floor((end - first) / mesh["pitch"]) + 1)
            assert numbers
            for number in numbers:
                point = _turned(np.array([mesh["base"], first + number * mesh["pitch"]]), -mesh["angle"])
                point = _turned(point * [1, side * mesh["side"]], towards) + place
                for body, outline in zip(bodies, outlines, strict=True):
                    assert _off(outline, point) < 1.5 * CHORD * _module(body)


@pytest.mark.parametrize("name", ["reducer-21-43", "ring-22-70"])
def test_the_pitch_point_is_where_the_pitch_circles_touch(name: str) -> None:
    content = _content(name)
    (mesh,), (pinion, wheel) = content["meshes"], content["bodies"]
    point = _turned(np.array([mesh["base"], mesh["path"][2]]), -mesh["angle"])
    assert point == pytest.approx([pinion["circles"]["pitch"] / 2, 0.0], abs=1e-9)
    assert abs(point[0] - wheel["place"][0]) == pytest.approx(wheel["circles"]["pitch"] / 2, abs=1e-9)


def test_a_train_turns_as_willis_says() -> None:
    content = _content("planetary-24-21-66")
    ratios = {body["name"]: body["ratio"] for body in content["bodies"]}
    assert ratios["sun"] == 1.0
    assert ratios["ring"] == 0.0
    assert {body["orbit"] for body in content["bodies"] if "planet" not in body["name"]} == {0.0}
    assert content["bodies"][2]["orbit"] == pytest.approx(24 / (24 + 66), abs=1e-12)


def test_kinds_without_teeth_have_no_section() -> None:
    assert section_of(read_spec(templates() / "train-1-stage.toml")) is None


def test_axes_of_a_train_lie_at_their_angles() -> None:
    """The second pair of the starter has its wheel at 30 degrees, and teeth of its module without shifts."""
    second, third = (np.array(_content("two-stage")["bodies"][number]["place"]) for number in (1, 3))
    assert second[1] == 0.0
    assert (third - second) / np.linalg.norm(third - second) == pytest.approx([math.sqrt(3) / 2, 0.5], abs=1e-12)


def test_plain_numbers_are_sent() -> None:
    content = _content("double-23-81")
    assert json.dumps(plain(content)) == json.dumps(content)
    assert {type(value) for body in plain(content)["bodies"] for value in body["place"]} == {float}


@pytest.mark.parametrize(("language", "names"), [("en", ["pinion", "rack"]), ("de", ["Ritzel", "Zahnstange"])])
def test_gears_are_called_in_the_words_of_the_page(language: str, names: list[str]) -> None:
    found = section_of(read_spec(templates() / "rack.toml"))
    assert found is not None
    shown = section_in(PageWords.of(PageLanguage(language)), found)
    assert [body["name"] for body in shown["bodies"]] == names
    assert shown["meshes"] == found["meshes"]


def test_only_trains_with_planets_have_shares() -> None:
    assert shares_of(read_spec(templates() / "spur.toml")) is None


def test_shares_are_those_of_the_job() -> None:
    found = shares_of(read_spec(templates() / "planetary-differential.toml"))
    assert found is not None
    assert len(found["shares"]) == 4
    assert found["factor"] == max(greatest for _, _, greatest in found["shares"]) > 1


def test_without_a_load_it_says_so() -> None:
    design = read_spec(templates() / "planetary-differential.toml")
    assert isinstance(design, PlanetaryDesign)
    found = shares_of(replace(design, load=None))
    assert found is not None
    assert not found["shares"]
    assert "load" in found["why_not"]


def test_what_did_not_change_is_the_same_surface() -> None:
    design = read_spec(templates() / "reducer-21-43.toml")
    assert isinstance(design, PairDesign)
    before = bodies_of(design)
    wider = replace(design.pair, pinion=replace(design.pair.pinion, face_width=26.0))
    after = bodies_of(replace(design, pair=wider))
    assert before.bodies[1].surface == after.bodies[1].surface
    assert before.bodies[0].surface != after.bodies[0].surface
    assert set(after.surfaces) == {body.surface for body in after.bodies}


def test_a_surface_is_what_the_browser_reads() -> None:
    design = read_spec(templates() / "spur.toml")
    (gear,) = design.gears.values()  # type: ignore[attr-defined]
    content = surface_of(gear).content
    vertices, triangles = np.frombuffer(content, "<u4", 2)
    corners = np.frombuffer(content, "<u2", offset=8 + 12 * int(vertices))
    assert len(corners) == 3 * triangles
    assert corners.max() == vertices - 1
    x, y, _ = np.frombuffer(content, "<f4", 3 * int(vertices), 8).reshape(-1, 3).T
    assert np.hypot(x, y).max() == pytest.approx(gear.tip_diameter / 2, abs=1e-4)


def test_why_there_are_no_bodies() -> None:
    found = bodies_of(read_spec(templates() / "train-1-stage.toml"))
    assert not found.bodies
    assert "has no bodies" in found.why_not


def test_a_hub_is_cut_where_it_stands_on_its_shaft() -> None:
    """The middle of a space of the hub is at the middle of a tooth of the shaft, and they turn together."""
    tables = {"spline": {"designation": "N 30 x 1.25 x 22 x 9H / W 30 x 1.25 x 22 x 8f", "length": 20.0}}
    found = section_of(design_from_tables(tables, where=lambda key: key, default_name="seat"))
    assert found is not None
    shaft, hub = found["bodies"]
    assert [body["name"] for body in found["bodies"]] == ["shaft", "hub"]
    assert (shaft["teeth"], hub["teeth"], shaft["ratio"], hub["ratio"]) == (22, -22, 1.0, 1.0)
    assert hub["rest"] == pytest.approx(math.pi / 22) and shaft["rest"] == 0.0
    assert hub["slack"] == pytest.approx(0.022 / 27.5)  # 8f at 30 mm: 22 µm, without known tolerances
    assert found["pitch"] == pytest.approx(2 * math.pi / 22)


def test_shafts_stand_beside_the_gears_they_carry(tmp_path: Path) -> None:
    """After the gears, whose numbers stresses are coloured by; each turns with its gear, the left end below the face."""
    reducer = (templates() / "reducer-21-43.toml").read_text(encoding="utf-8")
    shaft = "[[pinion.shaft]]\nlength = 90.0\nouter_diameter = 20.0\ninner_diameter = 5.0\n"
    bearings = '[[pinion.bearing]]\nposition = 5.0\naxial_stiffness = "rigid"\n[[pinion.bearing]]\nposition = 85.0\n'
    spec = tmp_path / "on-shafts.toml"
    spec.write_text(reducer.replace("[pinion]", "[pinion]\nmesh_position = 40.0", 1) + shaft + bearings, encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign)
    found = bodies_of(design)
    assert [body.name for body in found.bodies] == ["pinion", "wheel", "pinion shaft"]
    body, width = found.bodies[2], design.pair.pinion.face_width
    assert body.ratio == 1.0 and body.place == pytest.approx((0.0, 0.0, width / 2 - 40.0))
    content = found.surfaces[body.surface]
    vertices, triangles = np.frombuffer(content, "<u4", 2)
    points = np.frombuffer(content, "<f4", 3 * int(vertices), 8).reshape(-1, 3).astype(float)
    faces = np.frombuffer(content, "<u2", 3 * int(triangles), 8 + 12 * int(vertices)).reshape(-1, 3)
    a, b, c = (points[faces[:, corner]] for corner in range(3))
    volume = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6
    assert volume == pytest.approx(math.pi / 4 * (20.0**2 - 5.0**2) * 90.0, rel=5e-3)
