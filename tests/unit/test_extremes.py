"""Means, series, curves and extremes over a base pitch, against closed forms."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from support.checks import coarse_model, coarse_pair

from gearcad import FlankModification, Material, Mounting
from gearcad.check.summary import PLANE, SOLID, STRESSES
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.loaded import Extreme, ExtremeQuantity, RollRange, add_positions, extreme
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, Role
from gearcad.geometry import ReliefShape
from gearcad.mesh_cycle import MeshCycle

_EXACT = 0.002
"""What the greatest over the mesh may be off, of itself (or of its swing)."""

_ESTIMATE = 0.001
"""How much more than the told error may be missed: lines tell what stands between positions but to first order."""

Course = Callable[[float], float]

Kink = tuple[float, float, float]


def sought(course: Course, count: int, pitch: float = 20.0, repeats: bool = True) -> tuple[Extreme | None, int]:
    """The extreme of a course from `count` even positions, and how many were added."""
    quantity, span = ExtremeQuantity("value", lambda value: value), RollRange(pitch, repeats)
    angles = ((np.arange(count) + 0.5) / count * pitch - pitch / 2).tolist()
    asked: list[float] = []

    def solve(angle: float) -> float:
        asked.append(angle)
        return course(angle)

    known = [(angle, course(angle)) for angle in angles]
    added = add_positions(known, span, solve, [quantity])
    assert len(added) == len(asked)
    return extreme([*known, *zip(asked, added, strict=True)], span, quantity), len(asked)


def wrapped(angle: float, pitch: float = 20.0) -> float:
    return (angle + pitch / 2) % pitch - pitch / 2


def kinked(place: float, up: float, down: float) -> Course:
    """A convex rise to 100 at `place`, and a fall that is `down` over `up` times as steep and levels off: a pair leaves."""

    def course(angle: float) -> float:
        away = wrapped(angle - place)
        return 60 + 40 * (math.exp(up * away / 20) if away <= 0 else math.exp(-down * away / 20))

    return course


def jumping(place: float) -> Course:
    """From 70 to 100 at `place`, then down by and by; 70 till then: a contact comes away from an edge."""
    return lambda angle: 70 + 30 * math.exp(-wrapped(angle - place) / 8) if wrapped(angle - place) >= 0 else 70.0


def seen(place: float) -> Course:
    """As `jumping`, but nothing at all before the place."""
    return lambda angle: 100 - wrapped(angle - place) if wrapped(angle - place) >= 0 else math.nan


@pytest.mark.parametrize("count", [12, 24, 60])
@pytest.mark.parametrize("place", [-9.97, -4.3, 0.0, 3.333, 7.91])
@pytest.mark.parametrize(
    "shape",
    [
        lambda place: kinked(place, 4, 40),
        lambda place: kinked(place, 40, 3),
        lambda place: kinked(place, 300, 2),
        lambda place: kinked(place, 20, 20),
        lambda place: lambda angle: 90 + 10 * math.cos(2 * math.pi * (angle - place) / 20),
        jumping,
        seen,
    ],
    ids=["gentle and steep", "steep and gentle", "nearly a jump", "even", "smooth", "jump", "nothing before"],
)
def test_the_greatest_is_found_wherever_the_positions_stand(shape: Callable[[float], Course], place: float, count: int) -> None:
    found, added = sought(shape(place), count)
    assert found is not None
    assert 1 - found.value / 100 < _EXACT / 2
    assert 1 - found.value / 100 < found.error + _ESTIMATE / 2
    assert wrapped(found.roll_angle - place) == pytest.approx(0, abs=20 / count)
    assert added <= 20


def test_nothing_is_sought_where_nothing_can_be() -> None:
    assert sought(lambda _angle: 5.0, 12) == (Extreme(5.0, pytest.approx(-10 + 20 / 24), 0.0005), 0)
    assert sought(lambda _angle: math.nan, 12) == (None, 0)
    # Without a next pitch the ends are ends: a course that rises all the way is greatest at the last position.
    found, added = sought(lambda angle: 50 + angle, 12, repeats=False)
    assert (found, added) == (Extreme(pytest.approx(60 - 20 / 24), pytest.approx(10 - 20 / 24), 0.0005), 0)


@pytest.mark.parametrize("repeats", [True, False])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_few_positions_tell_nothing_of_what_stands_between_them(count: int, repeats: bool) -> None:
    quantity, angles = ExtremeQuantity("value", lambda value: value), np.linspace(-5, 5, count)
    found = extreme([(float(angle), 100.0) for angle in angles], RollRange(20.0, repeats), quantity)
    assert found is not None and found.value == 100.0
    assert math.isinf(found.error) or (count == 1 and not repeats)


def test_a_least_value_and_a_swing() -> None:
    known = [(angle, math.cos(math.radians(18 * angle))) for angle in (-7.5, -2.5, 2.5, 7.5)]
    least = extreme(known, RollRange(20.0), ExtremeQuantity("value", lambda value: value, least=True, swing=True))
    assert least is not None
    assert least.value == min(value for _, value in known) and least.error > 0


# ---------------------------------------------------------------------- the models


@cache
def plane(relief: float = 0.0) -> PlanePair:
    """FZG C, three teeth of each gear."""
    pair, changes = coarse_pair("FZG C"), FlankModification(tip_relief=relief, tip_relief_length=1.5 if relief else 0)
    gears = {name: replace(getattr(pair, name), modification=changes) for name in ("pinion", "wheel")}
    return plane_pair(replace(pair, **gears), Material(), body=BodyModel(teeth=3))


def missed(cycle: PlaneCycle | SolidCycle, dense: PlaneCycle | SolidCycle, quantity: ExtremeQuantity) -> float:  # type: ignore[type-arg]
    """How far a cycle's extreme is below that of another with many positions, of itself or of its swing."""
    values = quantity.sign * np.array([quantity.value(position) for position in dense.positions])
    values = values[~np.isnan(values)]
    found = cycle.extreme(quantity)
    assert found is not None
    return float((values.max() - quantity.sign * found.value) / (np.ptp(values) if quantity.swing else abs(values.max())))


