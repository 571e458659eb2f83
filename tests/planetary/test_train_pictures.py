"""Pictures of what was computed of a train show those numbers, and survive few planets and many."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from support.planetary import simple_train
from support.planetary_trains import MASSES, TRAINS, on_springs

from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.planetary.load_sharing import share_load
from gearcad.dynamics.planetary.planar_model import train_springs
from gearcad.dynamics.planetary.planetary_excitation import PlanetMeshStiffness, train_stiffness
from gearcad.dynamics.planetary.planetary_modes import ModeKind, planetary_campbell, planetary_modes
from gearcad.dynamics.planetary.planetary_response import planetary_response
from gearcad.dynamics.planetary.planetary_statics import torsional_stiffness
from gearcad.dynamics.planetary.quasi_static_run import run_train
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.plots.planetary import plot_phases, plot_sharing, plot_torsion
from gearcad.plots.planetary_vibration import (
    KIND_COLOURS,
    plot_modes,
    plot_response,
    plot_running,
    plot_train_campbell,
    shown_families,
    shown_pitches,
)

FLEXIBLE = {"support": 60.0, "pin": 200.0, "torsion": 1e5}
MEANS = (400.0, 500.0)


@pytest.fixture(scope="module")
def stiffness() -> dict[str, PlanetMeshStiffness]:
    return train_stiffness(TRAINS["D"], positions=16)


def test_dots_stand_where_contact_is_at_the_pitch_point(stiffness: dict[str, PlanetMeshStiffness]) -> None:
    train = TRAINS["D"]
    above, below = np.array(plot_phases(train, train.phases, stiffness).axes).reshape(2, 2)
    for rows, sums, (name, phases) in zip(above, below, train.phases.items(), strict=True):
        dots = [line for line in rows.lines if line.get_marker() == "o"]
        for line, ahead in zip(dots, phases.ahead, strict=True):
            assert (np.asarray(line.get_xdata(), float) + ahead) % 1 == pytest.approx(0, abs=1e-9) or ahead == 0
        # The sum of all planets, in the mean over the pitch, is as many times the mean of the mesh.
        curve = np.asarray(sums.lines[train.planets].get_ydata(), float)
        level = sums.lines[train.planets + 1].get_ydata()[0]
        assert level == train.planets * stiffness[name].mean
        assert curve.mean() == pytest.approx(level, rel=5e-3)
        thin = sum(np.asarray(line.get_ydata(), float) for line in sums.lines[: train.planets])
        assert curve == pytest.approx(thin)


def test_phases_are_drawn_without_stiffness_and_of_many_planets() -> None:
    train = simple_train((159, 21, -201), (0.0, 0.0, 0.0), 20)
    rows, _ = plot_phases(train, train.phases).axes
    assert sum(line.get_marker() == "o" for line in rows.lines) == 20
    assert len(rows.get_yticks()) == 10


@pytest.mark.parametrize("name", ["A helical", "D"])
def test_modes_are_drawn_as_their_kinds_say(name: str) -> None:
    train = on_springs(TRAINS[name], **FLEXIBLE)
    modes = planetary_modes(train_springs(train, MEANS), MASSES)
    panels = [panel for panel in plot_modes(train, modes).axes if panel.patches]
    families = shown_families(modes)
    assert len(panels) == len(families) == 12
    for panel, family in zip(panels, families, strict=True):
        assert family.kind.value in panel.get_title()
        central, planets = _travels(panel, train)
        if family.kind is ModeKind.ROTATIONAL:
            assert central == pytest.approx(0, abs=1e-6)
            assert np.ptp(planets) == pytest.approx(0, abs=1e-5 * planets.max())
        elif family.kind is ModeKind.PLANET:
            assert central == pytest.approx(0, abs=1e-6) and planets.max() > 0
        assert max(central.max(), planets.max()) <= 0.23 * float(train.centre_distance)


def _travels(axes: Axes, train: PlanetaryTrain) -> tuple[np.ndarray, np.ndarray]:
    """How far centrals and planets are drawn from where they rest."""
    circles = [np.array(each.get_center()) for each in axes.patches if isinstance(each, Circle)]
    moved = np.array([np.hypot(*(b - a)) for a, b in zip(circles[::2], circles[1::2], strict=True)])
    assert len(moved) == 2 + train.planets
    return moved[:2], moved[2:]


def test_bars_are_the_shares_and_lines_the_factors() -> None:
    train = on_springs(TRAINS["A"], **FLEXIBLE)
    errors = replace(train, carrier=replace(train.carrier, pin_errors=(20.0, 0.0, 0.0)))
    eccentric = replace(errors, centrals=(replace(train.centrals[0], run_out=12.0), train.centrals[1]))
    for shown in (errors, eccentric):
        sharing = share_load(shown, TrainLoad(torque=800.0, speed=1000.0), dict(zip(_names(train), MEANS, strict=True)))
        axes = plot_sharing(sharing)
        assert [bar.get_height() for bar in axes.containers[0]] == sharing.shares.tolist()
        levels = {float(line.get_ydata()[0]) for line in axes.lines if len(set(line.get_ydata())) == 1}
        assert {sharing.mesh_load_factor, *(each.factor for each in sharing.published)} <= levels
        labels = [text.get_text() for text in axes.get_legend().get_texts()]
        assert ("over all turns" in labels) == bool(sharing.turning)
        assert sum("recalled" in label for label in labels) == sum(each.recalled for each in sharing.published) == 1


def test_bars_of_the_twist_fill_up_to_the_whole() -> None:
    train = on_springs(TRAINS["D"], **FLEXIBLE)
    torsion = torsional_stiffness(train, TrainLoad(torque=800.0), dict(zip(_names(train), MEANS, strict=True)))
    widths = [bar.get_width() for bar in plot_torsion(torsion).patches]
    assert sum(widths) == pytest.approx(100) and widths == sorted(widths, reverse=True)


def _names(train: PlanetaryTrain) -> tuple[str, ...]:
    return tuple(mesh.name for mesh in train.meshes)


def test_a_run_is_drawn_whole_and_close_by(stiffness: dict[str, PlanetMeshStiffness]) -> None:
    train = on_springs(TRAINS["D"], **FLEXIBLE)
    eccentric = replace(train, centrals=(replace(train.centrals[0], run_out=12.0), train.centrals[1]))
    running = run_train(eccentric, TrainLoad(torque=800.0, speed=1000.0), stiffness)
    shares, near, _, twist = plot_running(running).axes
    assert len(shares.collections) == train.planets  # bands: the run is long
    for planet, line in enumerate(near.lines[::2]):
        shown = np.asarray(line.get_ydata(), float)
        assert shown.tolist() == running.shares[planet, : len(shown)].tolist()
    assert near.get_xlim()[1] == pytest.approx(shown_pitches(running), rel=0.05)
    assert np.asarray(twist.lines[0].get_ydata(), float) == pytest.approx(3600 * running.twist[: len(shown)])
    low, high = (float(edge) for edge in shares.get_ylim())
    assert low <= running.shares.min() and high >= running.shares.max()


def test_level_shares_have_a_range_that_is_no_rounding(stiffness: dict[str, PlanetMeshStiffness]) -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    running = run_train(train, TrainLoad(torque=800.0, speed=1000.0), train_stiffness(train, method="iso6336"))
    assert running.shares == pytest.approx(1.0)
    low, high = plot_running(running).axes[0].get_ylim()
    assert low == pytest.approx(0.995) and high == pytest.approx(1.005)


def test_the_diagram_marks_what_the_phases_let_be_excited() -> None:
    train = on_springs(TRAINS["A helical"], **FLEXIBLE)
    modes = planetary_modes(train_springs(train, MEANS), MASSES)
    campbell = planetary_campbell(train, modes, train.phases, 9000.0)
    axes = plot_train_campbell(train, campbell)
    marks = {marker: [line for line in axes.lines if line.get_marker() == marker and len(line.get_xdata())] for marker in "ox"}
    assert len(marks["o"]) == len(campbell.excited) > 0
    assert len(marks["x"]) == sum(met.excited is False for met in campbell.resonances) > 0
    for line, met in zip(marks["o"], campbell.excited, strict=True):
        (speed,), (frequency,) = line.get_data()
        # On a line of the diagram and on a natural frequency.
        assert frequency == pytest.approx(campbell.lines[met.line].per_rpm * speed)
        assert frequency == campbell.families[met.family].frequency
    # All planets are in phase: only rotational modes are excited, and only these have dots.
    kinds = {campbell.families[met.family].kind for met in campbell.excited}
    assert kinds == {ModeKind.ROTATIONAL} == {
        kind for kind, colour in KIND_COLOURS.items() if any(line.get_color() == colour for line in marks["o"])
    }  # fmt: skip


def test_loads_over_speed_are_those_of_the_planet_that_carries_most() -> None:
    train = on_springs(TRAINS["A"], **FLEXIBLE)
    response = planetary_response(
        train,
        TrainLoad(torque=300.0, speed=2000.0),
        train_stiffness(train, positions=12),
        MASSES,
        DynamicsOptions(speeds=10, speed_from=1500.0, speed_to=2500.0, harmonics=3),
    )
    drawn = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in plot_response(response).lines}
    for name, factors in response.factors.items():
        assert drawn[name].tolist() == factors.max(axis=1).tolist()
    assert "speed of the load" in drawn
