"""The report of a check of solid bodies: what the plane's has not, and teeth that the page turns by itself."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace

import lxml.etree
import lxml.html
import numpy as np
import pytest
from support.checks import NASTY_NAME, small_solid_check

from gearcad.check.comparison import ComparisonRole
from gearcad.core.records import PerGear, Role
from gearcad.plots.paper import short
from gearcad.report import report_html

_FIGURES, _VIEWS, _PORTRAIT = 14, 2, 1


@pytest.fixture(scope="module")
def text() -> str:
    return report_html(small_solid_check(), NASTY_NAME)


@pytest.fixture(scope="module")
def document(text: str) -> lxml.html.HtmlElement:
    return lxml.html.document_fromstring(text)


def test_is_well_formed_and_needs_nothing_from_elsewhere(text: str, document: lxml.html.HtmlElement) -> None:
    root = lxml.etree.fromstring(text.removeprefix("<!DOCTYPE html>").strip().encode())
    ids = root.xpath("//@id")
    assert len(ids) == len(set(ids)) == len(root.xpath("//figure | //h2"))
    assert document.xpath("//link | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))] | //script/@src") == []
    addresses = document.xpath("//img/@src")
    assert len(addresses) == len(root.xpath("//figure")) == _FIGURES + _VIEWS + _PORTRAIT
    assert all(re.match(r"data:image/(svg\+xml|png);base64,", address) for address in addresses)
    (code,) = document.xpath("//script[not(@type)]")
    assert not re.search(r"https?:|import|fetch|XMLHttpRequest|eval", code.text)
    assert "@import" not in text and "url(" not in text


def test_the_wheel_alone_scrolls_the_page(document: lxml.html.HtmlElement) -> None:
    (code,) = document.xpath("//script[not(@type)]")
    handler = code.text.partition('addEventListener("wheel"')[2]
    condition, _, rest = handler.partition("event.preventDefault()")
    assert "if (!event.ctrlKey && !event.metaKey) return;" in condition and rest


def test_nasty_names_stay_text(document: lxml.html.HtmlElement, text: str) -> None:
    assert NASTY_NAME in document.xpath("string(//h1)")
    assert document.xpath("//li[text()='a warning with <b>tags</b>']")
    assert "<script>alert" not in text


def test_holds_every_comparison(document: lxml.html.HtmlElement) -> None:
    rows = [[cell.text_content() for cell in row] for row in document.xpath("//tr[@class]")]
    wanted = sorted(small_solid_check().comparisons, key=lambda each: each.role is not ComparisonRole.GATE)
    assert [row[:4] for row in rows] == [
        [each.quantity, short(each.computed), short(each.reference), each.unit] for each in wanted
    ]
    failed = [each.quantity for each in wanted if each.role is ComparisonRole.GATE and not each.passed]
    tensions = small_solid_check().summary.root_tension._asdict()
    overloaded = [f"root stress, {gear}" for gear, tension in tensions.items() if tension > 300.0]
    # The pinion's bore of 28 mm leaves a rim of 1.1 tooth depths, which three teeth between held cuts do not bend.
    assert failed == ["discretisation error, mean mesh stiffness", "tooth depth over rim, pinion", *overloaded]


@pytest.mark.parametrize("role", Role)
def test_a_view_holds_the_surface_of_the_tooth(document: lxml.html.HtmlElement, role: Role) -> None:
    figure = PerGear(*document.xpath("//figure[@class='tooth']")).pick(role)
    assert [child.tag for child in figure][:2] == ["canvas", "img"]  # where there is no WebGL the picture stays
    data = json.loads(figure.xpath("./script[@type='application/json']")[0].text)
    surface = small_solid_check().tooth_surfaces.pick(role)

    def unpacked(name: str, kind: str) -> np.ndarray:
        return np.frombuffer(base64.b64decode(data[name], validate=True), kind)

    points = unpacked("points", "<f4").reshape(-1, 3)
    assert points == pytest.approx(surface.points, abs=1e-5)
    assert np.hypot(np.hypot(points[:, 0], points[:, 1]), points[:, 2]).max() == pytest.approx(data["size"], rel=1e-6)
    triangles = unpacked("triangles", {2: "<u2", 4: "<u4"}[data["bytes"]]).reshape(-1, 3)
    assert (triangles == surface.triangles).all()
    stress = unpacked("stress", "u1") / 255 * surface.most
    assert stress == pytest.approx(np.minimum(surface.von_mises, surface.most), abs=surface.most / 500)
    colours = unpacked("colours", "u1").reshape(256, 3)
    legend = re.findall(r"rgb\((\d+), (\d+), (\d+)\)", figure.xpath(".//div[@class='colours']/@style")[0])
    assert [tuple(map(int, colour)) for colour in (legend[0], legend[-1])] == [tuple(colours[0]), tuple(colours[-1])]
    assert figure.xpath(".//div[@class='numbers']/span")[-1].text_content() == f"{short(round(surface.most))} MPa and above"


def test_reasons_tell_width_unevenness_and_the_rest(document: lxml.html.HtmlElement) -> None:
    result = small_solid_check()
    items = document.xpath("//h3[text()='Root stress']/following-sibling::ul[1]/li")
    for gear, item in enumerate(items):
        found, uneven = result.summary.root_tension[gear], result.summary.root_face_load_factor[gear]
        mean, standard = found / uneven, result.rating.root_stresses[gear]
        assert f"= {uneven:.3f} times the mean along the common width, {short(mean)} MPa" in item.text_content()
        assert f"What remains, {100 * (mean / standard - 1):+.1f} %" in item.text_content()
    (lines,) = document.xpath("//h3[text()='Load along the lines of contact']/following-sibling::ul[1]")
    # 10 µm of the mounting, less what 6 µm of the right-hand pinion's steeper helix turn the gap back.
    assert "for Fβy = 4 µm" in lines.text_content()
    assert f"KHβ = {result.summary.face_load_factor:.3f}" in lines.text_content()


@pytest.mark.usefixtures("no_pictures")
def test_backwards_and_without_a_finer_mesh(text: str) -> None:
    result = small_solid_check()
    inside = tuple(each for each in result.comparisons if not each.quantity.startswith("change on"))
    task = replace(result.task, load=replace(result.load, torque=-result.load.torque))
    changed = report_html(replace(result, convergence=(), comparisons=inside, task=task), "plain")
    report = lxml.html.document_fromstring(changed)
    assert report.xpath("//h2[text()='Convergence']") == []
    assert len(report.xpath("//figure")) == _FIGURES + _VIEWS + _PORTRAIT - 1
    mirrored = "loads the right flanks: the model is the mirror image"
    assert mirrored in changed and mirrored not in text