@pytest.mark.parametrize(("torque", "relief"), [pytest.param(302.0, 0.0, marks=pytest.mark.long), (20.0, 0.0), (302.0, 20.0)])
def test_a_plane_cycle_is_exact_whatever_its_positions(torque: float, relief: float) -> None:
    """12 even positions miss 2 to 5 % of some of these, 60 still 0.6 %."""
    model = plane(relief)
    dense, even = PlaneCycle.run(model, torque, 100), PlaneCycle.run(model, torque, 12)
    assert max(missed(even, dense, quantity) for quantity in STRESSES) > 2 * _EXACT
    for cycle in (even.searched(PLANE), PlaneCycle.run(model, torque, 17).searched(PLANE)):
        for quantity in PLANE:
            found = cycle.extreme(quantity)
            if found is None:
                assert quantity.name.startswith("bore_tension")  # these bores are kept round
                continue
            assert missed(cycle, dense, quantity) < min(_EXACT, found.error + _ESTIMATE), quantity.name
        assert [position.roll_angle for position in cycle.every] == sorted(position.roll_angle for position in cycle.every)
    assert cycle.worst_position(Role.PINION).tension.pinion.stress == cycle.extreme(STRESSES[0]).value  # type: ignore[union-attr]
    mean, off = cycle.mean("stiffness")
    assert abs(mean - dense.values("stiffness").mean()) < min(float(off), 0.002 * mean)
    assert len(cycle.positions) == 17 and cycle.values("stiffness").shape == (17,)


