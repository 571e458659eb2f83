"""Shafts of a train with segments: stiffness by hand, forces of both gears of a shaft against statics by hand, wrong input."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad.core.errors import InputError, SpecError
from gearcad.designs import TrainDesign, read_spec
from gearcad.designs.reader import starter_text
from gearcad.designs.train_meshes import train_meshes
from gearcad.dynamics.trains.train import train_document
from gearcad.jobs.shafts import Shafts
from gearcad.jobs.strength import Rate
from gearcad.jobs.train import suited

STATICS = 1e-9
"""Relative: sums of a few products, and a linear system."""

E, NU = 206000.0, 0.3


def starter(folder: Path, *changes: tuple[str, str]) -> TrainDesign:
    file, text = starter_text("two-stage")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    (folder / file).write_text(text, encoding="utf-8")
    design = read_spec(folder / file)
    assert isinstance(design, TrainDesign)
    return design


def test_stiffness_and_inertia_follow_from_the_segments(tmp_path: Path) -> None:
    """Springs in series, from the coupling or gear at the start to that at the end; all of the shaft has mass."""
    shafts = {shaft.name: shaft for shaft in starter(tmp_path).train.shafts}
    shear = E / (2 * (1 + NU))

    def series(*parts: tuple[float, float]) -> float:
        return 1e-3 / sum(length / (shear * math.pi / 32 * diameter**4) for length, diameter in parts)

    assert shafts["input"].stiffness == pytest.approx(series((50, 25), (20, 30), (25, 34)), rel=STATICS)
    assert shafts["middle"].stiffness == pytest.approx(series((47, 45)), rel=STATICS)
    assert shafts["output"].stiffness == pytest.approx(series((28, 60), (20, 50), (60, 48)), rel=STATICS)
    polar = sum(math.pi / 32 * d**4 * length for length, d in ((50, 25), (20, 30), (100, 34), (20, 30)))
    assert shafts["input"].inertia == pytest.approx(7850e-15 * polar, rel=STATICS)


def gear_forces(design: TrainDesign) -> dict[tuple[str, str], np.ndarray[Any, Any]]:
    """Forces (3,) on pinion and wheel by a textbook: F_t = 2 T/d_w, F_r = F_t tan(alpha_wt), F_a = F_t tan(beta_w)."""
    found = {}
    for mesh, own in zip(design.train.meshes, train_meshes(design).meshes, strict=True):
        pair, load = own.design.pair, own.design.load
        assert load is not None
        ratio = pair.wheel.teeth / pair.pinion.teeth
        radius = pair.centre_distance / (1 + ratio)
        tangential = 1000 * load.torque / radius  # with the sign of the torque: the teeth of the pinion push the wheel so
        module = 2 * pair.centre_distance / (pair.pinion.teeth + pair.wheel.teeth)
        alpha_t = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(pair.pinion.helix_angle)))
        base = pair.pinion.normal_module / math.cos(math.radians(pair.pinion.helix_angle)) * math.cos(alpha_t)
        alpha_w = math.acos(base / module)
        beta_w = math.atan(math.tan(math.radians(pair.pinion.helix_angle)) * module * math.cos(math.radians(
            pair.pinion.helix_angle)) / pair.pinion.normal_module)  # fmt: skip
        theta = math.radians(mesh.mesh_angle)
        out, around = np.array([math.cos(theta), math.sin(theta), 0]), np.array([-math.sin(theta), math.cos(theta), 0])
        # The wheel is pushed away from the pinion, and along the turn of the pinion's teeth at the pitch point.
        on_wheel = abs(tangential) * math.tan(alpha_w) * out + tangential * around
        on_wheel[2] = -tangential * math.tan(beta_w)
        found[mesh.name, "pinion"], found[mesh.name, "wheel"] = -on_wheel, on_wheel
        found[mesh.name, "at pinion"], found[mesh.name, "at wheel"] = radius * out, (radius - pair.centre_distance) * out
    return found


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("angles", [(0.0, 30.0), (-75.0, 200.0)])
def test_the_intermediate_shaft_against_statics_by_hand(tmp_path: Path, angles: tuple[float, float], way: int) -> None:
    """Two gears, two bearings: moments about one bearing give the reaction of the other, in both planes."""
    changes = [("# mesh_angle = 0.0 ", f"mesh_angle = {angles[0]} # "), ("mesh_angle = 30.0", f"mesh_angle = {angles[1]}")]
    if way < 0:
        changes += [("motor = 60.0", "motor = -60.0"), ("machine = -614.88", "machine = 614.88"), ("= 1450.0", "= -1450.0")]
    design = starter(tmp_path, *changes)
    forces = gear_forces(design)
    document = Shafts(report=False).document(Shafts(report=False).run(design))
    middle = document["shafts"]["middle"]
    low, high = 10.0, 130.0
    places = {("stage 1", "wheel"): 45.0, ("stage 2", "pinion"): 92.0}
    loads = [(z, forces[key], forces[key[0], f"at {key[1]}"]) for key, z in places.items()]
    total = sum(force for _, force, _ in loads)
    # Moment about the left bearing: (lever + (z - low) e_z) x F = -(high - low) e_z x R
    moment = sum(np.cross(at + np.array([0, 0, z - low]), force) for z, force, at in loads)
    right = np.array([-moment[1], moment[0], 0.0]) / (high - low)
    left = -total - right
    scale = np.abs(total).max()
    for told, by_hand in zip(middle["reactions"], (left, right), strict=True):
        assert np.abs(np.array(told["force"]) - by_hand).max() <= STATICS * scale
    assert abs(moment[2]) < STATICS * 1000 * 183 and abs(middle["coupling_torque"]) < STATICS * 183
    assert document["shafts"]["input"]["coupling_torque"] == pytest.approx(way * 60.0, rel=STATICS)
    assert document["shafts"]["output"]["coupling_torque"] == pytest.approx(way * -614.88, rel=STATICS)


def test_application_factors_of_pairs_count(tmp_path: Path) -> None:
    plain = Shafts(report=False).document(Shafts(report=False).run(starter(tmp_path)))
    added = "[train.mesh.pair.load]\ntorque = 1.0\napplication_factor = 1.5\n\n[train.mesh.pair.rating]"
    both = starter(tmp_path, ("[train.mesh.pair.rating]", added))
    found = Shafts(report=False).document(Shafts(report=False).run(both))
    first, more = (np.array(each["shafts"]["input"]["reactions"][0]["force"]) for each in (plain, found))
    assert more == pytest.approx(1.5 * first, rel=STATICS)


def test_pairs_of_meshes_have_the_shafts_of_the_train(tmp_path: Path) -> None:
    """With the forces of the other gears on them; a rating may take the load over the face on them."""
    design = starter(tmp_path, ('# face_load_factor = "shafts"', 'face_load_factor = "shafts"'))
    first, second = train_meshes(design).meshes
    assert first.design.shafts is not None and second.design.shafts is not None
    wheel, pinion = first.design.shafts.gears.wheel, second.design.shafts.gears.pinion
    assert wheel is not None and pinion is not None
    assert (wheel.mesh_position, pinion.mesh_position) == (45.0, 92.0)
    assert [force.position for force in wheel.shaft.forces] == [92.0] and [force.position for force in pinion.shaft.forces] == [
        45.0
    ]
    assert second.design.shafts.options.mesh_angle == 30.0
    found = suited(Rate(report=False), design).run(design)
    ratings = [each.document["sources"].get("K_Hbeta", "") for each in found.meshes]  # type: ignore[attr-defined]
    assert "shafts" in ratings[0] or "annex E" in ratings[0]


def test_data_have_the_moduli_of_the_segments(tmp_path: Path) -> None:
    """Those that stiffness and inertia follow from; none where segments differ."""
    first = starter(tmp_path)
    for shaft in first.to_dict()["shaft"].values():
        assert (shaft["shear_modulus"], shaft["density"]) == (pytest.approx(E / (2 * (1 + NU)), rel=1e-12), 7850.0)
    shaft = first.train.shafts[0]
    assert shaft.layout is not None
    softer = replace(shaft.layout.segments[0], youngs_modulus=1e5)
    mixed = replace(shaft.layout, segments=(softer, *shaft.layout.segments[1:]))
    train = replace(first.train, shafts=(replace(shaft, layout=mixed), *first.train.shafts[1:]))
    assert train_document(train)["shaft"][shaft.name]["shear_modulus"] is None


def test_a_layout_may_stand_in_a_file(tmp_path: Path) -> None:
    _, text = starter_text("two-stage")
    begin, end = (
        text.index("segments = [", text.index('name = "middle"')),
        text.index("[[train.shaft]]", text.index('name = "middle"')),
    )
    (tmp_path / "middle.toml").write_text(text[begin:end], encoding="utf-8")
    (tmp_path / "moved.toml").write_text(text[:begin] + 'layout = "middle.toml"\n\n' + text[end:], encoding="utf-8")
    (tmp_path / "plain.toml").write_text(text, encoding="utf-8")
    moved, plain = (read_spec(tmp_path / name) for name in ("moved.toml", "plain.toml"))
    assert isinstance(moved, TrainDesign) and isinstance(plain, TrainDesign)
    assert moved.train.shafts == plain.train.shafts


WRONG = {
    "both": (
        'start = "wheel 1"',
        'start = "wheel 1"\ntorsional_stiffness = 1e4',
        "middle.torsional_stiffness = 10000",
        "not beside segments",
    ),
    "off the shaft": ("position = 92.0 },", "position = 200.0 },", "gears[1].position = 200 mm", "must be from 0 to 140 mm"),
    "face off": ("position = 92.0 },", "position = 130.0 },", "middle.gears[1].position = 130 mm", "must be from 20 to 120 mm"),
    "one bearing": ('{ name = "D"', '# { name = "D"', "bearings = 1", "must hold the shaft"),
    "bearing off": ("position = 130.0, kind", "position = 150.0, kind", "bearings[1].position = 150 mm", "on the shaft"),
    "mesh": (
        'mesh = "stage 2", role = "pinion"',
        'mesh = "stage 3", role = "pinion"',
        "middle.gears[1].mesh = 'stage 3'",
        "stage 1, stage 2",
    ),
    "role": (
        'mesh = "stage 2", role = "pinion"',
        'mesh = "stage 2", role = "wheel"',
        "middle.gears[1].role = 'wheel'",
        "at neither end",
    ),
    "word": ('role = "pinion", position = 92', 'role = "gear", position = 92', "role = 'gear'", "must be one of"),
    "key": (
        "damping_ratio = 0.02\nsegments",
        "damping = 0.0\nsegmens = 1\nsegments",
        "train.shaft[0].segmens",
        "did you mean segments",
    ),
    "options": ("# [shafts]", "[shafts]\nmesh_angle = 3.0 #", "shafts.mesh_angle", "[[train.mesh]] has it"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_shafts_are_told_in_one_line(tmp_path: Path, case: str) -> None:
    old, new, *told = WRONG[case]
    with pytest.raises((SpecError, InputError)) as caught:
        starter(tmp_path, (old, new))
    text = str(caught.value)
    assert "\n" not in text and all(each in text for each in told), text
    assert "line" in text


def test_a_train_without_beams_is_refused(tmp_path: Path) -> None:
    file, text = starter_text("train-pairs")
    (tmp_path / file).write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"segments, bearings and gears of a \[\[train.shaft\]\]"):
        Shafts().run(read_spec(tmp_path / file))
