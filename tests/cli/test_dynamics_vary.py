"""`gearcad dynamics --vary`: the same train or pair with other values, alone and over each other."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.cli.dynamics import beside_lines
from gearcad.core.records import Floats
from gearcad.designs import PairDesign
from gearcad.designs.reader import starter_text
from gearcad.designs.variations import read_variants
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.jobs.dynamics import Dynamics, DynamicsBeside, dynamics_columns
from gearcad.plots.trains import plot_errors_beside

_, STARTER = starter_text("train-1-stage")
ONE_STAGE = STARTER.replace("speed_to = 16000.0 ", "speed_to = 9000.0\nspeeds = 20\nharmonics = 2 #")

PAIR = """[pair]
name = "couple"
normal_module = 2.0
face_width = 20.0
[pinion]
teeth = 20
[wheel]
teeth = 40
profile_shift = 0.0
[load]
torque = 50.0
[dynamics]
speeds = 10
stiffness = "weber-banaschek"
pinion_inertia = 6e-5
wheel_inertia = 3e-4
speed_to = 9000.0
"""

OSINSKI_W3 = {"0.01": 1.742, "0.02": 1.625, "0.05": 1.452, "0.1": 1.348, "0.2": 1.291}
OSINSKI_W4 = {"0.01": 1.589, "0.02": 1.579, "0.05": 1.55, "0.1": 1.512, "0.2": 1.462}
"""K_v at the third and fourth resonance of Osinski's paper's train by damping in the shafts, worked out elsewhere from
its equations over a grid of 50 1/s: figure 4."""

OF_GRID = 0.0015
"""A chart that is refined at its maxima is above one of that grid, by so much at most."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["dynamics", *arguments])


def study(text: str, *variations: str) -> tuple[dict[str, Any], dict[str, Floats]]:
    """Document and arrays."""
    Path("spec.toml").write_text(text, encoding="utf-8")
    variants = read_variants("spec.toml", variations)
    several = len(variants.designs) > 1
    found = (DynamicsBeside(variants=variants) if several else Dynamics()).run(variants.designs[0])
    return found.to_dict(), found.arrays()


def fault(text: str, *variations: str) -> str:
    Path("spec.toml").write_text(text, encoding="utf-8")
    result = run("spec.toml", *(each for vary in variations for each in ("--vary", vary)), "--quiet", "-o", "none")
    assert result.exit_code == 2, result.output
    assert not Path("none").exists()
    (line,) = result.stderr.splitlines()
    return line.removeprefix("Error: ")


def test_an_overlay_is_its_separate_runs_bit_by_bit(here: Path) -> None:
    found, over = study(ONE_STAGE, "shaft.*.damping_ratio=0.02,0.1", "train.order=10")
    assert (found["what"], found["labels"]) == ("damping ratio of the modes of its line", ["0.02", "0.1"])
    for place, value in enumerate(("0.02", "0.1")):
        by_hand = ONE_STAGE.replace("damping_ratio = 0.05", f"damping_ratio = {value}").replace(
            "[train]", "[train]\norder = 10"
        )
        document, arrays = study(by_hand)
        assert found["studies"][place] == document
        assert {name.removeprefix(f"{value}/") for name in over if name.startswith(f"{value}/")} == set(arrays)
        assert all(np.array_equal(over[f"{value}/{name}"], arrays[name], equal_nan=True) for name in arrays)


def test_a_label_is_shown_with_its_key(here: Path) -> None:
    (here / "spec.toml").write_text(STARTER, encoding="utf-8")
    one = read_variants("spec.toml", ["shaft.*.damping_ratio=0.02,0.1", "train.speed=900"])
    assert one.key == "shaft.*.damping_ratio" and one.labels == ("0.02", "0.1")
    several = read_variants("spec.toml", ["shaft.*.damping_ratio=0.02,0.1", "train.speed=900,1000"])
    assert several.key == "" and several.labels[0].startswith("damping ratio 0.02, ")


def test_one_value_is_set(here: Path) -> None:
    found, _ = study(ONE_STAGE, "train.model=exact", "shaft.output.diameter=20")
    by_hand = ONE_STAGE.replace('model = "modes" ', 'model = "exact" ').replace("diameter = 18.5", "diameter = 20")
    assert found == study(by_hand)[0]


def test_models_alone_are_held_against_each_other(here: Path) -> None:
    found, _ = study(ONE_STAGE, "model=isolated,modes")
    assert found == study(ONE_STAGE.replace('model = "modes" ', 'model = ["isolated", "modes"] '))[0]


def test_figure_4_of_osinskis_paper(here: Path) -> None:
    text = STARTER.replace("[dynamics]", "[dynamics]\nspeed_from = 6000.0\nspeeds = 400")
    found, _ = study(text, f"shaft.*.damping_ratio={','.join(OSINSKI_W3)}")
    for speed, expected in ((6800, OSINSKI_W3), (10900, OSINSKI_W4)):
        (resonance,) = (
            each["shown"]
            for each in found["resonances"]
            if all(peak and abs(peak["speed"] / speed - 1) < 0.05 for peak in each["shown"].values())
        )
        assert {label: peak["factor"] for label, peak in resonance.items()} == pytest.approx(expected, abs=OF_GRID)


def test_a_pair_is_laid_over_itself(here: Path) -> None:
    found, _ = study(PAIR, "dynamics.damping_ratio=0.1", "wheel.profile_shift=0,0.2")
    own, _ = study(PAIR.replace("profile_shift = 0.0", "profile_shift = 0.2"), "dynamics.damping_ratio=0.1")
    last = found["studies"][1]
    assert all(last[key] == own[key] for key in ("speed", "chart", "course", "modes"))
    assert set(own["warnings"]) == set(last["warnings"])


