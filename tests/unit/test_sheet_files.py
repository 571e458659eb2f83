"""Files of sheets: what other programs find in them is what was put on paper."""

import base64
import re
import zlib
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import ezdxf
import numpy as np
import pytest
from support.written_sheet import read_sheet

from gearcad.core.dxf import write_document as write_dxf
from gearcad.drawing.drawing_symbols import centre_cross
from gearcad.drawing.dxf_export import sheet_document
from gearcad.drawing.page_export import Stroked, hatch_lines, set_letters, unshown, write_pdf, write_svg
from gearcad.drawing.shapes import (
    Anchor,
    Arc,
    Circle,
    Dimension,
    Figure,
    Filled,
    Hatching,
    Line,
    MeasuredDistance,
    Pen,
    Polyline,
    Text,
)
from gearcad.drawing.words import Language

SIZE = (420.0, 297.0)
FRAME = Polyline.straight([(20, 10), (410, 10), (410, 287), (20, 287)], Pen.FRAME, closed=True)
SQUARE = ((100.0, 100.0, 0.0), (140.0, 100.0, 0.0), (140.0, 130.0, 0.0), (100.0, 130.0, 0.0))
HOSTILE = '<img src=x onerror=alert(1)> & "q" 50%%c 90 % ^J \\U+0041 \\M+18140 \\U+005C'


def _dimension(words: str = "<> h11") -> Dimension:
    """40 mm on paper, of 80 mm of a part at 1:2."""
    parts = (
        Line((100, 90), (140, 90), Pen.DIMENSION),
        Filled(((100, 90), (103, 90.4), (103, 89.6)), Pen.DIMENSION),
        Filled(((140, 90), (137, 90.4), (137, 89.6)), Pen.DIMENSION),
        Text("80 h11", (120, 91), anchor=Anchor.CENTRE),
    )
    return Dimension(MeasuredDistance.HORIZONTAL, (100, 100), (140, 100), (120, 90), words, parts)


def _figure(*more: object) -> Figure:
    circle = Circle((250, 180), 65.0)
    return Figure.of(FRAME, circle, Polyline(SQUARE, closed=True), Hatching((SQUARE,)), _dimension(), *more)  # type: ignore[arg-type]


def _written(figure: Figure, folder: Path) -> Path:
    document = sheet_document(figure, SIZE, 0.5, title=f"Wheel {HOSTILE}", language=Language.GERMAN)
    for write, name in ((write_dxf, "sheet.dxf"), (write_svg, "sheet.svg")):
        write(document, folder / name)
    write_pdf([document, document], folder / "sheet.pdf")
    return folder / "sheet.dxf"


def test_dxf_is_a_drawing(tmp_path: Path) -> None:
    """Paper, layers with widths, line types in mm, and dimensions that a program draws anew with the part's sizes."""
    path = _written(_figure(Text(HOSTILE, (200, 50)), Line((150, 180), (350, 180), Pen.CENTRE)), tmp_path)
    document, sheet = ezdxf.readfile(path), read_sheet(path)
    assert sheet.faults == []
    assert sheet.size == SIZE and sheet.frame == (20, 10, 410, 287)
    assert document.header["$EXTMAX"][:2] == document.header["$LIMMAX"][:2] == SIZE
    assert {layer.dxf.name: layer.dxf.lineweight for layer in document.layers if layer.dxf.name != "0"} == {
        pen.value: round(100 * pen.stroke.width) for pen in Pen
    } | {"Defpoints": -3}
    assert document.linetypes.get("CENTER").pattern_tags.tags[2:] and not document.audit().has_errors
    assert sheet.dimensions == [(80.0, "<> h11", "80 h11")]
    (dimension,) = document.modelspace().query("DIMENSION")
    assert HOSTILE in sheet.words
    dimension.render()  # anew, by the library
    (block,) = [each for each in document.blocks if each.name == dimension.dxf.geometry]
    assert [each.plain_text() for each in block.query("MTEXT")] == ["80 h11"]


