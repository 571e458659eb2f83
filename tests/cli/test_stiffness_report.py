"""Report and pictures of the mesh stiffness by several methods: they hold the numbers of the cycles, and nothing else."""

from dataclasses import replace
from pathlib import Path

import lxml.etree
import lxml.html
import numpy as np
import pytest
from support.checks import NASTY_NAME, small_check, small_solid_check

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.check.result import CheckResult
from gearcad.core.errors import GeometryError
from gearcad.core.records import Notice
from gearcad.plots.paper import short
from gearcad.plots.stiffness import plot_load_dependence, plot_parts, plot_parts_of_all, plot_stiffness
from gearcad.report import check as stiffness
from gearcad.report import stiffness_html, write_stiffness_report
from gearcad.stiffness import CLOSED_FORMS, METHODS, StiffnessComparison, compare_methods

_SOFTER = 0.8
"""Of the made-up 3D contact's stiffness to that of the potential energy: a deviation of +25.0 %."""

_REASON = "no <b>reason</b> & more"


def compared(teeth: tuple[int, int] = (18, 31), helix: float = 0.0) -> StiffnessComparison:
    """Closed forms, a "3D contact" made from the potential energy, and a method that is left out."""
    pinion, wheel = (
        Gear(teeth=z, normal_module=2, helix_angle=hand * helix, face_width=12, body=Body(bore=12))
        for z, hand in zip(teeth, (1, -1), strict=True)
    )
    pair = GearPair(pinion=pinion, wheel=wheel)
    found = compare_methods(pair, Material(name=NASTY_NAME), Load(torque=40.0), CLOSED_FORMS)
    energy = found.cycles[0]
    solid = replace(
        energy,
        method="3d",
        mesh_stiffness=_SOFTER * energy.mesh_stiffness,
        compliance_parts={"pinion": 0.5 / energy.mesh_stiffness, "wheel": 0.75 / energy.mesh_stiffness},
        single_stiffness=None,
        notices=(Notice("left-out", "a note with <b>tags</b>"),),
    )
    return replace(found, cycles=(*found.cycles, solid), left_out={"plane-stress": _REASON})


_BETWEEN = 0.03
"""What 12 or 16 even positions miss of the least stiffness."""


@pytest.fixture(scope="module")
def spur() -> StiffnessComparison:
    return compared()


@pytest.fixture(scope="module")
def text(spur: StiffnessComparison) -> str:
    return stiffness_html(spur, NASTY_NAME)


@pytest.fixture(scope="module")
def document(text: str) -> lxml.html.HtmlElement:
    return lxml.html.document_fromstring(text)


def rows(document: lxml.html.HtmlElement) -> dict[str, list[str]]:
    """Cells of the table of methods behind the name, by that name."""
    table = document.xpath("//table[.//th[text()='method, and what it holds']]")[0]
    return {row[0].text: [cell.text_content() for cell in row[1:]] for row in table.xpath("./tbody/tr")}


def test_is_well_formed_and_needs_nothing_from_elsewhere(text: str, document: lxml.html.HtmlElement) -> None:
    root = lxml.etree.fromstring(text.removeprefix("<!DOCTYPE html>").strip().encode())
    assert root.xpath("//figure/@id") == ["pair", "figure-1", "figure-2", "figure-3"]
    assert len(set(root.xpath("//@id"))) == len(root.xpath("//@id")) == len(root.xpath("//figure | //h2"))
    assert document.xpath("//link | //script | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))]") == []
    assert all(address.startswith("data:image/svg+xml;base64,") for address in document.xpath("//@src"))
    assert NASTY_NAME in document.xpath("string(//h1)") and "<b>tags" not in text
    assert document.xpath("//li[text()='FE contact, solid bodies: a note with <b>tags</b>']")


def test_same_comparison_same_bytes(spur: StiffnessComparison, text: str, tmp_path: Path) -> None:
    write_stiffness_report(spur, NASTY_NAME, tmp_path / "stiffness.html")
    assert (tmp_path / "stiffness.html").read_bytes() == text.encode()


