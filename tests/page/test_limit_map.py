"""Which shift diagram a design has, and what moving in it writes into its spec."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gearcad.core.runtime import templates
from gearcad.page.fields import LimitMap, limit_map
from gearcad.page.workbench import Workbench
from gearcad.sizing.geometry import Free, LimitKind


def _bench(name: str) -> Workbench:
    return Workbench((templates() / f"{name}.toml").read_text(encoding="utf-8"), name, templates())


def _map(bench: Workbench) -> LimitMap:
    found = limit_map(bench.design, bench.tables)
    assert found is not None
    return found


def test_a_pair_at_a_centre_distance_has_shift_and_helix() -> None:
    bench = _bench("fzg-c")
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.FIRST, Free.HELIX]
    bench.change(found.across.typed(0.25) | found.up.typed(12.0))
    assert (bench.fault, bench.design.gears["wheel"].helix_angle) == (None, -12)
    assert bench.tables["pinion"]["profile_shift"] == 0.25


def test_a_pair_without_has_both_shifts() -> None:
    bench = _bench("fzg-c")
    bench.change(
        {"pair.centre_distance": "", "wheel.profile_shift": "-0.1", "pinion.helix_angle": "-10", "wheel.helix_angle": "10"}
    )
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.FIRST, Free.SECOND, Free.HELIX]
    assert found.others[0].value == 10
    assert found.others[0].typed(15.0) == {"pinion.helix_angle": "-15.0", "wheel.helix_angle": "15.0"}


def test_the_map_has_the_design_where_it_stands() -> None:
    bench = _bench("reducer-21-43")
    found, pair = _map(bench), bench.design.gears
    ratio = next(each.values for each in found.map.limits if each.kind is LimitKind.CONTACT_RATIO)
    column = np.interp(found.across.value, found.map.across.values, np.arange(ratio.shape[1]))
    row = np.interp(found.up.value, found.map.up.values, np.arange(ratio.shape[0]))
    exact = bench.design.to_dict()["pair"]["transverse_contact_ratio"]
    assert ratio[round(row), round(column)] == pytest.approx(exact, abs=0.05)
    assert found.across.value == pair["pinion"].profile_shift


def test_a_gear_has_teeth_and_shift() -> None:
    bench = _bench("spur")
    found = _map(bench)
    assert [each.free for each in found.variables] == [Free.TEETH, Free.FIRST, Free.HELIX]
    assert found.across.typed(24.4) == {"gear.teeth": "24"}


@pytest.mark.parametrize("name", ["ring-22-70", "planetary-24-21-66"])
def test_others_have_none(name: str) -> None:
    bench = _bench(name)
    assert limit_map(bench.design, bench.tables) is None


def test_a_rack_and_pinion_has_that_of_its_pinion() -> None:
    bench = Workbench((Path(templates()) / "rack.toml").read_text(encoding="utf-8"), "rack", templates())
    assert list(_map(bench).up.keys) == ["pinion.profile_shift"]