@pytest.mark.parametrize(("measured", "place"), [(10.0, 5.0), (10.0, 24.0), (13.0, 6.5), (20.0, 10.0), (60.0, 75.0)])
@pytest.mark.parametrize("upright", [False, True])
def test_a_dimension_drawn_anew_keeps_its_text(tmp_path: Path, upright: bool, measured: float, place: float) -> None:
    """LibreCAD 2.2 centres the text on its point, and moves it aside by half of both lengths if it is the longer one."""

    def at(along: float, out: float) -> tuple[float, float]:
        return (100 - out, 100 + along) if upright else (100 + along, 100 + out)

    text = Text("80 h11", at(place, 11.0), anchor=Anchor.CENTRE, rotation=90.0 * upright)
    kind = MeasuredDistance.VERTICAL if upright else MeasuredDistance.HORIZONTAL
    shape = Dimension(kind, at(0.0, 0.0), at(measured, 0.0), at(place, 10.0), "<> h11", (text,), scale=measured / 80)
    path = _written(Figure.of(FRAME, shape), tmp_path)
    assert "80 h11" in read_sheet(path).words
    for written in ezdxf.readfile(path).modelspace().query("DIMENSION"):
        middle, width = written.dxf.text_midpoint[upright] - 100, 1.25 * text.width
        pushed = (width + measured) / 2 if width > measured else 0.0
        assert middle + pushed == pytest.approx(place, abs=0.5)
        assert 0.0 < middle < measured
    assert bool(ezdxf.readfile(path).modelspace().query("DIMENSION")) is (measured == 20.0)


def test_a_dimension_of_a_detail_measures_at_the_scale_of_the_detail(tmp_path: Path) -> None:
    detail = replace(_dimension("<>"), scale=5.0)
    (written,) = ezdxf.readfile(_written(Figure.of(FRAME, detail), tmp_path)).modelspace().query("DIMENSION")
    assert written.override().get("dimlfac") == pytest.approx(1 / 5)
    assert written.dxf.actual_measurement == pytest.approx(8.0)


@pytest.mark.parametrize(
    ("shape", "fault"),
    [
        (Text("on a line", (60, 99.0)), None),
        (Text("on a line", (95, 99.0)), "meets a line of OUTLINE"),
        (Text("hatched", (110, 110)), "is on a hatched area"),
        (Text("over", (115, 91)), "'80 h11' meets 'over'"),
        (Text("leaves", (405, 40)), "leaves the frame"),
        (Text("upwards", (18, 40), rotation=90.0), "leaves the frame"),
        (Line((10, 40), (40, 40)), "a line of OUTLINE leaves the frame"),
        (Text("round", (314, 180)), "meets a line of OUTLINE"),
        (
            Figure.of(Line((30, 40), (80, 40), Pen.CENTRE), Line((60, 20), (60, 60), Pen.CENTRE)),
            "cross without dashes at 60, 40",
        ),
        (Figure.of(Line((30, 40), (80, 40), Pen.CENTRE), Line((90, 40), (60, 40), Pen.CENTRE)), "is drawn twice at 30, 40"),
        (centre_cross((60, 40), 20), None),
        (replace(_dimension(), second=(140.3, 100)).moved(0, 60), "'80 h11' measures 80.6000 mm"),
    ],
)
def test_checker_sees_faults(shape: object, fault: str | None, tmp_path: Path) -> None:
    found = read_sheet(_written(_figure(shape), tmp_path)).faults
    assert not found if fault is None else any(fault in each for each in found)


@pytest.mark.parametrize("anchor", Anchor)
@pytest.mark.parametrize("rotation", [0.0, 90.0])
def test_checker_finds_texts_where_they_were_put(anchor: Anchor, rotation: float, tmp_path: Path) -> None:
    """Its lengths are matplotlib's, ours those of the font's tables."""
    text = Text("⌀64 Wheel", (200, 100), 5, anchor, rotation)
    (found,) = read_sheet(_written(Figure.of(FRAME, text), tmp_path)).texts
    box, ink = text.box, np.concatenate([found.corners.min(axis=0), found.corners.max(axis=0)])
    assert ink == pytest.approx(box, abs=0.8)
    assert (ink[:2] > np.array(box[:2]) - 0.05).all() and (ink[2:] < np.array(box[2:]) + 0.05).all()


def test_equal_sheets_give_equal_bytes(tmp_path: Path) -> None:
    folders = [tmp_path / name for name in ("one", "two")]
    for folder in folders:
        folder.mkdir()
        _written(_figure(Text("Ä 齿", (200, 50))), folder)
    for name in ("sheet.dxf", "sheet.svg", "sheet.pdf"):
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes()