def test_table_holds_every_method(spur: StiffnessComparison, document: lxml.html.HtmlElement) -> None:
    energy, weber, standard, solid = spur.cycles
    table = rows(document)
    assert list(table) == [METHODS[cycle.method].title for cycle in spur.cycles]
    figures = ("mean", "maximum", "minimum", "pitch_point", "secant_per_width", "tangent_per_width", "single_stiffness")
    for cycle in (energy, weber):
        assert table[METHODS[cycle.method].title][:-1] == [short(getattr(cycle, name)) for name in figures]
    assert [table[title][-1] for title in table if title != METHODS["3d"].title] == [
        f"{100 * (cycle.mean / solid.mean - 1):+.1f}" for cycle in (energy, weber, standard)
    ]
    assert table["Potential energy"][-1] == "+25.0"
    assert table[METHODS["3d"].title][-2:] == ["–", "–"]
    assert table[METHODS["iso6336"].title][1:4] == ["–", "–", "–"]


def test_without_solid_bodies_there_is_nothing_to_deviate_from(spur: StiffnessComparison) -> None:
    alone = lxml.html.document_fromstring(stiffness_html(replace(spur, cycles=spur.cycles[:3]), "plain"))
    assert {len(cells) for cells in rows(alone).values()} == {7}
    assert "deviation of the mean" not in alone.text_content()


def test_says_what_is_left_out_and_why(document: lxml.html.HtmlElement) -> None:
    (item,) = document.xpath("//h3[text()='Left out']/following::ul[1]/li")
    assert item.text == f"{METHODS['plane-stress'].title}: {_REASON}"


@pytest.mark.parametrize(("teeth", "helix"), [((18, 31), 0.0), ((21, 40), 25.0)])
def test_curves_are_the_cycles_own_points(teeth: tuple[int, int], helix: float) -> None:
    comparison = compared(teeth, helix)
    axes = plot_stiffness(comparison)
    path, pitch = comparison.pair.path_of_contact, comparison.pair.pinion.transverse_base_pitch
    energy, _, standard, _ = comparison.cycles
    (curve,) = [line for line in axes.lines if line.get_label() == "Potential energy"]
    places, values = np.asarray(curve.get_xdata(), float), np.asarray(curve.get_ydata(), float)
    assert places.min() < path.A < path.E < places.max() and (np.diff(places) > -1e-9 * pitch).all()
    assert axes.get_xlim()[0] <= path.A and axes.get_xlim()[1] >= path.E
    drawn = [value for line in axes.lines for value in line.get_ydata() if line.get_transform() == axes.transData]
    assert 0.0 < axes.get_ylim()[0] < min(drawn) < max(drawn) < axes.get_ylim()[1]  # on their own range
    inside = np.flatnonzero((places > path.A + 1e-6) & (places < path.E - 1e-6))
    apart = inside[(np.diff(places)[inside] > 1e-6) & (np.diff(places)[inside - 1] > 1e-6)]
    angles = np.degrees((places[apart] - path.C) / (comparison.pair.pinion.base_diameter / 2))
    assert values[apart] == pytest.approx(energy.stiffness_at(angles), rel=1e-9)
    # A spur pair steps up at A and down at B, without a slope: one place, two values. A helical one comes in bit by bit.
    if helix:
        assert np.abs(np.diff(values)).max() < 0.02 * energy.mean
    else:
        for place, sign in ((path.A, 1), (path.B, -1)):
            before, after = values[np.abs(places - place) < 1e-6]
            assert sign * (after - before) > 0.3 * energy.mean
    level = {str(line.get_label()): line.get_ydata()[0] for line in axes.lines if str(line.get_label()).startswith("ISO")}
    assert list(level.values()) == [standard.mean, standard.tangent_mean]
    assert [text.get_text().strip() for text in axes.texts] == list("ABCDE")