@pytest.mark.long
@pytest.mark.parametrize(("name", "torque"), [pytest.param("FZG C", 302.0, marks=pytest.mark.long), ("helical", 12.0)])
def test_a_solid_cycle_is_exact_too(name: str, torque: float) -> None:
    """Of the lightly loaded helical pair 24 even positions miss 7 % of the pressure and 15 % of the line load."""
    model = coarse_model(name)
    dense, cycle = SolidCycle.run(model, torque, 48), SolidCycle.run(model, torque, 12).searched(SOLID)
    for quantity in SOLID:
        found = cycle.extreme(quantity)
        if found is None:
            assert quantity.name.startswith("bore_tension")  # these bores are kept round
            continue
        assert missed(cycle, dense, quantity) < min(_EXACT, found.error + _ESTIMATE), quantity.name


def test_a_pressure_along_a_line_does_not_depend_on_which_cell_is_inside() -> None:
    """Where the reach of an edge ends between two cells, the pressure is that between them: no saw teeth as gears roll."""
    cycle = SolidCycle.run(coarse_model("helical"), 60.0, 2)
    angles = np.linspace(4.0, 4.4, 9)
    pressures = [cycle.solve(float(angle)).contact_pressure for angle in angles]
    steps = np.diff(pressures)
    assert np.abs(np.diff(steps)).max() < 0.001 * max(pressures)  # with the cells alone it is 2 %


@pytest.mark.parametrize("shape", ReliefShape)
def test_relieved_tips_roll_smoothly(shape: ReliefShape) -> None:
    """As cells of the lines pass the ends of the flanks nothing jumps: a relief goes on to the end, and no further."""
    plain = coarse_model("helical")
    changes = FlankModification(tip_relief=12.0, tip_relief_length=1.0, tip_relief_shape=shape)
    gears = {name: replace(getattr(plain.pair, name), modification=changes) for name in ("pinion", "wheel")}
    cycle = SolidCycle.run(plain.remade(replace(plain.pair, **gears), Mounting()), 60.0, 2)
    errors = [cycle.solve(float(angle)).transmission_error for angle in np.linspace(-2.0, -1.6, 9)]
    assert np.abs(np.diff(errors, 2)).max() < 0.005 * errors[0]  # 40 % where a parabola seemed to end before the tip


def _cycle(angle: Floats, stiffness: Floats, **more: Any) -> MeshCycle:
    return MeshCycle(
        method="made up",
        holds=(),
        torque=1.0,
        force=100.0,
        width=10.0,
        roll_angle=angle,
        mesh_stiffness=stiffness,
        tangent_stiffness=1.1 * stiffness,
        transmission_error=np.divide(100.0, stiffness, where=stiffness != 0, out=np.zeros_like(stiffness)),
        **more,
    )


def _square(low: float = 100.0, high: float = 160.0, share: float = 0.57) -> MeshCycle:
    """High for a share of a pitch of 20 deg, that begins at -10 deg."""
    jump = -10 + 20 * share
    angle = np.r_[np.linspace(-10, jump, 101), np.linspace(jump, 10, 75)]
    return _cycle(angle, np.r_[np.full(101, high), np.full(75, low)])


def test_mean_with_a_jump() -> None:
    assert _square().mean == pytest.approx(0.57 * 160 + 0.43 * 100, rel=1e-14)
    assert _square().secant_per_width == pytest.approx(_square().mean / 10, rel=1e-14)
    assert _square().tangent_mean == pytest.approx(1.1 * _square().mean, rel=1e-14)


def test_mean_between_jumps_is_of_fourth_order() -> None:
    angle = np.r_[np.linspace(-10, 0, 11), np.linspace(0, 10, 11)]
    stiffness = np.r_[50 + np.exp(angle[:11] / 10), 80 + np.exp(angle[11:] / 10)]
    exact = 65 + (math.e - 1 / math.e) / 2
    assert _cycle(angle, stiffness).mean == pytest.approx(exact, rel=1e-7)