def test_large_sheets_have_wider_lines(tmp_path: Path) -> None:
    """Group 0.7 of ISO 128-2 from A1 on, 0.5 up to A2; the frame is 0.7 on all (ISO 5457)."""
    found = {}
    for size in ((594.0, 420.0), (841.0, 594.0)):
        document = sheet_document(_figure(), size, 1.0, title="")
        write_svg(document, tmp_path / "large.svg")
        write_pdf([document], tmp_path / "large.pdf")
        page = _pages((tmp_path / "large.pdf").read_bytes())[0]
        found[size] = {float(width) for width in re.findall(r"([\d.]+) w\b", page)} - {1.0}
        drawn = re.findall(r'stroke-width="([\d.]+)"', (tmp_path / "large.svg").read_text(encoding="utf-8"))
        assert found[size] <= set(map(float, drawn))
    assert list(found.values()) == [{0.7, 0.5, 0.25, 0.18}, {0.7, 0.35, 0.25}]


def test_pdf_is_the_paper_and_its_circle_is_round(tmp_path: Path) -> None:
    _written(_figure(), tmp_path)
    content = (tmp_path / "sheet.pdf").read_bytes()
    boxes = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", content)
    page = _pages(content)[0]
    assert {float(width) for width in re.findall(r"([\d.]+) w\b", page)} - {1.0} == {0.7, 0.5, 0.25, 0.18}  # of a page in mm
    assert f"{72 / 25.4:.6f} 0 0 {72 / 25.4:.6f} 0 0 cm" in page
    assert np.array(boxes, dtype=float) * 25.4 / 72 == pytest.approx(np.array([SIZE, SIZE]), abs=1e-4)
    curves = _curves(page)
    assert np.hypot(*(curves - (250, 180)).T) == pytest.approx(65.0, abs=1e-3)
    assert len(curves) == 9 * 8


def _pages(content: bytes) -> list[str]:
    """What draws each page: the streams in letters, as the library packs them."""
    streams = re.findall(rb"/ASCII85Decode.*?stream\r?\n(.*?)~>", content, re.DOTALL)
    return [zlib.decompress(base64.a85decode(stream)).decode("latin1") for stream in streams]


def _curves(page: str) -> np.ndarray:
    """Points along all Bezier curves of a page (mm)."""
    numbers = r"(-?[\d.]+) (-?[\d.]+)"
    steps = re.finditer(rf"{numbers} [ml]|{numbers} {numbers} {numbers} c\b", page)
    share, found, at = np.linspace(0, 1, 9)[:, None], [], np.zeros(2)
    for step in steps:
        row = np.array([each for each in step.groups() if each is not None], dtype=float).reshape(-1, 2)
        if len(row) == 3:
            weights = np.hstack([(1 - share) ** 3, 3 * share * (1 - share) ** 2, 3 * share**2 * (1 - share), share**3])
            found.append(weights @ np.vstack([at, row]))
        at = row[-1]
    return np.concatenate(found)


def test_svg_is_xml_of_the_paper(tmp_path: Path) -> None:
    _written(_figure(Text(HOSTILE, (200, 50)), Text("a\nb\x00\ud800", (200, 40))), tmp_path)
    root = ElementTree.fromstring((tmp_path / "sheet.svg").read_text(encoding="utf-8"))
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("420mm", "297mm", "0 0 420 297")
    texts = {each.text: each for each in root.iter("{http://www.w3.org/2000/svg}text")}
    assert {HOSTILE, "a b \N{REPLACEMENT CHARACTER}"} <= texts.keys()
    length = float(texts[HOSTILE].get("textLength", ""))
    assert 0.82 * length == pytest.approx(Text(HOSTILE, (0, 0)).width, abs=2e-3)


