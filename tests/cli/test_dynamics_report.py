"""Reports and pictures of dynamics: they hold the numbers of the studies, and need nothing from elsewhere."""

from dataclasses import replace

import lxml.etree
import lxml.html
import numpy as np
import pytest
from matplotlib.figure import Figure

from gearcad import Gear, GearPair, Load, Material
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.pair_study import study_contact, study_pair
from gearcad.dynamics.train_result import TrainStudy
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.members import Inertia, Shaft, StiffnessWave, ToothMesh
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.plots.paper import short
from gearcad.plots.speeds import plot_course, plot_cycle, plot_factors, plot_shaft_overload
from gearcad.plots.trains import plot_energies, plot_shapes
from gearcad.report import write_dynamics_report
from gearcad.report.document import symbolic
from gearcad.report.dynamics_tables import MOST_PEAKS, peak_table, shaft_table
from gearcad.stiffness import METHODS

NASTY_NAME = 'a <b>"train"</b> & $more$'


def two_wheels(model: TrainModel = TrainModel.ELEMENTS, damping_ratio: float = 0.05) -> Train:
    """A pinion on a shaft of 300 mm between two wheels, one on a coupling, one on a shaft of 500 mm; held nowhere."""
    mesh = {"pinion": "p_1", "teeth": 20, "stiffness": 300.0, "base_radii": (40.0, 80.0), "damping_ratio": damping_ratio}
    inertias = {"motor": 0.05, "p_1": 0.002, "left": 0.03, "right": 0.03, "load $1$": 0.3, "load 2": 0.4}
    return Train(
        model=model,
        inertias=tuple(Inertia(name=name, inertia=each) for name, each in inertias.items()),
        shafts=(
            Shaft(name="drive", start="motor", end="p_1", length=300.0, diameter=40.0, damping_ratio=0.02),
            Shaft(name="<out>", start="left", end="load $1$", length=500.0, diameter=50.0, damping_ratio=0.02),
            Shaft(name="coupling", start="right", end="load 2", torsional_stiffness=2e4, damping=2.0),
        ),
        meshes=(
            ToothMesh(name="L", wheel="left", variation=0.2, **mesh),  # type: ignore[arg-type]
            ToothMesh(name="R", wheel="right", shape=StiffnessWave.SQUARE, contact_ratio=1.6, **mesh),  # type: ignore[arg-type]
        ),
        torques={"motor": 300.0, "load $1$": 400.0, "load 2": 200.0},
    )


def spur_pair() -> GearPair:
    pinion, wheel = (Gear(teeth=z, normal_module=2, face_width=15, tooth_thinning=0.05) for z in (19, 31))
    return GearPair(pinion=pinion, wheel=wheel)


@pytest.fixture(scope="module")
def train() -> TrainStudy:
    return study_train(two_wheels(), DynamicsOptions(speeds=60, frequencies=5, speed_from=500.0, speed_to=4000.0))


@pytest.fixture(scope="module")
def pair() -> PairStudy:
    """Hardly damped, so that its flanks part."""
    of, material, load = spur_pair(), Material(), Load(torque=60.0)
    cycle = METHODS["potential-energy"](pair=of, material=material)(load)
    options = DynamicsOptions(speeds=60, damping_ratio=0.04, speed_from=20000.0, speed_to=60000.0)
    return study_pair(of, material, load, cycle, (2e-5, 1.4e-4), options)


@pytest.fixture(scope="module")
def contact() -> ContactStudy:
    """Soft teeth, as in the thesis: some speeds are chaotic."""
    options = DynamicsOptions(
        model="contact", tooth_stiffness=0.4, tooth_damping=4.0, speed_to=6000.0, speeds=5, duration=0.1, sampling=50000.0
    )
    return study_contact(spur_pair(), Load(torque=10.0), None, (2e-5, 4e-5), options)