def test_second_axis_is_the_roll_angle(spur: StiffnessComparison) -> None:
    axes = plot_stiffness(spur)
    (above,) = axes.child_axes
    axes.figure.draw_without_rendering()
    path, radius = spur.pair.path_of_contact, spur.pair.pinion.base_diameter / 2
    places = np.array(axes.get_xlim())
    assert above.get_xlim() == pytest.approx(np.degrees((places - path.C) / radius))


def test_parts_lie_on_each_other_up_to_the_whole(spur: StiffnessComparison) -> None:
    assert [cycle.method for cycle in spur.divided] == ["potential-energy", "weber-banaschek", "3d"]
    for cycle in spur.divided:
        top = plot_parts(spur, cycle).lines[len(cycle.compliance_parts) - 1]
        # Every value of the cycle, once for each base pitch drawn.
        assert np.unique(np.round(top.get_ydata(), 12)) == pytest.approx(np.unique(np.round(1 / cycle.mesh_stiffness, 12)))
    figure = plot_parts_of_all(spur)
    shown = [panel for panel in figure.axes if panel.get_visible()]
    assert [panel.get_title(loc="left") for panel in shown] == [METHODS[cycle.method].title for cycle in spur.divided]
    assert len({panel.get_ylim() for panel in shown}) == 1


def test_load_dependence_is_that_of_the_load_points(spur: StiffnessComparison) -> None:
    axes = plot_load_dependence(spur)
    drawn = [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata()), line.get_linestyle()) for line in axes.lines]
    for method in ("weber-banaschek", "iso6336"):
        points = sorted(point for point in spur.load_points if point.method == method)
        assert len(points) > 1
        for name, style in (("mean", "-"), ("tangent_mean", "--")):
            wanted = [getattr(point, name) for point in points]
            found = [x.tolist() for x, y, drawn_style in drawn if drawn_style == style and y.tolist() == wanted]
            assert found == [[point.torque for point in points]]
    # The potential energy knows no load: one level over all torques.
    assert [(x.tolist(), y.tolist()) for x, y, _ in drawn if len(x) == 2] == [([0, 40.0], [spur.cycles[0].mean] * 2)]


@pytest.mark.parametrize("check", [small_check, small_solid_check])
def test_a_check_is_a_method_among_the_others(check: object) -> None:
    checked = check()  # type: ignore[operator]
    assert isinstance(checked, CheckResult)
    # The pair of a check is as mounted: whatever the mounting changes must not be changed again.
    result = replace(checked, task=replace(checked.task, mounting=replace(checked.mounting, centre_distance_change=0.1)))
    found = stiffness.section_of_check(result.stiffness_methods)
    assert isinstance(found, stiffness.StiffnessSection)
    solid = result.model.value == "3d"
    for row, name in zip(found.rows[:-1], CLOSED_FORMS, strict=True):
        cycle = METHODS[name](pair=result.pair, material=result.material, body=result.options.body)(result.load)
        assert (row.title, row.mean) == (METHODS[name].title, short(cycle.mean))
    own = found.rows[-1]
    assert own.title == METHODS["3d" if solid else "plane-strain"].title
    width = result.pair.common_width.width
    # A method has the even positions of the check, which itself looks between them too.
    even, summary = result.cycle.values("stiffness"), result.summary
    for value, wanted, between in (
        (own.mean, even.mean(), summary.mesh_stiffness_mean),
        (own.maximum, even.max(), summary.mesh_stiffness_max),
        (own.minimum, even.min(), summary.mesh_stiffness_min),
    ):
        assert value == short(wanted * width)
        assert wanted == pytest.approx(between, rel=_BETWEEN)
    assert found.referred is solid


def test_a_check_without_other_methods_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    error = GeometryError("pair.usable_contact_ratio", 0.9, "must be at least 1 for a mesh stiffness")

    def fail(*_given: object, **_named: object) -> None:
        raise error

    monkeypatch.setattr("gearcad.check.result.compare_methods", fail)
    methods = replace(small_check()).stiffness_methods  # of a copy that was not asked before
    assert stiffness.section_of_check(methods) == methods.to_dict()["reason"] == str(error)
