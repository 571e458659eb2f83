"""What the starters have in comments below [dynamics] can be used as it stands."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import pytest

from gearcad.designs import PairDesign, TrainDesign, read_spec
from gearcad.designs.reader import starter_text
from gearcad.dynamics.time_domain.transient_result import TransientOptions
from gearcad.rating import RatingOptions, endurance_limits

OPTION = re.compile(r"^# (?=\[dynamics|\w+ = )", re.MULTILINE)


@pytest.mark.parametrize("name", ["train-1-stage", "train-2-stage", "train-pairs", "fzg-c"])
def test_commented_options_of_the_dynamics(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    head, found, options = re.split(r"(?m)^((?:# )?\[dynamics\])", text)
    spec = tmp_path / "all.toml"
    spec.write_text(head + found.removeprefix("# ") + OPTION.sub("", options), encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign | TrainDesign) and design.dynamics is not None
    read = design.dynamics
    assert read.error_samples > 1 and read.distribution.value == "normal" and read.transient is not None
    if name == "train-1-stage":  # it shows all there is
        assert read.level_tolerance == 0.05 and read.operating_to is not None and read.premature
        assert all(f"\n# {field.name} = " in options.partition("[dynamics.transient]")[2] for field in fields(TransientOptions))


@pytest.mark.parametrize("name", ["fzg-c", "volvo-13-44", "ring-22-70"])
def test_commented_options_of_material_and_rating(name: str, tmp_path: Path) -> None:
    _, text = starter_text(name)
    for table in ("material", "rating"):
        head, found, rest = re.split(rf"(?m)^((?:# )?\[{table}\])", text)
        options, gap, others = rest.partition("\n\n")
        text = head + found.removeprefix("# ") + OPTION.sub("", options) + gap + others
    spec = tmp_path / "all.toml"
    spec.write_text(text, encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign) and design.rating is not None
    assert all(endurance_limits(material).contact for material in design.materials)
    assert design.materials.pinion.name == "Eh MQ" and design.rating.life == 20000.0
    if name == "fzg-c":  # it shows all there is
        assert all(re.search(rf"\b{field.name} = ", text) for field in fields(RatingOptions))


def test_lists_of_models_in_comments(tmp_path: Path) -> None:
    for name in ("train-1-stage", "train-2-stage"):
        _, text = starter_text(name)
        (listed,) = re.findall(r"^#.*(model = \[.*?\])|^model.*(model = \[.*?\])", text, re.MULTILINE)[:1]
        spec = tmp_path / f"{name}.toml"
        spec.write_text(re.sub(r"(?m)^model = .*$", listed[0] or listed[1], text), encoding="utf-8")
        design = read_spec(spec)
        assert isinstance(design, TrainDesign) and len(design.models) > 1
