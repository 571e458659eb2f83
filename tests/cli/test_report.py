"""Reports of plane and solid checks: complete, well-formed, self-contained, the same bytes every time."""

import base64
import json
import platform
import re
from dataclasses import replace
from datetime import date

import lxml.etree
import lxml.html
import numpy as np
import pytest
from support.checks import NASTY_NAME, small_check, small_solid_check

from gearcad import __version__
from gearcad.check.comparison import ComparisonRole
from gearcad.check.explanation import root_at_single_contact
from gearcad.check.result import check_document, reported_document
from gearcad.core.output import json_text
from gearcad.core.records import PerGear, Role
from gearcad.drawing.options import DrawingOptions
from gearcad.plots.paper import short
from gearcad.report import report_html, write_report
from gearcad.report.check import PlaneSections
from gearcad.report.document import heading, symbolic

_PICTURES = 14


@pytest.fixture(scope="module")
def text():
    return report_html(small_check(), NASTY_NAME)


@pytest.fixture(scope="module")
def document(text):
    return lxml.html.document_fromstring(text)


def test_is_well_formed(text):
    # XML is stricter than HTML: every tag is closed, every sign escaped, every id there once.
    root = lxml.etree.fromstring(text.removeprefix("<!DOCTYPE html>").strip().encode())
    assert root.tag == "html"
    ids = root.xpath("//@id")
    assert len(ids) == len(set(ids)) == len(root.xpath("//figure | //h2"))
    assert len(root.xpath("//figure")) == _PICTURES


def test_contents_lead_to_every_section(document):
    """Before the first of them, by anchors that are made of the titles."""
    entries = document.xpath("//nav//a")
    headings = document.xpath("//h2")
    assert [entry.text_content() for entry in entries] == [heading.text_content() for heading in headings]
    assert [entry.get("href") for entry in entries] == [f"#{heading.get('id')}" for heading in headings]
    assert "#section-mesh-stiffness-by-other-methods" in [entry.get("href") for entry in entries]
    assert document.xpath("count(//nav/following::h2)") == len(headings)


def test_narrow_screens_scroll_tables_and_not_the_page(document, text):
    """Chromium at 390 px wide found the page itself 738 px wide before."""
    assert all(table.getparent().get("class") == "scroll" for table in document.xpath("//table"))
    for picture in document.xpath("//figure[starts-with(@id, 'figure')]//img"):
        assert picture.getparent().get("class") == "scroll"
    assert ".scroll { overflow-x: auto; }" in text and "prefers-color-scheme: dark" in text


def said(text):
    """The text as a page shows it: symbols with their letters, their indices lowered."""
    return symbolic(text).striptags()


def test_symbols_have_lowered_indices_and_names_have_none():
    assert symbolic("S_H of the pinion, sigma_H0 <") == "S<sub>H</sub> of the pinion, σ<sub>H0</sub> &lt;"
    assert symbolic("my_gear, sun_1 and [rating] required_safety_flank") == "my_gear, sun_1 and [rating] required_safety_flank"


def test_heading_of_a_drawing_stands_above_the_title(monkeypatch):
    monkeypatch.setattr(PlaneSections, "stiffness", "not wanted here")
    monkeypatch.setattr(PlaneSections, "figures", [])
    drawing = DrawingOptions(
        owner="Gears & <Sons>", technical_reference="Aurora", creator="A. Smith", revision="C", date="2026-01-31"
    )
    head = heading(drawing)
    assert head == {
        "company": "Gears & <Sons>",
        "project": "Aurora",
        "author": "A. Smith",
        "revision": "C",
        "date": "2026-01-31",
    }
    document = lxml.html.document_fromstring(report_html(small_check(), "headed", head))
    spans = [span.text_content() for span in document.xpath("//header/span")]
    assert spans == ["Gears & <Sons>", "project Aurora", "author A. Smith", "revision C", "date 2026-01-31"]
    assert heading(None) == {}
    assert not lxml.html.document_fromstring(report_html(small_check(), "plain")).xpath("//header")