def test_every_combination_has_its_label(here: Path) -> None:
    Path("spec.toml").write_text(PAIR, encoding="utf-8")
    found = read_variants("spec.toml", ["dynamics.damping_ratio=0.05,0.1", "wheel.profile_shift=0,0.2", "load.torque=60"])
    assert found.what == "damping ratio of the pair, profile shift coefficient of wheel"
    assert list(found.labels) == [
        f"damping ratio {damping}, profile shift {shift}" for damping in ("0.05", "0.1") for shift in ("0", "0.2")
    ]
    designs = [design for design in found.designs if isinstance(design, PairDesign)]
    values = [(each.dynamics.damping_ratio, each.pair.wheel.profile_shift, each.load.torque) for each in designs]  # type: ignore[union-attr]
    assert values == [(0.05, 0.0, 60.0), (0.05, 0.2, 60.0), (0.1, 0.0, 60.0), (0.1, 0.2, 60.0)]


def test_keys_that_end_alike_are_written_out(here: Path) -> None:
    Path("spec.toml").write_text(ONE_STAGE, encoding="utf-8")
    found = read_variants("spec.toml", ["shaft.input.length=700,800", "shaft.output.length=900,1000.0000000000001"])
    assert found.what == "length of input in mm, length of output in mm"
    assert found.labels[3] == "shaft.input.length 800, shaft.output.length 1000.0000000000001"


def test_the_command_writes_all_over_each_other(here: Path) -> None:
    Path("spec.toml").write_text(ONE_STAGE, encoding="utf-8")
    done = run("spec.toml", "--vary", "mesh.*.damping_ratio=0.05,0.1", "-o", "out")
    assert done.exit_code == 0, done.output
    assert "  0.05 " in done.stdout and "out/dynamics.html" in done.stdout.splitlines()
    document = json.loads(Path("out/dynamics.json").read_text(encoding="utf-8"))
    assert document["labels"] == ["0.05", "0.1"]
    assert "damping ratio of the pair alone" in Path("out/dynamics.html").read_text(encoding="utf-8")
    with np.load("out/dynamics.npz") as arrays:
        assert arrays["0.1/kv"].shape == (len(document["studies"][1]["speed"]), 1)


@pytest.mark.parametrize(
    ("text", "variations", "message"),
    [
        (ONE_STAGE, ("shaft.*.damping_ratio=0:1:13",), "make 13 curves, and one chart can bear 12"),
        (
            ONE_STAGE,
            ("shaft.*.damping_ratio=-1,0.1",),
            "--vary shaft.*.damping_ratio=-1: shaft.input.damping_ratio = -1: must be",
        ),
        (ONE_STAGE, ("mesh.mesh.teeth=0",), "--vary mesh.mesh.teeth=0: mesh.mesh.teeth = 0: must be a whole number"),
        (ONE_STAGE, ("shaft.inptu.length=1",), "the train has no shaft inptu; did you mean shaft.input.length?"),
        (ONE_STAGE, ("order=5", "train.order=6"), "train.order is varied more than once"),
        (ONE_STAGE, ("train.model=exact,exact",), "must have each value once"),
        (
            ONE_STAGE.replace('model = "modes" ', 'model = ["isolated", "modes"] '),
            ("shaft.*.damping_ratio=0.1,0.2",),
            "train.model = 'isolated, modes': must be one word beside other values that vary",
        ),
        (
            ONE_STAGE.replace("length = 750.0", "length = -750.0"),
            ("order=5,6",),
            "spec.toml line 27: shaft.input.length = -750",
        ),
        (
            PAIR,
            ("dynamics.model=contact", "load.torque=50,60"),
            "dynamics.model = 'contact': must be \"mesh\" to vary something",
        ),
        (PAIR, ("wheel.teeth=2,30",), "--vary wheel.teeth=2: wheel.teeth = 2: must be"),
        (PAIR, ("pinoin.teeth=20,30",), "unknown column; did you mean pinion.teeth?"),
    ],
)
def test_what_cannot_be_laid_over_each_other(here: Path, text: str, variations: tuple[str, ...], message: str) -> None:
    assert message in fault(text, *variations)


def test_errors_of_teeth_are_laid_over_each_other(here: Path) -> None:
    """With errors that are drawn several times the first chart is that of teeth without: theirs stand beside."""
    text = ONE_STAGE.replace("speeds = 20", 'speeds = 5\nspeed_from = 5000.0\ntooth_errors = "on"\nerror_samples = 2')
    Path("spec.toml").write_text(text, encoding="utf-8")
    variants = read_variants("spec.toml", ["dynamics.accuracy_grade=5,10"])
    found = DynamicsBeside(variants=variants).run(variants.designs[0])
    assert isinstance(found, SideBySide)
    five, ten = (found.errors[label].greatest[0] for label in ("5", "10"))
    assert 1.0 < five.median < ten.median
    columns = [dynamics_columns(study) for study in found.to_dict()["studies"]]
    assert [each["kv_errors_median.mesh"] for each in columns] == [five.median, ten.median]
    assert [each["kv_errors_upper.mesh"] for each in columns] == [five.upper, ten.upper]
    lines = beside_lines(found)
    begin = lines.index("K_v of mesh with tooth errors")
    assert [f"{each.median:.3f}" in line for each, line in zip((five, ten), lines[begin + 1 :], strict=False)] == [True, True]
    figure = plot_errors_beside(found)
    median, upper = figure.axes[0].lines[2:]
    assert np.array_equal(median.get_ydata(), found.errors["10"].median[:, 0])
    assert np.array_equal(upper.get_ydata(), found.errors["10"].band[1][:, 0])