@pytest.fixture(scope="module")
def pages(
    train: TrainStudy, pair: PairStudy, contact: ContactStudy, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, str]:
    """The reports of all three, as they are written; without the layout of figures, which takes most of the time."""
    folder, found = tmp_path_factory.mktemp("reports"), {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gearcad.report.document.new_figure", lambda inches: Figure(figsize=inches))
        for name, study in (("train", train), ("pair", pair), ("contact", contact)):
            write_dynamics_report(study, NASTY_NAME, folder / f"{name}.html")
            found[name] = (folder / f"{name}.html").read_text(encoding="utf-8")
    return found


def table(text: str, head: str) -> list[list[str]]:
    """Cells of the body of the table whose first head is this."""
    document = lxml.html.document_fromstring(text)
    (found,) = [each for each in document.xpath("//table") if each.xpath("string(./thead/tr/th[1])") == head]
    return [[cell.text_content() for cell in row] for row in found.xpath("./tbody/tr")]


def test_pages_are_well_formed_and_need_nothing_from_elsewhere(
    pages: dict[str, str], train: TrainStudy, pair: PairStudy, contact: ContactStudy
) -> None:
    for text, study, figures in zip(pages.values(), (train, pair, contact), (8, 6, 4), strict=True):
        root = lxml.etree.fromstring(text.removeprefix("<!DOCTYPE html>").strip().encode())
        numbered = [name for name in root.xpath("//figure/@id") if name != "pair"]
        assert numbered == [f"figure-{number}" for number in range(1, figures + 1)]
        assert len(set(root.xpath("//@id"))) == len(root.xpath("//@id")) == len(root.xpath("//figure | //h2"))
        document = lxml.html.document_fromstring(text)
        assert document.xpath("//link | //script | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))]") == []
        assert all(address.startswith("data:image/svg+xml;base64,") for address in document.xpath("//@src"))
        assert NASTY_NAME in document.xpath("string(//h1)")
        warnings = document.xpath("//h2[text()='Warnings']/following::ul[1]/li")
        assert [each.text_content() for each in warnings] == [symbolic(each).striptags() for each in study.warnings]
        assert "nan" not in document.text_content().replace("resonance", "")


def test_tables_of_a_train_hold_its_parts_and_modes(pages: dict[str, str], train: TrainStudy) -> None:
    text, modes = pages["train"], train.modes
    assert [row[0] for row in table(text, "inertia")] == [each.name for each in train.train.inertias]
    shafts = table(text, "shaft")
    assert [row[0] for row in shafts] == ["drive, ⌀40 × 300 mm", "<out>, ⌀50 × 500 mm", "coupling"]
    # What the shafts carry at rest is what is given on the inertias behind them.
    assert [float(row[5]) for row in shafts] == [300, 400, 200]
    assert [row[6] for row in shafts] == [short(each) for each in train.up.shaft_factors.max(axis=0)]
    rows = table(text, "mode")
    assert rows[0] == ["1, turns as a whole", "0", "0", *["–"] * 4]
    assert [row[1] for row in rows[1:]] == [short(each) for each in modes.frequency[1:]]
    assert [row[3] for row in rows[1:]] == [short(60 * each / 20) for each in modes.frequency[1:]]


def test_resonances_are_named_after_the_natural_frequencies_they_meet(train: TrainStudy) -> None:
    peaks = peak_table(train).rows
    wanted = sum(min(len(train.up.peaks(mesh)), MOST_PEAKS) for mesh in (0, 1))
    assert len(peaks) == wanted > 4
    frequencies = train.modes.frequency
    named = [row for row in peaks if row[1].startswith("f")]
    assert named
    for row in named:
        digits, _, part = row[1].removesuffix(", unstable").removeprefix("f").partition("/")
        mode = int(digits.translate(str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")))
        tooth = float(row[3].replace("\u202f", ""))
        assert tooth * int(part or 1) == pytest.approx(frequencies[mode - 1], rel=0.045)


def test_shapes_are_to_scale_and_jump_at_meshes(train: TrainStudy) -> None:
    modes = train.modes
    panels = [panel for panel in plot_shapes(train.train, modes).axes if panel.get_visible()]
    assert len(panels) == len(modes)
    for mode, panel in enumerate(panels):
        # Eight steps between places where the shape is known.
        shafts = [line for line in panel.lines if len(line.get_xdata()) == 8 * len(modes.places) - 7]
        spans = [abs(float(np.ptp(np.asarray(line.get_xdata())))) for line in shafts]
        # The coupling has no length: that of the mean of the others.
        assert spans == pytest.approx([300.0, 500.0, 400.0])
        largest = max(np.abs(np.asarray(line.get_ydata(), float)).max() for line in panel.lines)
        assert largest == pytest.approx(1.0)
        for line, shape in zip(shafts, modes.shaft_shape[mode], strict=True):
            drawn = np.asarray(line.get_ydata(), float)[::8]
            assert drawn * np.abs(shape).max() == pytest.approx(shape * np.abs(drawn).max(), abs=1e-12)
    # The first mode turns as a whole: wheels half as fast as the pinion, the other way.
    jumps = [np.asarray(line.get_ydata(), float) for line in panels[0].lines if line.get_linestyle() == ":"]
    assert [jump.tolist() for jump in jumps] == [pytest.approx([1.0, -0.5])] * 2


def test_bars_of_energy_fill_up_to_the_whole(train: TrainStudy) -> None:
    kinetic, potential = plot_energies(train.modes).axes
    for axes, rigid in ((kinetic, 100.0), (potential, 0.0)):
        widths = np.zeros(len(train.modes))
        for bars in axes.containers:
            widths += [bar.get_width() for bar in bars]
        assert widths == pytest.approx([rigid] + [100.0] * (len(widths) - 1))


def test_without_shafts_there_are_none_in_the_pictures() -> None:
    study = study_train(two_wheels(TrainModel.ISOLATED), DynamicsOptions(speeds=30, speed_from=2000.0))
    assert study.up.referred_shafts == [] and len(plot_course(study).axes) == 2
    assert {row[-2] for row in shaft_table(study).rows} == {"–"}
    assert len(plot_shapes(study.train, study.modes).axes[0].lines) == 1 + 2 * 3 + 2  # the axis, inertias, and meshes


def test_charts_are_those_of_the_study(train: TrainStudy, pair: PairStudy) -> None:
    drawn = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in plot_factors(train).lines}
    for mesh, name in enumerate("LR"):
        assert drawn[name].tolist() == train.up.factors[:, mesh].tolist()
    overload = {str(line.get_label()): line.get_ydata() for line in plot_shaft_overload(train).lines}
    assert list(overload) == ["drive", "<out>", "coupling"]
    study = pair.study
    assert study.down is not None and study.up.standard is not None
    axes = plot_factors(study)
    drawn = {str(line.get_label()): np.asarray(line.get_ydata(), float) for line in axes.lines}
    assert drawn["this model, running up"].tolist() == study.up.factors[:, 0].tolist()
    assert drawn["this model, running down"].tolist() == study.down.factors[:, 0].tolist()
    assert drawn["ISO 6336-1, Method B"].tolist() == study.up.standard.tolist()
    arrows = [text for text in axes.texts if getattr(text, "arrow_patch", None) is not None]
    assert len(arrows) == sum(map(len, study.jumps)) > 0
    assert axes.get_ylim()[1] > max(study.up.standard.max(), study.up.factors.max(), study.down.factors.max())


def test_second_axis_is_the_tooth_frequency_and_lines_stand_where_it_is_natural(pair: PairStudy) -> None:
    axes = plot_factors(pair.study)
    axes.figure.draw_without_rendering()
    (above,) = axes.child_axes
    assert np.array(above.get_xlim()) == pytest.approx(np.array(axes.get_xlim()) * 19 / 60)
    frequency = pair.study.modes.frequency[1]
    upright = [line.get_xdata()[0] for line in axes.lines if list(line.get_ydata()) == [0, 1]]
    assert upright == [pytest.approx(60 * frequency / 19 / 2), pytest.approx(60 * frequency / 19)][-len(upright) :]


def test_shading_covers_the_unstable_speeds(train: TrainStudy) -> None:
    stable = np.ones(len(train.speeds), bool)
    stable[10:13] = False
    marked = replace(train, up=replace(train.up, stable=stable))
    (patch,) = plot_factors(marked).patches
    left, right = patch.get_x(), patch.get_x() + patch.get_width()  # type: ignore[attr-defined]
    inside = (train.speeds > left) & (train.speeds < right)
    assert np.flatnonzero(inside).tolist() == [10, 11, 12]
    assert plot_factors(replace(train, up=replace(train.up, stable=np.ones(len(stable), bool)))).patches[:] == []


def test_course_is_closed_and_comes_again(train: TrainStudy) -> None:
    course = train.course
    approach, force, torque = plot_course(train).axes
    springs, whole = (each / train.up.static_forces for each in (course.spring_force, course.force))
    assert springs.max(axis=0) == pytest.approx(course.kv, rel=1e-3)
    for lines, values in ((approach.lines, course.approach), (force.lines[:2], springs), (force.lines[2:], whole)):
        for number, line in enumerate(lines[:2]):
            drawn = np.asarray(line.get_ydata(), float)
            assert drawn[: len(values)].tolist() == values[:, number].tolist()
            assert drawn[0] == drawn[-1] and line.get_xdata()[-1] == pytest.approx(3.0)
    assert len(torque.lines) == 3


def test_pair_and_its_cycle(pages: dict[str, str], pair: PairStudy) -> None:
    document = lxml.html.document_fromstring(pages["pair"])
    rows = {row[0].text: [cell.text_content() for cell in row[1:]] for row in document.xpath("//tr[td]")}
    assert rows["moment of inertia"][1:3] == ["2·10⁻⁵", "0.00014"]
    assert rows["mesh stiffness, mean tangent"][1] == short(pair.cycle.tangent_mean)
    assert pair.study.method_b is not None
    assert rows["resonance speed"][1] == short(pair.study.method_b.resonance_speed)
    curve, mean = plot_cycle(pair.cycle).lines
    assert np.asarray(curve.get_ydata()).tolist() == pair.cycle.mesh_stiffness.tolist()
    assert mean.get_ydata()[0] == pair.cycle.tangent_mean


def test_every_speed_of_a_contact_model_has_its_row(pages: dict[str, str], contact: ContactStudy) -> None:
    rows, found = table(pages["contact"], "rpm"), contact.study
    assert [row[0] for row in rows] == [short(speed) for speed in found.speeds]
    assert [row[3] for row in rows] == [short(each) for each in found.greatest_approach]
    assert [row[-1] == "chaotic" for row in rows] == found.chaotic.tolist()
