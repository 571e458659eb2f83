"""Meshes of solid bodies: the error that a check tells against what much finer meshes say; orders out of made-up values."""

from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from support.checks import TORQUES, coarse_pair
from threadpoolctl import threadpool_limits

import gearcad.check.convergence as convergence
from gearcad import Material
from gearcad.check.convergence import FEW_POSITIONS, SOLID_FACTORS, Convergence, three_solid_meshes
from gearcad.check.summary import figures
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidSizes, solid_pair


@dataclass(frozen=True)
class Told:
    """A cycle that was never run, and its figures."""

    value: float

    @property
    def mesh_stiffness(self) -> float:
        return self.value

    @property
    def root_tension(self) -> tuple[float, float]:
        return self.value, self.value


def estimated(monkeypatch: pytest.MonkeyPatch, *values: float) -> Convergence:
    monkeypatch.setattr(convergence, "figures", lambda cycle: cycle)
    found = three_solid_meshes([Told(value) for value in values])  # type: ignore[misc]
    assert len({(each.order, each.error) for each in found}) == 1
    return found[0]


@pytest.mark.parametrize("order", [1.1, 1.5, 1.9])
def test_an_error_of_known_order_is_found(monkeypatch: pytest.MonkeyPatch, order: float) -> None:
    """A value of 14 (1 + 0.01 h^p), h = 1 on the mesh of the check."""
    found = estimated(monkeypatch, *(14 * (1 + 0.01 * factor**-order) for factor in SOLID_FACTORS))
    assert found.order == pytest.approx(order, abs=0.015)  # 0.794 times 1.26 is 1.0004
    assert found.error == pytest.approx(0.01, rel=0.02)


@pytest.mark.parametrize(
    ("values", "order", "error"),
    [
        ((104.0, 101.0, 100.0), 4.7536, 0.0270185),  # faster than 2: credited with 2
        ((101.0, 99.0, 100.0), None, 0.02),  # back and forth: the range
        ((104.0, 99.0, 100.0), None, 0.05),
        ((101.0, 101.0, 100.0), None, 0.0270185),
        ((102.1, 101.0, 100.0), 0.4124, 0.0270185),  # slower than 1
        ((100.0, 100.0, 100.0), None, 0.0),
    ],
)
def test_no_order_is_told_by_the_greater_change(
    monkeypatch: pytest.MonkeyPatch, values: tuple[float, ...], order: float | None, error: float
) -> None:
    found = estimated(monkeypatch, *values)
    assert found.order == (None if order is None else pytest.approx(order, rel=1e-3))
    assert found.error == pytest.approx(error, rel=1e-4)


def cycle(name: str, factor: float) -> SolidCycle:
    body, sizes = BodyModel(teeth=3), SolidSizes().refined(factor)
    with threadpool_limits(1):
        model = solid_pair(coarse_pair(name), Material(), body=body, sizes=sizes)
        return SolidCycle.run(model, TORQUES[name], FEW_POSITIONS)


@pytest.mark.long
@pytest.mark.parametrize("name", TORQUES)
def test_the_error_that_is_told_holds(name: str) -> None:
    """From meshes around 0.8 of the usual fineness, against one of 1.6: eight times the nodes."""

    def cycles() -> Iterator[SolidCycle]:
        for factor in SOLID_FACTORS:
            yield cycle(name, 0.8 * factor)

    told, true = three_solid_meshes(cycles()), cycle(name, 1.6)
    for each, value in zip(told, (true.values("stiffness").mean(), *figures(true).root_tension), strict=True):
        assert abs(each.values[1] / value - 1) < 1.2 * each.error + 1e-3, each
        assert each.error < 0.03