def test_great_and_small_numbers_are_written_alike():
    numbers = {
        623_800_000: "623 800 000",
        1.74e9: "1 740 000 000",
        1234.5: "1234",
        4.2e-5: "4.2·10⁻⁵",
        3e18: "3·10¹⁸",
        0.0: "0",
    }
    assert {value: short(value).replace("\u202f", " ") for value in numbers} == numbers


def test_says_when_and_with_what_it_was_made(monkeypatch):
    monkeypatch.setattr(PlaneSections, "stiffness", "not wanted here")
    monkeypatch.setattr(PlaneSections, "figures", [])
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    document = lxml.html.document_fromstring(report_html(small_check(), "dated"))
    made = document.xpath("string(//footer)").strip()
    assert made.startswith(
        f"Made on 2023-11-14 with gearcad {__version__}, Python {platform.python_version()}, numpy {np.__version__},"
    )
    assert f"gearcad {__version__} · 2023-11-14 · " in document.xpath("string(//p[1])")
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    before = date.today()
    document = lxml.html.document_fromstring(report_html(small_check(), "dated"))
    shown = date.fromisoformat(document.xpath("string(//footer)").split()[2])
    assert before <= shown <= date.today()


def test_nasty_names_stay_text(document, text):
    assert document.xpath("//script") == []
    assert "<script" not in text and "<b>tags" not in text
    assert NASTY_NAME in document.xpath("string(//h1)")
    assert NASTY_NAME in document.xpath("string(//title)")
    assert document.xpath("//li[text()='a warning with <b>tags</b>']")


def test_holds_every_comparison_with_its_verdict_in_words(document):
    rows = [[cell.text_content() for cell in row] for row in document.xpath("//tr[@class]")]
    wanted = sorted(small_check().comparisons, key=lambda each: each.role is not ComparisonRole.GATE)
    assert [row[0] for row in rows] == [said(each.quantity) for each in wanted]
    for row, each in zip(rows, wanted, strict=True):
        assert row[1:4] == [short(each.computed), short(each.reference), each.unit]
        words = ("passed", "NOT PASSED") if each.role is ComparisonRole.GATE else ("in the band", "outside the band")
        assert row[6] == words[not each.passed]
        assert row[7].startswith(said(each.source)) and row[7].endswith(said(each.note))


def test_verdict_comes_first_and_names_what_failed(document):
    verdict = document.xpath("//div[contains(@class, 'verdict')]")[0]
    assert verdict.get("class") == "verdict bad"
    said = "Numerics passed; strength failed; not judged, no limit given: von Mises stress below the flank."
    assert verdict.text_content().strip().startswith(said)
    failed = [each.quantity for each in small_check().comparisons if each.role is ComparisonRole.GATE and not each.passed]
    assert failed == ["contact pressure"]
    assert verdict.xpath(".//ul")[0].text_content().strip().startswith("contact pressure: ")


@pytest.mark.usefixtures("no_pictures")
def test_passes_where_every_gate_does(monkeypatch):
    monkeypatch.setattr(PlaneSections, "stiffness", "pairs like <this> have none")
    inside = tuple(each for each in small_check().comparisons if each.quantity != "contact pressure")
    document = lxml.html.document_fromstring(report_html(replace(small_check(), comparisons=inside), "unjudged"))
    verdict = document.xpath("//div")[0]
    assert verdict.get("class") == "verdict bad"  # local limits replace no endurance limit
    assert verdict.text_content().strip().startswith("Numerics passed; strength not judged: σHlim is not known")
    assert "gates are passed at" in verdict.text_content()
    # Other methods can fail where the check does not.
    assert document.xpath("//p[text()='There are none for this pair: pairs like <this> have none']")
    assert len(document.xpath("//figure")) == _PICTURES - 1


def test_needs_nothing_from_elsewhere(document, text):
    assert document.xpath("//link | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))]") == []
    addresses = document.xpath("//@src")
    assert len(addresses) == _PICTURES
    for address in addresses:
        head, _, data = address.partition(";base64,")
        content = base64.b64decode(data, validate=True)
        if head == "data:image/svg+xml":
            lxml.etree.fromstring(content)
            assert not re.search(rb"(href|src)=\"(?!#)", content)
        else:
            assert head == "data:image/png" and content.startswith(b"\x89PNG")
    assert "@import" not in text and "url(" not in text


