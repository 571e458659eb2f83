"""`gearcad dynamics --vary`: the same train or pair with other values, and several side by side."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import lxml.html
import numpy as np
import pytest
from click.testing import Result
from support.commands import invoke, read_json
from support.specs import TEMPLATES

from gearcad.cli.dynamics import _lines, beside_lines
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, Notice
from gearcad.designs import PairDesign, TrainDesign, read_spec
from gearcad.designs.reader import starter_text
from gearcad.designs.variations import read_variants
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.train import TrainModel
from gearcad.dynamics.variant_comparison import SideBySide
from gearcad.jobs.dynamics import Dynamics, DynamicsBeside, dynamics_columns
from gearcad.plots import plot
from gearcad.plots.paper import short
from gearcad.plots.trains import plot_errors_beside, plot_factors_beside, plot_overloads_beside
from gearcad.report import write_dynamics_report
from gearcad.report.dynamics import greatest_table, resonance_table

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


def run(*arguments: str) -> Result:
    return invoke("dynamics", *arguments)


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
    document = read_json("out/dynamics.json")
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


@pytest.mark.long
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


LABELS = ("exact", "isolated <1>")


@pytest.fixture(scope="module")
def both() -> SideBySide:
    design = read_spec(TEMPLATES / "train-1-stage.toml")
    assert isinstance(design, TrainDesign)
    options = replace(design.dynamics, speeds=120)
    studies = [study_train(replace(design.train, model=TrainModel(word)), options) for word in ("exact", "isolated")]
    return SideBySide(name="it", what="$model$", labels=LABELS, studies=tuple(studies))


def test_every_resonance_is_that_of_a_study(both: SideBySide) -> None:
    """The isolated pair has the resonance of the teeth only, 2.4 % below that with shafts."""
    exact, isolated = both.studies
    (last,) = [each for each in both.resonances if each.shown[1] is not None]
    assert last.shown[0] is not None and last.shown[1] is not None
    assert last.shown[1].factor == isolated.greatest.factor and last.shown[1].speed == isolated.greatest.speed
    assert last.moved(1, 0) == pytest.approx(isolated.greatest.speed / exact.greatest.speed - 1, rel=1e-12)
    peaks = {round(each.speed, 6) for each in exact.resonances}
    assert {round(each.shown[0].speed, 6) for each in both.resonances if each.shown[0]} == peaks and len(peaks) == 5
    assert [each.factor for each in both.greatest] == [exact.greatest.factor, isolated.greatest.factor]
    assert [each.label for each in both.shaft_overloads] == ["exact"]


def test_documents(both: SideBySide, tmp_path: Path) -> None:
    document, arrays = both.to_dict(), both.arrays()
    assert document["labels"] == list(LABELS) and document["studies"][1] == both.studies[1].to_dict()
    assert document["resonances"][-1]["shown"]["isolated <1>"]["factor"] == both.studies[1].greatest.factor
    np.testing.assert_array_equal(arrays["isolated <1>/kv"], both.studies[1].up.factors)
    assert any("K_v of mesh" in line for line in _lines(both))
    write_dynamics_report(both, both.name, tmp_path / "it.html")
    page = lxml.html.parse(tmp_path / "it.html")
    assert page.xpath("//td[text()='isolated <1>']") and len(page.xpath("//figure")) == 3
    greatest = both.studies[1].greatest
    assert greatest_table(both).rows[1][1:] == ("isolated <1>", "1.615", short(greatest.speed))
    off = 100 * (greatest.speed / both.studies[0].greatest.speed - 1)
    assert resonance_table(both).rows[-1][3:] == (short(greatest.speed), f"{off:+.2f}", "1.615")


def test_pictures_have_a_line_for_each_study(both: SideBySide) -> None:
    (panel,) = plot_factors_beside(both).axes
    drawn = {str(line.get_label()): line.get_ydata() for line in panel.lines}
    np.testing.assert_array_equal(drawn["isolated <1>"], both.studies[1].up.factors[:, 0])
    (line,) = [line for line in plot(both).lines if line.get_label() == "isolated <1>"]
    np.testing.assert_array_equal(line.get_ydata(), both.studies[1].up.factors[:, 0])
    assert "<img" in both._repr_html_() and "isolated &lt;1&gt;" in both._repr_html_()
    (panel,) = plot_overloads_beside(both).axes
    assert [line.get_label() for line in panel.lines] == ["exact"]


def test_labels_must_differ(both: SideBySide) -> None:
    with pytest.raises(ParameterError, match="one for each of 2 studies"):
        replace(both, labels=("exact", "exact"))


def test_what_all_have_to_say_is_said_once(both: SideBySide) -> None:
    common, own = Notice("a", "of all"), Notice("b", "of one", where="mesh")
    exact, isolated = (replace(study, found=(common,)) for study in both.studies)
    found = replace(both, studies=(exact, replace(isolated, found=(common, own)))).warnings
    assert found == ("of all", "isolated <1>: mesh: of one")
