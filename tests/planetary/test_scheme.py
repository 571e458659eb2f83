"""The scheme of a train: gears that mesh lie on each other, members hang together, and no name covers another."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np
import pytest
from support.mode_trains import TRAINS
from support.planetary import simple_train, thesis_train

from gearcad import Gear, GearPair
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim, TrainLoad
from gearcad.planetary.power import power_flow
from gearcad.plots.paper import new_figure
from gearcad.plots.planetary import spread
from gearcad.plots.planetary_scheme import Plan, SchemeLine, Weight, plan_of, plot_scheme, scheme_inches
from gearcad.report.planetary_tables import speed_table

LONG = "a name that is far longer than any column of a picture has room for, and goes on and on"
"""A name of more lines than are shown."""


def _gear(teeth: int, shift: float = 0.0, **given: float) -> Gear:
    return Gear(teeth=teeth, normal_module=2, profile_shift=shift, face_width=20, **given)


def _plain(**given: object) -> PlanetaryTrain:
    return simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, **given)


def _renamed() -> PlanetaryTrain:
    names = f"{LONG} sun", "planet_with_neither_blank_nor_hyphen_anywhere", f"{LONG} $ring$"
    sun, ring = (
        Central(name=name, gear=central.gear, meshes=names[1])
        for name, central in zip(names[::2], _plain().centrals, strict=True)
    )
    carrier = Carrier(name=f"{LONG} <carrier>", support_stiffness=0.0)
    rims = (Rim(name=names[1], gear=_plain().rims[0].gear),)
    return _plain(centrals=(sun, ring), rims=rims, carrier=carrier, input=sun.name, output=carrier.name, fixed=None)


def _stages() -> PlanetaryTrain:
    """Two stages before the sun, and a pinion inside a ring behind the carrier."""
    first, second = (GearPair(pinion=_gear(z), wheel=_gear(3 * z)) for z in (18, 20))
    drum = GearPair(pinion=_gear(22), wheel=_gear(-70, tip_diameter=-137.0))
    return _plain(
        input="motor",
        output="drum",
        stages=(
            PairStage(name="second", pair=second, pinion="middle", wheel="sun"),
            PairStage(name="first", pair=first, pinion="motor", wheel="middle"),
            PairStage(name="last", pair=drum, pinion="drum", wheel="carrier"),
        ),
    )


def _roles(train: PlanetaryTrain) -> dict[str, PlanetaryTrain]:
    """The same with every member in every role."""
    names = train.members
    ways = [(a, b, c) for a in names for b in names for c in (*names, None) if len({a, b, c}) == 3]
    return {f"{a}, {b}, {c}": replace(train, input=a, output=b, fixed=c) for a, b, c in ways}


SHAPES = {
    **TRAINS,
    "thesis": thesis_train(),
    "long names": _renamed(),
    "stages": _stages(),
    "one planet": simple_train((24, 21, -66), (0.3, 0.2, -0.7), 1),
    "many small planets": simple_train((159, 21, -201), (0.0, 0.0, 0.0), 20),
    "tiny sun": simple_train((14, 100, -214), (0.3, -0.3, 0.3), 2),
    "teeth of other numbers": simple_train((24, 20, -66), (0.4, 0.6, -0.4843), 3),
}


def _teeth(plan: Plan, part: str) -> list[SchemeLine]:
    return [stroke for stroke in plan.strokes if stroke.part == part and stroke.weight is Weight.TEETH]


@pytest.mark.parametrize("name", SHAPES)
def test_gears_that_mesh_lie_on_each_other(name: str) -> None:
    train = SHAPES[name]
    plan = plan_of(train)
    for mesh in train.meshes:
        (central,) = _teeth(plan, mesh.central.name)[-1:]
        sign = 1 if mesh.external else -1  # a sun lies below its planet
        found = []
        for rim in _teeth(plan, mesh.rim.name):
            apart = sign * (rim.points[0][1] - central.points[0][1])
            beside = min(rim.points[1][0], central.points[1][0]) - max(rim.points[0][0], central.points[0][0])
            found.append(apart == pytest.approx(0.06) and beside > 0.1)
        assert found.count(True) == 1


def _touch(one: SchemeLine, other: SchemeLine) -> bool:
    """Whether a point of one lies on the other: strokes run along x or along y only."""
    for a, b in ((one, other), (other, one)):
        for x, y in a.points:
            for (x0, y0), (x1, y1) in pairwise(b.points):
                if min(x0, x1) - 1e-9 <= x <= max(x0, x1) + 1e-9 and min(y0, y1) - 1e-9 <= y <= max(y0, y1) + 1e-9:
                    return True
    return False


def _crosses(one: SchemeLine, other: SchemeLine) -> bool:
    for (x0, y0), (x1, y1) in pairwise(one.points):
        for (u0, v0), (u1, v1) in pairwise(other.points):
            for level, post in (((x0, x1, y0, y1), (u0, u1, v0, v1)), ((u0, u1, v0, v1), (x0, x1, y0, y1))):
                if level[2] == level[3] and post[0] == post[1]:
                    inside = min(level[:2]) < post[0] < max(level[:2]) and min(post[2:]) < level[2] < max(post[2:])
                    if inside:
                        return True
    return False


@pytest.mark.parametrize("train", [*TRAINS.values(), _plain(), thesis_train()], ids=[*TRAINS, "A again", "thesis"])
def test_parts_hang_together_and_cross_no_other_in_any_role(train: PlanetaryTrain) -> None:
    for words, turned in ({"": train} if train.stages else _roles(train)).items():
        plan = plan_of(turned)
        rims = {rim.name: "planets" for rim in turned.rims}
        parts: dict[str, list[SchemeLine]] = {}
        for stroke in plan.strokes:
            parts.setdefault(rims.get(stroke.part, stroke.part), []).append(stroke)
        axis = parts.pop("")
        assert len(axis) == 1
        parts["above"] = [stroke for stroke in parts["planets"] if max(y for _, y in stroke.points) > _pin(plan, turned)]
        parts["below"] = [stroke for stroke in parts.pop("planets") if stroke not in parts["above"]]
        for name, strokes in parts.items():
            joined, waiting = [strokes[0]], strokes[1:]
            while near := [each for each in waiting if any(_touch(each, other) for other in joined)]:
                joined += near
                waiting = [each for each in waiting if each not in near]
            assert not waiting, f"{name} falls apart with {words}"
        for (name, one), (other, two) in combinations(parts.items(), 2):
            crossed = [pair for pair in ((a, b) for a in one for b in two) if _crosses(*pair)]
            assert not crossed or {name, other} <= {"above", "below"}, f"{name} crosses {other} with {words}"


@pytest.mark.parametrize(("torque", "carrier"), [(-200.0, 300.0), (200.0, 300.0), (-200.0, -2000.0), (0.0, 300.0)])
def test_arrows_are_where_power_goes_in_and_out(torque: float, carrier: float) -> None:
    """Of a differential at every member that has power: one that goes in begins away from the train."""
    train = _plain(input="sun", output="ring", fixed=None)
    flow = power_flow(train, TrainLoad(torque=torque, speed=900.0), {"carrier": carrier})
    found = {arrow.part: "in" if abs(arrow.start[0]) > abs(arrow.end[0]) else "out" for arrow in plan_of(train, flow).arrows}
    powers = {name: "in" if power > 0 else "out" for name, power in flow.powers.items() if power}
    assert found == (powers or {"sun": "in", "ring": "out"})
    words = {row[0]: row[1] for row in speed_table(train, flow.speeds, flow, "rpm").rows}
    for name, way in powers.items():
        assert words[name] in (f"{way}put", f"power {way}", f"input, power {way}", f"output, power {way}")


def _pin(plan: Plan, train: PlanetaryTrain) -> float:
    return plan.strokes[[stroke.part for stroke in plan.strokes].index(train.carrier.name)].points[0][1]


@pytest.mark.parametrize("name", SHAPES)
def test_no_name_covers_another_or_leaves_the_picture(name: str) -> None:
    train = SHAPES[name]
    figure = new_figure(scheme_inches(train))
    axes = plot_scheme(train, figure.add_axes((0.0, 0.0, 1.0, 1.0)))
    figure.canvas.draw()
    boxes = {text.get_text(): text.get_window_extent() for text in axes.texts if text.get_text()}
    parts = {
        *train.members,
        *(rim.name for rim in train.rims),
        *(s for each in train.stages for s in (each.pinion, each.wheel)),
    }
    assert len(boxes) == len(parts)
    width, height = figure.canvas.get_width_height()
    for box in boxes.values():
        assert box.x0 > 0 and box.y0 > 0 and box.x1 < width and box.y1 < height
    for one, other in combinations(boxes.values(), 2):
        assert not one.overlaps(other)
    drawn = np.array([point for line in axes.lines if line.get_linewidth() > 1 for point in line.get_xydata()])
    left, right = axes.transData.transform(drawn)[:, 0].min(), axes.transData.transform(drawn)[:, 0].max()
    assert all(box.x1 < left or box.x0 > right for box in boxes.values())


def test_names_move_no_further_than_others_make_them() -> None:
    assert spread([0.0, 5.0], [1.0, 1.0], gap=0.0) == [0.0, 5.0]
    assert spread([1.0, 1.0, 1.0], [1.0, 1.0, 1.0], gap=0.0) == pytest.approx([0.0, 1.0, 2.0])
    rng = np.random.default_rng(1)
    for count in range(1, 9):
        wanted, heights = rng.uniform(0, 3, count), rng.uniform(0.2, 1, count)
        placed = np.array(spread(wanted.tolist(), heights.tolist(), gap=0.1))
        order = np.argsort(wanted)
        apart = np.diff(placed[order]) - (heights[order][1:] + heights[order][:-1]) / 2 - 0.1
        assert (apart > -1e-12).all()
        # No step that keeps the names apart makes the sum of squares less: of the least one, with convex bounds.
        least = ((placed - wanted) ** 2).sum()
        for _ in range(200):
            trial = placed[order] + rng.normal(0, 0.05, count)
            free = np.diff(trial) - (heights[order][1:] + heights[order][:-1]) / 2 - 0.1
            assert (free < 0).any() or ((trial - wanted[order]) ** 2).sum() > least - 1e-12
