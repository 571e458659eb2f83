"""A list of models in a spec: what is permitted, what is made of it, and what a list of one is."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import lxml.html
import numpy as np
import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.core.errors import ParameterError
from gearcad.designs import TrainDesign, read_spec
from gearcad.dynamics.trains.train import TrainModel

TEMPLATES = Path(__file__).parents[2] / "templates"
TRAIN = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + "speeds = 120\n"
COUPLED = """
[train]
model = ["massless", "exact"]
[[train.inertia]]
name = "a"
inertia = 1.0
[[train.inertia]]
name = "b"
inertia = 2.0
[[train.shaft]]
name = "s"
start = "a"
end = "b"
length = 500.0
diameter = 40.0
"""


def run(text: str, *arguments: str) -> Result:
    Path("it.toml").write_text(text, encoding="utf-8")
    return CliRunner().invoke(main, ["dynamics", "it.toml", "--quiet", *arguments])


def with_models(models: str, text: str = TRAIN) -> str:
    return re.sub(r"(?m)^model = .*$", f"model = {models}", text)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    return tmp_path


@pytest.mark.usefixtures("no_pictures")
def test_what_no_chart_shows_is_in_the_headline(here: Path) -> None:
    result = run(with_models('["isolated", "massless"]').replace("speeds = 120", "speeds = 20") + "operating_to = 99999.0\n")
    assert "of which not judged: 16000 to 99999 rpm, beyond the last speed of the chart, held against" in result.stdout
    page = Path("output/train-1-stage/dynamics.html").read_text(encoding="utf-8")
    assert "Not judged: 16" in page


@pytest.mark.usefixtures("no_pictures")
def test_a_list(here: Path) -> None:
    """The order of the list is that of tables and charts."""
    result = run(with_models('["exact", "isolated"]') + "operating_to = 12000.0\n")
    assert result.exit_code == 0, result.output
    document = json.loads(Path("output/train-1-stage/dynamics.json").read_text(encoding="utf-8"))
    assert document["labels"] == ["exact", "isolated"] and document["reference"] == "exact" and document["enough"] is None
    assert document["operating_range"] == {"first": 16.0, "last": 12000.0, "source": "operating range"}
    (verdict,) = document["verdicts"]
    assert verdict["status"] == "not enough" and verdict["sentence"] in document["sentence"]
    first = result.stdout[result.stdout.index('"isolated" is not enough') :].splitlines()[0]
    assert verdict["sentence"].startswith(first.rstrip(".")) and len(first) < 200
    worst = max(each["excess"] for each in verdict["underestimates"])
    assert worst == pytest.approx(0.2255, abs=2e-3)
    assert verdict["deciding"][0]["shares"][0]["name"] == "input"
    with np.load("output/train-1-stage/dynamics.npz", allow_pickle=False) as arrays:
        assert arrays["exact/kv"].shape[0] >= 120 and "isolated/shaft_overload" in arrays
    page = lxml.html.parse("output/train-1-stage/dynamics.html").getroot()
    assert "is not enough: it misses the resonance" in page.text_content()


def test_a_list_of_one_is_one_word(here: Path) -> None:
    designs = []
    for models in ('"modes"', '["modes"]'):
        Path("it.toml").write_text(with_models(models), encoding="utf-8")
        designs.append(read_spec(Path("it.toml")))
    assert designs[0] == designs[1]


@pytest.mark.long
def test_a_list_of_one_is_the_plain_study(here: Path) -> None:
    """Byte for byte."""
    files = {}
    for models in ('"modes"', '["modes"]'):
        assert run(with_models(models)).exit_code == 0
        files[models] = {path.name: path.read_bytes() for path in Path("output/train-1-stage").iterdir()}
    assert files['"modes"'] == files['["modes"]'] and len(files['["modes"]']) > 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (with_models("[]"), r"line 10: train.model = \[\]: must hold one at least of isolated, massless"),
        (with_models('["exact", "exact"]'), r"line 10: train.model = 'exact': stands twice in the list"),
        (with_models('["exact", "heavy"]'), r"line 10: train.model = 'heavy': must be one of 'isolated'"),
        (with_models('["exact", 3]'), r"line 10: train.model = 3: must be one of"),
        (with_models('[["exact"], "isolated"]'), r"train.model = \['exact'\]: must be one of"),
        (COUPLED, r"line 3: train.model = 'massless, exact': must be one model for a train without meshes"),
        (
            with_models('["exact", "isolated"]', COUPLED),
            r"line 3: train.model = 'isolated': needs meshes: a train without meshes",
        ),
        (with_models('["exact", "modes"]').replace("modes = 2 ", "modes = 9 "), r"input.modes = 9: must be at most half"),
        (with_models('["exact", "modes"]') + "operating_to = 0.0\n", r"dynamics.operating_to = 0 rpm"),
        (with_models('["exact", "modes"]') + "operating_from = 9.0\noperating_to = 9.0\n", r"must be above operating_from"),
        (with_models('["exact", "modes"]') + "operating_from = 20000.0\n", r"operating_from = 20000 rpm: must be below"),
        (with_models('["exact", "modes"]') + "level_tolerance = 0.0\n", r"level_tolerance = 0: must be"),
    ],
)
def test_a_wrong_list_gets_one_line(here: Path, text: str, words: str) -> None:
    result = run(text)
    assert result.exit_code == 2 and len(result.stderr.splitlines()) == 1 and "Traceback" not in result.stderr
    assert re.search(words, result.stderr), result.stderr
    assert not Path("output").exists()


def test_models_in_python() -> None:
    design = read_spec(TEMPLATES / "train-1-stage.toml")
    assert isinstance(design, TrainDesign)
    assert design.models == (TrainModel.MODES,)
    several = replace(design, other_models=("exact",))  # type: ignore[arg-type]
    assert several.models == (TrainModel.MODES, TrainModel.EXACT)
    with pytest.raises(ParameterError, match="stands twice"):
        replace(several, train=replace(design.train, model="exact"))
