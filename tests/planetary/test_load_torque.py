"""The torque of a train by the member on which it acts: the same load by either name, the old name, and who refuses what."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from gearcad import Material, ParameterError, read
from gearcad.cli import main
from gearcad.core.errors import GeometryError, SpecError
from gearcad.core.runtime import templates
from gearcad.designs import PlanetaryDesign
from gearcad.designs.table import open_table
from gearcad.planetary import PlanetaryTrain, TrainLoad, drive_of
from gearcad.planetary.power import lossless_flow, power_flow
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.sizing.planetary_sets import SetSizeTask, size_sets
from gearcad.solids.train_plan import TrainLayout, carrier_plan

EXACT = 1e-12
"""Relative: torques that follow from each other by a balance of a few terms."""

STARTERS = ("planetary-24-21-66", "planetary-alm", "planetary-differential")


def design_of(name: str) -> PlanetaryDesign:
    """The design of a starter."""
    found = read(templates() / f"{name}.toml")
    assert isinstance(found, PlanetaryDesign) and found.load is not None
    return found


@pytest.mark.parametrize("name", STARTERS)
@pytest.mark.parametrize("torque", [80.0, -80.0])
@pytest.mark.parametrize("speed", [1500.0, -1500.0, 0.0])
@pytest.mark.parametrize("efficiency", [1.0, 0.995])
def test_either_torque_gives_the_same_flow(name: str, torque: float, speed: float, efficiency: float) -> None:
    """What a torque on the output asks of the input, given there, gives the same torques on all members."""
    design = design_of(name)
    train, speeds = design.train, dict(design.speeds)
    if speed <= 0:
        speeds = {member: math.copysign(given, speed) for member, given in speeds.items()}
    by_output = TrainLoad(output_torque=torque, speed=speed, mesh_efficiency=efficiency)
    flow = power_flow(train, by_output, speeds)
    own = flow.torques[train.input] * math.copysign(1.0, speed)
    by_input = replace(by_output, output_torque=None, input_torque=own)
    assert math.copysign(1.0, own) == math.copysign(1.0, torque)  # both are positive where power goes from input to output
    other = power_flow(train, by_input, speeds)
    for found in ("torques", "set_torques", "powers", "losses"):
        assert getattr(other, found) == pytest.approx(getattr(flow, found), rel=EXACT, abs=EXACT)
    assert drive_of(train, by_input) == drive_of(train, by_output)
    plain = [lossless_flow(train, load, speeds).set_torques for load in (by_input, by_output)]
    assert plain[0] == pytest.approx(plain[1], rel=EXACT)


def test_the_old_name_means_the_output_and_is_told() -> None:
    train = design_of(STARTERS[0]).train
    old, new = TrainLoad(torque=80.0, speed=100.0), TrainLoad(output_torque=80.0, speed=100.0)
    assert power_flow(train, old).torques == power_flow(train, new).torques
    assert [each.code for each in old.notices] == ["old-name"]
    assert "write output_torque instead" in str(next(old.notices))
    assert list(new.notices) == []
    assert replace(old, speed=50.0).given_torque == replace(new, speed=50.0).given_torque == 80.0
    assert old.times(2.0).given_torque == 160.0


@pytest.mark.parametrize("given", [{}, {"torque": 1.0, "output_torque": 1.0}, {"input_torque": 1.0, "output_torque": 1.0}])
@pytest.mark.parametrize("made", ["load", "task"])
def test_one_torque_is_given(given: dict[str, float], made: str) -> None:
    sets = SearchTask(ratio=4.0, module=1.0)
    with pytest.raises(ParameterError, match="torque"):
        if made == "load":
            TrainLoad(**given)
        else:
            SetSizeTask(sets=sets, speed=100.0, material=Material(name="Eh MQ"), **given)


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("speed = 1.0", "load.output_torque is missing: must be given, in N·m on the output, or input_torque, on the input"),
        ("torque = 1.0\ninput_torque = 2.0", "load.torque = 1 N·m: must be left out beside input_torque"),
    ],
)
def test_specs_say_which_torque(tmp_path: Path, lines: str, said: str) -> None:
    text = (templates() / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    path = tmp_path / "it.toml"
    path.write_text(text[: text.index("[load]")] + f"[load]\n{lines}\n", encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read(path)
    assert said in str(caught.value)


def test_commands_tell_the_old_name(tmp_path: Path) -> None:
    path = tmp_path / "it.toml"
    text = (templates() / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    for key, told in (("output_torque", False), ("torque", True)):
        path.write_text(text.replace("output_torque = ", f"{key} = "), encoding="utf-8")
        shown = CliRunner().invoke(main, ["data", str(path)])
        assert shown.exit_code == 0
        assert ("torque is the old name of output_torque" in shown.output) is told
    designs = [row.design() for row in open_table(templates() / "planetary-sets.csv").rows()]
    assert all(isinstance(each, PlanetaryDesign) and each.load and each.load.output_torque for each in designs)


def test_the_torque_of_a_pair_is_the_pinions() -> None:
    """No key of trains is one of pairs."""
    reducer = (templates() / "reducer-21-43.toml").read_text(encoding="utf-8")
    assert "\ntorque = " in reducer and "input_torque" not in reducer


def size(**torque: float) -> Any:
    """The lightest set of a small search."""
    sets = SearchTask(ratio=4.0, module=1.0, planets=(3, 3), teeth=(18, 22), ring_teeth=(54, 66), tolerance=0.5)
    task = SetSizeTask(
        sets=sets, speed=1000.0, material=Material(name="Eh MQ"), considered=4, modules=(1.0, 2.0, 3.0), **torque
    )
    return size_sets(task, 1)


def test_sets_are_sized_for_either_torque() -> None:
    by_input, by_output, old = size(input_torque=50.0), size(output_torque=200.0), size(torque=50.0)
    masses = [each.found[0].mass for each in (by_input, by_output, old)]
    assert masses[0] == masses[2]
    ratio = by_input.found[0].train.ratio
    assert masses[1] == pytest.approx(masses[0], rel=1e-3 if ratio == pytest.approx(4.0, rel=EXACT) else 0.02)
    assert by_output.task.torque_words == "200 N·m on the output"
    assert [len(each.task.notices) for each in (by_input, by_output, old)] == [0, 0, 1]
    assert (by_output.to_dict()["torque"], by_output.to_dict()["torque_of"]) == (200.0, "output")


def carrier_of(train: PlanetaryTrain, diameter: float | None) -> float:
    """The diameter of the pins of the carrier that is made."""
    own = replace(train, carrier=replace(train.carrier, pin_diameter=diameter))
    return carrier_plan(TrainLayout(own, own.pose())).diameter


def test_pins_have_the_diameter_that_is_given() -> None:
    train = design_of(STARTERS[0]).train
    bore = train.rims[0].gear.body.bore
    assert carrier_of(train, None) == bore
    assert carrier_of(train, 0.6 * bore) == 0.6 * bore
    with pytest.raises(GeometryError, match=f"carrier.pin_diameter = .* must be at most {bore:g} mm, the bore of the planets"):
        carrier_of(train, 1.01 * bore)
