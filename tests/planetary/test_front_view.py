"""The front view shows gears that do not overlap, and the lever speeds that lie on one line."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.path import Path
from support.mode_trains import TRAINS
from support.planetary import thesis_train

from gearcad.planetary import Central, PlanetaryTrain, Rim
from gearcad.planetary.train_data import speeds
from gearcad.plots.planetary import plot_front, plot_ladder

THINNING = 0.15
"""Of all teeth (mm): more than pictures leave out of an outline."""

TURN = 0.02
"""Radians by which a gear is turned that must then be seen to overlap: more than that backlash."""


def _thinned(train: PlanetaryTrain) -> PlanetaryTrain:
    def thin(part: Central | Rim) -> Central | Rim:
        return replace(part, gear=replace(part.gear, tooth_thinning=THINNING))

    distance = float(train.centre_distance)
    return replace(train, centrals=(*map(thin, train.centrals),), rims=(*map(thin, train.rims),), centre_distance=distance)  # type: ignore[arg-type]


def _wide(train: PlanetaryTrain) -> PlanetaryTrain:
    """Planets wider than the centrals: sections through their middles are turned by helices otherwise than at the bottoms."""
    return replace(train, rims=tuple(replace(rim, gear=replace(rim.gear, face_width=33.0)) for rim in train.rims))


SHOWN = {
    name: _thinned(train)
    for name, train in {**TRAINS, "wide planets": _wide(TRAINS["A helical"]), "thesis": thesis_train()}.items()
}


def _overlaps(axes: Axes) -> int:
    """Points of the outlines of planets that lie in suns, or beyond the teeth of rings, and of these in planets."""
    filled = [np.asarray(each.get_xy(), float)[:-1] for each in axes.patches if isinstance(each, Polygon)]
    centred = [outline for outline in filled if np.hypot(*outline.mean(axis=0)) < 1e-6]
    planets = [outline for outline in filled if np.hypot(*outline.mean(axis=0)) > 1e-6]
    found = 0
    for sun in centred:
        for planet in planets:
            found += int(Path(sun).contains_points(planet).sum() + Path(planet).contains_points(sun).sum())
    for ring in (each.get_path() for each in axes.patches if type(each).__name__ == "PathPatch"):
        opening = ring.vertices[np.flatnonzero(ring.codes == Path.MOVETO)[-1] :]
        for planet in planets:
            found += int((~Path(opening).contains_points(planet)).sum() + Path(planet).contains_points(opening).sum())
    return found


@pytest.mark.parametrize("name", SHOWN)
def test_gears_are_drawn_in_mesh(name: str) -> None:
    train = SHOWN[name]
    panels = plot_front(train, train.pose(17.0), {}).axes
    assert len(panels) == len(train.rims)
    assert [sum(text.get_text().isdigit() for text in panel.texts) for panel in panels] == [train.planets] * len(panels)
    assert [_overlaps(panel) for panel in panels] == [0] * len(panels)
    pose = train.pose(17.0)
    turned = replace(pose, rotations={name: turn + np.degrees(TURN) for name, turn in pose.rotations.items()})
    assert all(_overlaps(panel) > 0 for panel in plot_front(train, turned, {}).axes)


def test_arrows_have_the_sense_of_the_speeds() -> None:
    train = TRAINS["A"]
    (panel,) = plot_front(train, train.pose(), {"a": 5.0, "b": 0.0, "carrier": -1.0, "planet": -2.0}).axes
    found = []
    for line in panel.lines:
        x, y = np.asarray(line.get_data(), float)
        if len(x) == 25:
            middle = np.array([x.mean(), y.mean()])
            centre = next((c for c in _centres(train) if np.ptp(np.hypot(x - c[0], y - c[1])) < 1e-6), None)
            assert centre is not None, middle
            turn = np.unwrap(np.arctan2(y - centre[1], x - centre[0]))
            found.append((str(line.get_color()), float(np.sign(turn[-1] - turn[0]))))
    # One sun, three planets, the carrier; the ring stands.
    assert found == [("#0072b2", 1.0), *[("#cc79a7", -1.0)] * 3, ("#009e73", -1.0)]


def _centres(train: PlanetaryTrain) -> list[tuple[float, float]]:
    return [(0.0, 0.0), *((planet.x, planet.y) for planet in train.pose().planets)]


@pytest.mark.parametrize("name", TRAINS)
def test_speeds_lie_on_one_line(name: str) -> None:
    train = TRAINS[name]
    found = speeds(train, {train.input: 1470.0})
    axes = plot_ladder(train, found.members, found.planet, "rpm")
    points = np.array([line.get_xydata()[0] for line in axes.lines if line.get_marker() == "o"])
    assert points[:, 0].tolist() == [*(found.members[each] for each in train.members), found.planet]
    line = np.polyfit(points[:, 1], points[:, 0], 1)
    assert np.polyval(line, points[:, 1]) == pytest.approx(points[:, 0], abs=1e-9 * np.abs(points[:, 0]).max())
    texts = [text.get_text() for text in axes.texts]
    assert any("1500" not in text and "1470, input" in text for text in texts) and any("0, fixed" in text for text in texts)