def test_same_result_same_bytes(tmp_path, text):
    path = tmp_path / "report.html"
    write_report(small_check(), NASTY_NAME, path)
    assert path.read_bytes() == text.encode()
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]


def test_says_how_the_bodies_are_held(document):
    for gear, body in small_check().bodies.items():
        assert document.xpath(f"//tr[td[1]='{gear}' and td[2]='{body}']")


def test_holds_the_rating_under_its_symbols(document):
    rating = small_check().rating.to_dict()
    (row,) = document.xpath("//tr[td[2]='YF' and td[2]/sub='F']")
    assert [cell.text for cell in row][2:4] == [f"{rating[gear]['Y_F']:.6g}" for gear in ("pinion", "wheel")]
    (row,) = document.xpath("//tr[td[2]='ZH']")
    assert row[2].text == f"{rating['Z_H']:.6g}"


def test_reasons_separate_sharing_width_and_fillet(document):
    result = small_check()
    pinion, wheel = (item.text_content() for item in document.xpath("//h3[text()='Root stress']/following-sibling::ul[1]/li"))
    for role, reason in PerGear(pinion, wheel).items():
        alone, found = root_at_single_contact(result.cycle, role), result.summary.root_tension.pick(role)
        assert f"finite elements have {short(alone)} MPa" in reason
        assert f"sharing the load makes {100 * (found / alone - 1):+.1f} %" in reason
    # Only the pinion is wider than the common width.
    assert "ISO spreads the load over b = 16 mm of the pinion" in pinion
    assert "ISO spreads" not in wheel


def test_check_json_holds_what_the_report_says(document):
    result = small_check()
    plain, reported = check_document(result), reported_document(result)
    assert set(reported) - set(plain) == {"stiffness_methods"}
    json_text(reported)  # strict: no NaN, no Infinity, nothing but plain values
    pinion = reported["explanations"]["root_stress"]["pinion"]
    (reason, _) = (item.text_content() for item in document.xpath("//h3[text()='Root stress']/following-sibling::ul[1]/li"))
    assert f"Loaded like that, the finite elements have {short(pinion['single_contact'])} MPa" in reason
    assert f"at {pinion['outer_point']} a pair carries {100 * pinion['load_share']:.0f} %" in reason
    captions = document.xpath("string(//figcaption[contains(., 'Pressure over torque')])")
    assert f"to the power {reported['torque_trends']['contact_pressure_exponent']:.2f}:" in captions
    means = [f"{short(method['mean'])}" for method in reported["stiffness_methods"]["methods"].values()]
    table = document.xpath("//h2[text()='Mesh stiffness by other methods']/following::table[1]//tr/td[2]")
    assert [cell.text for cell in table] == means
    assert reported["notices"] == [{"code": "test", "where": "", "text": reported["warnings"][0]}]


@pytest.mark.usefixtures("no_pictures")
def test_a_single_torque_shows_no_trend(monkeypatch):
    monkeypatch.setattr(PlaneSections, "stiffness", "not wanted here")
    captions = report_html(replace(small_check(), sweep=small_check().sweep[:1]), "one")
    assert "Only 302 N·m was asked for" in captions
    assert "to the power" not in captions


_FIGURES, _VIEWS, _PORTRAIT = 14, 2, 1


@pytest.fixture(scope="module")
def solid_text() -> str:
    return report_html(small_solid_check(), NASTY_NAME)


@pytest.fixture(scope="module")
def solid_document(solid_text: str) -> lxml.html.HtmlElement:
    return lxml.html.document_fromstring(solid_text)


def test_is_well_formed_and_needs_nothing_from_elsewhere(solid_text: str, solid_document: lxml.html.HtmlElement) -> None:
    root = lxml.etree.fromstring(solid_text.removeprefix("<!DOCTYPE html>").strip().encode())
    ids = root.xpath("//@id")
    assert len(ids) == len(set(ids)) == len(root.xpath("//figure | //h2"))
    assert (
        solid_document.xpath("//link | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))] | //script/@src") == []
    )
    addresses = solid_document.xpath("//img/@src")
    assert len(addresses) == len(root.xpath("//figure")) == _FIGURES + _VIEWS + _PORTRAIT
    assert all(re.match(r"data:image/(svg\+xml|png);base64,", address) for address in addresses)
    (code,) = solid_document.xpath("//script[not(@type)]")
    assert not re.search(r"https?:|import|fetch|XMLHttpRequest|eval", code.text)
    assert "@import" not in solid_text and "url(" not in solid_text


