"""Planetary sets for a task: they hold, nothing narrower does, and their specs are what was rated."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gearcad.core.errors import ParameterError, SolverError
from gearcad.designs.reader import read_spec
from gearcad.designs.spec_writers import write_sized_set, write_sized_sets
from gearcad.designs.table import open_table
from gearcad.material import Material
from gearcad.planetary.members import material_of
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.rating import RatingOptions
from gearcad.rating.strength import RatedPart
from gearcad.sizing.planetary_sets import SetSizeTask, SizedSets, made, size_sets

EH = Material(name="Eh MQ")


def task(**changes: Any) -> SetSizeTask:
    sets = SearchTask(ratio=4.0, module=1.0, planets=(3, 3), teeth=(20, 30), ring_teeth=(30, 90), tolerance=1.0)
    load = {"torque": 300.0, "speed": 1500.0, "rating": RatingOptions(life=10_000.0)}
    given: dict[str, Any] = {"sets": sets, "material": EH, "modules": (2.0, 2.5), "considered": 2, **load}
    return SetSizeTask(**given | changes)


@pytest.fixture(scope="module")
def sized() -> SizedSets:
    return size_sets(task(), 2)


def test_sets_hold_and_are_no_wider_than_they_must_be(sized: SizedSets) -> None:
    assert len(sized.found) == 2
    assert sized.found[0].mass <= sized.found[1].mass
    for each in sized.found:
        assert each.holds
        assert min(each.margins.values()) >= 1
        own = each.candidate
        step = 0.5 if own.task.width <= 20 else 1.0
        if own.task.width - step >= 5 * own.task.module:
            assert not made(sized.task, own, own.task.module, own.task.width - step).holds


def test_the_spec_is_what_was_rated(sized: SizedSets, tmp_path: Path) -> None:
    best = sized.found[0]
    write_sized_set(best, ["a set"], tmp_path / "best.toml")
    design = read_spec(tmp_path / "best.toml")
    assert design.train.gears.keys() == best.train.gears.keys()
    for name, gear in design.train.gears.items():
        own = best.train.gears[name]
        assert gear.teeth == own.teeth
        assert gear.profile_shift == pytest.approx(own.profile_shift, abs=1e-9)
        assert gear.tip_diameter == pytest.approx(own.tip_diameter, rel=1e-9)
        assert gear.body.rim_diameter == own.body.rim_diameter
    assert design.load == best.load
    assert {name: material_of(design.material, name) for name in best.materials} == best.materials
    assert design.rating == best.strength.options
    write_sized_sets(sized, tmp_path / "sets.csv")
    table = open_table(tmp_path / "sets.csv")
    assert [row.design().name for row in table.rows()] == [each.name for each in sized.found]


def test_what_is_asked_for_decides_and_not_its_order(sized: SizedSets) -> None:
    turned = size_sets(task(modules=(2.5, 2.0)), 1)
    assert turned.found[0].to_dict() == sized.found[0].to_dict()
    alone = size_sets(task(considered=1), 1).found[0]
    heavier = size_sets(task(torque=380.0, considered=1), 1).found[0]
    assert heavier.mass > alone.mass


def test_nothing_holds_and_what_is_not_known() -> None:
    with pytest.raises(SolverError, match=r"no module and width within the limits let it hold"):
        size_sets(task(torque=1e5), 1)
    with pytest.raises(ParameterError, match=r"^material\.contact_endurance_limit"):
        task(material=Material())
    with pytest.raises(ParameterError, match=r"^torque"):
        task(torque=-5.0)
    with pytest.raises(SolverError, match=r"^no set has ratio 99"):
        size_sets(task(sets=replace(task().sets, ratio=99.0)), 1)


def test_margins(sized: SizedSets) -> None:
    best = sized.found[0]
    assert best.margins[RatedPart.ROOT] == pytest.approx(best.least[RatedPart.ROOT] / 1.4)
    assert best.load.mesh_load_factor == 1.0
    assert best.bears >= 1