def test_mean_of_a_periodic_curve() -> None:
    angle = np.linspace(-9.5, 10.5, 41)
    smooth = 1 / (2 + np.cos(2 * np.pi * angle / 20))
    assert _cycle(angle, 100 * smooth).mean == pytest.approx(100 / math.sqrt(3), rel=1e-12)


def test_series_of_a_square_wave() -> None:
    """a_n, b_n of a square wave in closed form; the phase counts from roll angle 0."""
    series = _square().fourier(12)
    n = np.arange(1, 13)
    first, last = -math.pi, -math.pi + 2 * math.pi * 0.57
    assert series.mean == pytest.approx(_square().mean, rel=1e-14)
    assert series.cosine == pytest.approx(60 * (np.sin(n * last) - np.sin(n * first)) / (np.pi * n), abs=60 * 2e-5)
    assert series.sine == pytest.approx(-60 * (np.cos(n * last) - np.cos(n * first)) / (np.pi * n), abs=60 * 2e-5)
    assert series.amplitude == pytest.approx(np.hypot(series.cosine, series.sine))


def test_series_sums_to_the_curve() -> None:
    angle = np.linspace(-10, 10, 81)
    curve = 100 + 20 * np.cos(2 * np.pi * angle / 20 + 0.3) + 5 * np.sin(6 * np.pi * angle / 20)
    series = _cycle(angle, curve).fourier(5)
    turns = 2 * np.pi * np.outer(np.arange(1, 6), angle) / 20
    assert series.mean + series.cosine @ np.cos(turns) + series.sine @ np.sin(turns) == pytest.approx(curve, rel=1e-12)


def test_more_harmonics_than_points_tell() -> None:
    with pytest.raises(ValueError, match=r"harmonics = 40: must be a whole number from 1 to 20"):
        _cycle(np.linspace(0, 20, 81), np.full(81, 100.0)).fourier(40)


def test_curve_goes_on() -> None:
    cycle = _square()
    assert cycle.stiffness_at([-9.0, 11.0, 31.0, -29.0]) == pytest.approx([160.0] * 4)
    assert cycle.stiffness_at(9.0) == 100.0
    assert cycle.stiffness_at(9.0, tangent=True) == pytest.approx(110.0)
    assert cycle.pitch_point == 160.0
    assert (cycle.maximum, cycle.minimum, cycle.pitch_angle) == (160.0, 100.0, 20.0)
    assert cycle.error_peak_to_peak == pytest.approx(100 / 100 - 100 / 160)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, 0.0, -3.0])
def test_never_without_a_value(wrong: float) -> None:
    with pytest.raises(SolverError, match="made up"):
        _cycle(np.linspace(0, 20, 5), np.array([1.0, 2.0, wrong, 2.0, 1.0]))


def test_arrays_are_read_only_and_document_is_plain() -> None:
    cycle = replace(_square(), pairs=(0,), load_share=np.ones((176, 1)), compliance_parts={"all": np.ones(176)})
    with pytest.raises(ValueError, match="read-only"):
        cycle.mesh_stiffness[0] = 1.0
    document = cycle.to_dict()
    assert document["c_gamma_beta"] == cycle.secant_per_width
    assert document["mesh_cycle"]["compliance_parts"]["all"] == [1.0] * 176
    assert "maximum" not in replace(cycle, mean_only=True).to_dict()


_STATIONARY = 1e-4
"""Relative: a fifth of the least error that is told of an extreme."""


@pytest.mark.parametrize("steepness", [0.3, 1.0, 2.0])
def test_a_kink_is_found_far_below_the_told_error(steepness: float) -> None:
    """Wherever it is between even positions: so that no comparison of nearly equal numbers on the way shows in the figure."""
    for place in np.linspace(-0.5, 0.5, 11).tolist():
        found, _ = sought(kinked(place, 1.0, steepness), 24)
        assert found is not None
        assert found.value == pytest.approx(100.0, rel=_STATIONARY)