def test_svg_has_all_where_the_dxf_has_it(tmp_path: Path) -> None:
    """Its y is downwards: circles, the way round of arcs, and where texts begin and which way they run."""
    more = Arc((60, 200), 20.0, 30.0, 300.0), Text("Ø 12", (200, 60), 3.5, Anchor.CENTRE, 90.0)
    dxf = ezdxf.readfile(_written(_figure(*more), tmp_path)).modelspace()
    root = ElementTree.fromstring((tmp_path / "sheet.svg").read_text(encoding="utf-8"))
    steps = r"M(\S+) (\S+)A(\S+) \S+ 0 (\d) (\d) (\S+) (\S+)A\S+ \S+ 0 \d \d (\S+) (\S+?)Z?"
    found = [re.fullmatch(steps, path.get("d", "")) for path in root.iter("{http://www.w3.org/2000/svg}path")]
    circle, arc = sorted(([float(each) for each in one.groups()] for one in found if one), key=lambda each: -each[2])
    (round_one,), (open_one,) = dxf.query("CIRCLE"), dxf.query("ARC")
    (x, y), radius = round_one.dxf.center.vec2, round_one.dxf.radius
    assert circle[:3] == pytest.approx([x + radius, SIZE[1] - y, radius]) and circle[5:7] == pytest.approx(
        [x - radius, SIZE[1] - y]
    )
    start, end = ([each.x, SIZE[1] - each.y] for each in (open_one.start_point, open_one.end_point))
    angle = np.radians((open_one.dxf.start_angle + open_one.dxf.end_angle) / 2)
    middle = [60 + 20 * np.cos(angle), SIZE[1] - 200 - 20 * np.sin(angle)]
    assert arc[:2] + arc[5:9] == pytest.approx([*start, *middle, *end], abs=1e-3)
    assert arc[3:5] == [0, 0]  # less than a half turn each, and counter-clockwise as one sees it
    (text,) = (each for each in root.iter("{http://www.w3.org/2000/svg}text") if each.text == "Ø 12")
    a, b, c, d, e, f = map(float, text.get("transform", "")[7:-1].split())
    (seen,) = (each for each in read_sheet(tmp_path / "sheet.dxf").texts if each.words == "Ø 12")
    low, high = seen.corners.min(axis=0), seen.corners.max(axis=0)
    assert (a, d) == (0, 0) and b < 0 < c
    assert (e, SIZE[1] - f) == pytest.approx((high[0], low[1]), abs=0.4)  # on its line, but for what a letter has beside it


def test_hatch_fills_what_is_between_edges() -> None:
    """Its lines are as long in all as the area over their distance; none is in the hole, corners on a line included."""
    hole = ((110.0, 110.0, 0.0), (120.0, 110.0, 0.0), (120.0, 120.0, 0.0), (110.0, 120.0, 0.0))
    for angle in (45.0, 135.0, 0.0, 90.0):
        lines = np.array(list(hatch_lines((SQUARE, hole), angle, 0.1)))
        lengths = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
        assert lengths.sum() * 0.1 == pytest.approx(40 * 30 - 10 * 10, rel=0.01)
        middle = lines.mean(axis=1)
        assert not ((middle > 110.01) & (middle < 119.99)).all(axis=1).any()


def test_letters_of_other_scripts_are_told() -> None:
    """Hebrew stands from right to left, its number not; Arabic letters are joined; what no font has is a box."""
    assert set_letters("Rad שלום 12 גל!") == "Rad לג 12 םולש!"
    assert set_letters("سن") == "\ufee6\ufeb3"
    assert set_letters("齿轮 ギア") == "□□ □□"
    (notice,) = unshown(Figure.of(Text("Zahnrad 齿轮 🦄", (0, 0))))
    assert notice.code == "letters-not-shown" and notice.text.endswith(": 轮齿🦄")


def test_all_fonts_of_a_pdf_are_in_it(tmp_path: Path) -> None:
    _written(_figure(Text("齿轮 ギア 기어", (200, 50))), tmp_path)
    written = (tmp_path / "sheet.pdf").read_bytes()
    fonts = re.findall(rb"/BaseFont /(\S+)", written)
    assert fonts and all(re.fullmatch(rb"[A-Z]{6}\+DejaVuSans\S*", each) for each in fonts)  # a subset
    assert written.count(b"/FontFile2") == len(re.findall(rb"/FontDescriptor ", written)) > 0


def test_short_hidden_edges_are_seen_to_be_dashed() -> None:
    """The ends of a tooth behind another are of a few millimetres."""
    width, dashes = Pen.HIDDEN.stroke
    assert (width, dashes) == (0.25, (3.0, 0.75))  # ISO 128-2: 12 and 3 widths
    assert Stroked(((0, 0, 0), (5, 0, 0)), False, Pen.HIDDEN).dashes