def test_the_wheel_alone_scrolls_the_page(solid_document: lxml.html.HtmlElement) -> None:
    (code,) = solid_document.xpath("//script[not(@type)]")
    handler = code.text.partition('addEventListener("wheel"')[2]
    condition, _, rest = handler.partition("event.preventDefault()")
    assert "if (!event.ctrlKey && !event.metaKey) return;" in condition and rest


def test_solid_nasty_names_stay_text(solid_document: lxml.html.HtmlElement, solid_text: str) -> None:
    assert NASTY_NAME in solid_document.xpath("string(//h1)")
    assert solid_document.xpath("//li[text()='a warning with <b>tags</b>']")
    assert "<script>alert" not in solid_text


def test_holds_every_comparison(solid_document: lxml.html.HtmlElement) -> None:
    rows = [[cell.text_content() for cell in row] for row in solid_document.xpath("//tr[@class]")]
    wanted = sorted(small_solid_check().comparisons, key=lambda each: each.role is not ComparisonRole.GATE)
    assert [row[:4] for row in rows] == [
        [said(each.quantity), short(each.computed), short(each.reference), each.unit] for each in wanted
    ]
    failed = [each.quantity for each in wanted if each.role is ComparisonRole.GATE and not each.passed]
    tensions = small_solid_check().summary.root_tension._asdict()
    overloaded = [f"root stress, {gear}" for gear, tension in tensions.items() if tension > 300.0]
    # The pinion's bore of 28 mm leaves a rim of 1.1 tooth depths, which three teeth between held cuts do not bend.
    assert failed == ["discretisation error, mean mesh stiffness", "tooth depth over rim, pinion", *overloaded]


@pytest.mark.parametrize("role", Role)
def test_a_view_holds_the_surface_of_the_tooth(solid_document: lxml.html.HtmlElement, role: Role) -> None:
    figure = PerGear(*solid_document.xpath("//figure[@class='tooth']")).pick(role)
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


def test_reasons_tell_width_unevenness_and_the_rest(solid_document: lxml.html.HtmlElement) -> None:
    result = small_solid_check()
    items = solid_document.xpath("//h3[text()='Root stress']/following-sibling::ul[1]/li")
    for gear, item in enumerate(items):
        found, uneven = result.summary.root_tension[gear], result.summary.root_face_load_factor[gear]
        mean, standard = found / uneven, result.rating.root_stresses[gear]
        assert f"= {uneven:.3f} times the mean along the common width, {short(mean)} MPa" in item.text_content()
        assert f"What remains, {100 * (mean / standard - 1):+.1f} %" in item.text_content()
    (lines,) = solid_document.xpath("//h3[text()='Load along the lines of contact']/following-sibling::ul[1]")
    # 10 µm of the mounting, less what 6 µm of the right-hand pinion's steeper helix turn the gap back.
    assert "for Fβy = 4 µm" in lines.text_content()
    assert f"KHβ = {result.summary.face_load_factor:.3f}" in lines.text_content()


@pytest.mark.usefixtures("no_pictures")
def test_backwards_and_without_a_finer_mesh(solid_text: str) -> None:
    result = small_solid_check()
    inside = tuple(each for each in result.comparisons if not each.quantity.startswith("change on"))
    task = replace(result.task, load=replace(result.load, torque=-result.load.torque))
    changed = report_html(replace(result, convergence=(), comparisons=inside, task=task), "plain")
    report = lxml.html.document_fromstring(changed)
    assert report.xpath("//h2[text()='Convergence']") == []
    assert len(report.xpath("//figure")) == _FIGURES + _VIEWS + _PORTRAIT - 1
    mirrored = "loads the right flanks: the model is the mirror image"
    assert mirrored in changed and mirrored not in solid_text
