"""Frames of sheets: fields of ISO 5457, title block of ISO 7200, lists and tables; whatever texts, none leaves its cell."""

import re
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import pytest

from gearcad.core.errors import SpecError
from gearcad.drawing.options import DrawingOptions, Projection, Revision, SheetSize
from gearcad.drawing.placement import Occupied
from gearcad.drawing.shapes import Box, Figure, Pen, Text, has_glyph, text_width
from gearcad.drawing.sheet_frame import Furnished, Furniture, border, inside_frame, notes, title_block, title_values
from gearcad.drawing.sheet_tables import CLOSEST, PartLine, data_table, fit, parts_list, revisions
from gearcad.drawing.sheet_template import VALUES, SheetTemplate
from gearcad.drawing.words import Language, SheetWords

SHIPPED = SheetTemplate.of(None)
SHEETS = [each for each in SheetSize if each is not SheetSize.AUTO]
HOSTILE = (
    "<img src=x onerror=alert(1)>",
    "x" * 500,
    "Ritzelwelle " * 60,
    "Ωμέγα Шестерня 歯車 ترس مسنن ⚙️ 👩‍🔧 é",
    "%%c40 \\P {\\H3x;big}",
    "",
)
_ROUNDING = 1e-6
"""Of sums of lengths in mm."""


@dataclass(frozen=True)
class _Row:
    key: str = "some"
    words: str = "Number of teeth"
    symbol: str = "z_1"
    text: str = "41"
    limits: tuple[str, str] | None = None


def _words(language: Language = Language.ENGLISH) -> SheetWords:
    return SHIPPED.words(language)


def _values(options: DrawingOptions, size: SheetSize = SheetSize.A3, **others: str) -> dict[str, str]:
    own = {"title": "Wheel", "document_type": "Part drawing", "scale": "1:2"} | others
    return title_values(options, _words(options.language), size=size, mass=1.2345, **own)


# ---------------------------------------------------------------------- border


FIELDS = {SheetSize.A0: (24, 16), SheetSize.A1: (16, 12), SheetSize.A2: (12, 8), SheetSize.A3: (8, 6), SheetSize.A4: (4, 6)}
"""Numbers along and letters down of ISO 5457:1999, table 2, for lying sheets and A4 upright."""


@pytest.mark.parametrize("size", SHEETS)
def test_fields_are_those_of_iso_5457(size: SheetSize) -> None:
    texts = [text for text in border(size, SHIPPED.frame).texts]
    names = {text.words for text in texts}
    numbers, letters = ({name for name in names if name.isdigit() is digits} for digits in (True, False))
    assert (len(numbers), len(letters)) == FIELDS[size] and not letters & {"I", "O"}
    width, height = size.size
    top = max((text for text in texts if text.words == "A"), key=lambda text: text.at[1])
    assert top.at[1] > 0.8 * height and min(text.at[0] for text in texts if text.words == "1") < 0.2 * width
    assert sum(text.words == "B" for text in texts) == (1 if size is SheetSize.A4 else 2)


def test_the_frame_of_a3_is_where_iso_5457_has_it() -> None:
    assert inside_frame(SheetSize.A3, SHIPPED.frame) == Box(20, 10, 410, 287)
    figure = border(SheetSize.A3, SHIPPED.frame)
    assert figure.box == Box(0, 0, 420, 297)
    marks = [shape.box for shape in figure.shapes if getattr(shape, "pen", None) is Pen.FRAME]
    assert Box(210, 5, 210, 15) in marks and Box(405, 148.5, 415, 148.5) in marks and len(marks) == 5
    blocked = border(SheetSize.A3, SHIPPED.frame, [Box(230, 10, 410, 200)])
    assert Box(410, 148.5, 415, 148.5) in [shape.box for shape in blocked.shapes]


# ---------------------------------------------------------------------- fitting


def test_texts_get_closer_then_smaller_then_longer_and_only_then_shorter() -> None:
    whole = text_width("Verzahnungsdaten", 3.5)
    assert fit("Verzahnungsdaten", whole, 3.5) == replace(fit("Verzahnungsdaten", 1e3, 3.5), stretch=0.82)
    closer = fit("Verzahnungsdaten", 0.9 * whole, 3.5)
    assert closer.height == 3.5 and closer.stretch == pytest.approx(0.9 * 0.82) and closer.kept is None
    smaller = fit("Verzahnungsdaten", 0.7 * whole, 3.5)
    assert smaller.height == 2.5 and smaller.lines == ("Verzahnungsdaten",)
    two = fit("Responsible department", 20.0, 2.5, depth=7.0)
    assert two.lines == ("Responsible", "department") and two.kept is None
    short = fit("Verzahnungsdaten", 10.0, 3.5)
    assert short.lines[0].endswith("…") and short.kept == len(short.lines[0]) - 1 and short.stretch == CLOSEST
    assert fit("aé" * 40, 20.0, 3.5).lines[0].rstrip("…")[-1] != "e"


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.parametrize("depth", [0.0, 12.0])
def test_no_line_is_longer_than_its_room(text: str, depth: float) -> None:
    for room in (3.0, 17.0, 60.0):
        fitted = fit(text, room, 3.5, depth=depth)
        assert all(text_width(line, fitted.height, fitted.stretch) <= room + _ROUNDING for line in fitted.lines)
        assert fitted.depth <= max(depth, fitted.height) + _ROUNDING
        whole = "".join(fitted.lines).replace(" ", "")
        assert (fitted.kept is None) == (whole == text.replace(" ", ""))


# ---------------------------------------------------------------------- title block


LENGTHS = {
    "number": 16,
    "date": 10,
    "sheet": 4,
    "title": 25,
    "supplementary_title": 25,
    "approver": 20,
    "creator": 20,
    "document_type": 30,
    "revision": 2,
    "language": 4,
    "department": 10,
    "technical_reference": 20,
    "status": 20,
}
"""Characters that ISO 7200:2004, tables 1 to 3, recommends to have room for."""


def test_cells_have_room_for_what_iso_7200_recommends() -> None:
    sample = "Kugghjul 4711-Å 23 m2 z41 ab"  # capitals, small letters and digits as titles have them
    for name, length in LENGTHS.items():
        cell = SHIPPED.cells[name]
        text = ("0123456789" * 2 if name in ("number", "date", "sheet") else sample * 2)[:length]
        fitted = fit(text, cell.width - 2.4, cell.text)
        assert fitted.kept is None and fitted.height >= 2.5, name


def test_cells_fill_the_title_block_and_none_lies_over_another() -> None:
    boxes = [cell.box for cell in SHIPPED.cells.values()]
    assert SHIPPED.title.width == 180.0
    assert sum(box.width * box.height for box in boxes) == SHIPPED.title.width * SHIPPED.title.height
    assert not any(one.meets(other) for one, other in combinations(boxes, 2))


@pytest.mark.parametrize("language", Language)
def test_words_of_all_languages_fit_their_cells(language: Language) -> None:
    words = _words(language)
    for name, cell in SHIPPED.cells.items():
        if f"frame.{name}" in words.labels and cell.caption is None:
            assert fit(words[f"frame.{name}"], cell.width - 2.4, SHIPPED.title.caption, least=1.8).kept is None, name
    assert not parts_list([PartLine(item=1)], SHIPPED, words).notices
    assert not revisions([Revision("A", "x")], SHIPPED, words).notices
    texts = [text for key, text in words.labels.items() if key.startswith("data.") and not key.startswith("data.note_")]
    rows = [_Row(words=re.sub(r"\{(\w+)\}", lambda found: _NAMED.get(found[1], "123"), text), symbol="") for text in texts]
    for sizes in (SHIPPED.data_table, SHIPPED.data_table.narrowed(90.0)):
        for low in (False, True):
            assert not data_table(rows, words["data.title"], sizes, low=low).notices
    kinds = [words[f"frame.document_{kind}"] for kind in ("part", "assembly", "arrangement")]
    cell = SHIPPED.cells["document_type"]
    assert all(fit(kind, cell.width - 2.4, cell.text).height == cell.text for kind in kinds)


_NAMED = {"standard": "ISO 1328-1:1995"}
"""What stands in words of the data table in braces; all else is a number."""


def _inside(figure: Figure, box: Box) -> bool:
    """Whether texts and all stay inside a box, and no text meets another or a line."""
    lines = Occupied(Figure(tuple(shape for shape in figure.shapes if not isinstance(shape, Text))))
    crossed = any(lines.clashes(Figure((text,))) for text in figure.texts if text.height > 2.5)
    return _apart(figure) and not crossed and box.grown(_ROUNDING).holds(figure.box)


def _apart(figure: Figure) -> bool:
    """Whether no text lies over another; parts of a symbol may touch."""
    boxes = [text.box.grown(-_ROUNDING) for text in figure.texts]
    return not any(one.meets(other) for one, other in combinations(boxes, 2))


@pytest.mark.parametrize("text", HOSTILE)
def test_whatever_stands_in_a_cell_stays_in_it(text: str) -> None:
    values = dict.fromkeys(VALUES, text)
    block = title_block(values, SHIPPED, _words(), Projection.FIRST)
    assert _inside(block.figure, Box(-180.0, 0.0, 0.0, SHIPPED.title.height))
    cells = [cell.box.moved(-180.0, 0.0) for cell in SHIPPED.cells.values()]
    assert all(any(cell.holds(each.box) for cell in cells) for each in block.figure.texts)
    shortened = {notice.where for notice in block.notices}
    assert shortened <= {*SHIPPED.cells} and {notice.code for notice in block.notices} <= {"drawing-shortened"}
    assert ({*SHIPPED.cells} - {"projection"} == shortened) is (len(text) >= 500)


def test_a_notice_says_what_was_shortened_and_how_much_has_room() -> None:
    options = DrawingOptions(title="a" * 500, owner="<img src=x onerror=alert(1)>")
    block = title_block(_values(options), SHIPPED, _words(), Projection.FIRST)
    (notice,) = block.notices
    shown = [text.words for text in block.figure.texts if text.words.startswith("aaa")]
    assert str(notice) == f"title: the title block has room for {sum(map(len, shown)) - 1} of its 500 characters"
    assert "<img src=x onerror=alert(1)>" in " ".join(text.words for text in block.figure.texts)


def test_values_are_those_of_the_options_or_of_the_sheet() -> None:
    options = DrawingOptions(number="4711", date="2026-01-31", revisions=(("A", "first"), ("B", "wider")), material="C45")
    values = _values(options, material="16MnCr5", heat_treatment="case hardened")
    assert tuple(values) == VALUES
    expected = {"number": "4711", "date": "2026-01-31", "revision": "B", "title": "Wheel", "material": "C45", "sheet": "1"}
    expected |= {"heat_treatment": "case hardened", "mass": "1.23 kg", "size": "A3", "language": "en"}
    assert values | expected == values
    german, words = DrawingOptions(language=Language.GERMAN), _words(Language.GERMAN)
    for mass, text in {1234.5: "1230 kg", 0.0123: "12,3 g", 0.1: "0,1 kg", 98.76: "98,8 kg", 1e-7: "0,0001 g"}.items():
        made = title_values(german, words, title="", document_type="", size=SheetSize.A4, scale="1:1", mass=mass)
        assert made["mass"] == text


# ---------------------------------------------------------------------- lists and tables


def test_lists_grow_upwards_from_the_title_block() -> None:
    parts = [
        PartLine(item=1, number="4711-1", title="Pinion", material="16MnCr5"),
        PartLine(item=2, quantity=3, title="x" * 300),
    ]
    found = parts_list(parts, SHIPPED, _words())
    up = {text.words: text.at[1] for text in found.figure.texts}
    assert up["Item"] < up["1"] < up["2"] and up["Pinion"] == pytest.approx(up["1"], abs=0.5)
    assert found.box.right == 0.0 and found.box.width == 180.0 and found.box.bottom == 0.0
    assert [notice.where for notice in found.notices] == ["item 2"]
    many = revisions([Revision(str(number), "change", "2026-01-31", "MB") for number in range(20)], SHIPPED, _words())
    shown = {text.words for text in many.figure.texts}
    assert {"12", "19"} <= shown and "11" not in shown
    assert [str(notice) for notice in many.notices] == ["revisions: the table of revisions shows the last 8 of 20"]
    for each in (found, many):
        assert _inside(each.figure, each.box)
    assert parts_list([], SHIPPED, _words()).empty and revisions([], SHIPPED, _words()).empty


@pytest.mark.parametrize("low", [False, True])
def test_rows_of_the_data_table_stay_in_their_cells(low: bool) -> None:
    limits = ("133.912", "133.845")
    rows = [
        _Row(text=text, words=text[:40], symbol="A_sne / A_sni", limits=pair) for text in HOSTILE for pair in (None, limits)
    ]
    for columns in (1, 2, 3):
        table = data_table(rows, "Gear data", SHIPPED.data_table, columns=columns, low=low)
        assert table.box.right == pytest.approx(0.0) and table.box.top == 0.0
        assert table.box.width == pytest.approx(columns * 114.0) and _inside(table.figure, table.box)
    assert {notice.where for notice in table.notices} == {"some"}
    texts = {text.words for text in table.figure.texts}
    assert {*limits} <= texts and "Gear data" in texts


# ---------------------------------------------------------------------- all of it


def _furnished(size: SheetSize, language: Language, rows: int = 26) -> Furnished:
    notes = ("a note that is long " * 12, "short")
    options = DrawingOptions(language=language, number="4711", notes=notes, revisions=(("A", "first"), ("B", "x")))
    words = _words(language)
    furniture = Furniture(
        options=options,
        template=SHIPPED,
        words=words,
        rows=[_Row(limits=("+0.025", "0"))] * rows,
        table_title=words["data.title"],
        notes=("Tip edges of teeth chamfered 0.3×45°",),
        parts=[PartLine(item=1, title="Pinion"), PartLine(item=2, title="Wheel")],
    )
    return furniture.on(size, _values(options, size))


@pytest.mark.parametrize("size", SHEETS)
def test_everything_has_its_place_on_every_sheet(size: SheetSize) -> None:
    frame = inside_frame(size, SHIPPED.frame)
    for language in Language:
        found = _furnished(size, language)
        assert found.figure.box == Box(0, 0, *size.size) and not found.notices
        assert all(frame.grown(_ROUNDING).holds(box) for box in found.taken)
        assert not any(one.meets(other) for one, other in combinations(found.taken, 2))
        assert _apart(found.figure)
        assert found.free.width > 100 and frame.holds(found.free)


def test_a_table_without_room_takes_lower_rows_then_columns_and_at_last_leaves_nothing_free() -> None:
    heights = [_furnished(SheetSize.A3, Language.ENGLISH, rows).taken[1].height for rows in (25, 32, 40)]
    assert heights == pytest.approx([7.5 + 25 * 6.4, 7.5 + 32 * 5.0, 7.5 + 20 * 6.4])
    narrow = _furnished(SheetSize.A4, Language.ENGLISH, 30).taken[1]
    assert (narrow.width, narrow.height) == pytest.approx((180.0, 7.5 + 15 * 5.0))
    assert _furnished(SheetSize.A4, Language.ENGLISH, 80).free.width == 0.0
    assert _furnished(SheetSize.A2, Language.ENGLISH, 60).free.width > 300.0


def test_what_the_title_block_has_is_no_row_of_the_table_too() -> None:
    rows = [_Row(key="teeth", text="41"), _Row(key="material", text="C45"), _Row(key="heat_treatment", text="hardened")]
    options, words = DrawingOptions(date="2026-01-31"), _words()
    furniture = Furniture(options=options, template=SHIPPED, words=words, rows=rows)
    shown = [text.words for text in furniture.on(SheetSize.A3, _values(options, material="C45")).figure.texts]
    assert (shown.count("C45"), shown.count("hardened"), shown.count("41")) == (1, 1, 1)
    bare = replace(SHIPPED, cells={name: cell for name, cell in SHIPPED.cells.items() if name != "material"})
    shown = [text.words for text in replace(furniture, template=bare).on(SheetSize.A3, _values(options)).figure.texts]
    assert shown.count("C45") == 1


# ---------------------------------------------------------------------- a company's template


COMPANY = """
[frame]
grid_width = 0
[title]
caption = 2.0
[title.cells]
owner = { value = "Example AB {department}", text = 2.5 }
status = false
classification = { caption = "Classe", value = "C1" }
[words.frame]
approver = { sv = "Granskad av" }
creator = "Autor"
"""


def test_a_company_changes_what_it_likes(tmp_path: Path) -> None:
    file = tmp_path / "company.toml"
    file.write_text(COMPANY, encoding="utf-8")
    template = SheetTemplate.of(str(file))
    assert template.frame == replace(SHIPPED.frame, grid_width=0.0) and template.data_table == SHIPPED.data_table
    assert {*SHIPPED.cells} - {*template.cells} == {"status"}
    words = template.words(Language.SWEDISH)
    values = {"department": "T1", "classification": "hidden"}
    texts = [text.words for text in title_block(values, template, words, Projection.THIRD).figure.texts]
    assert {"Example AB T1", "Classe", "C1", "Granskad av", "Autor", "Teknisk referens"} <= {*texts} and "hidden" not in texts
    assert template.words(Language.GERMAN)["frame.approver"] == "Genehmigt von"
    assert border(SheetSize.A3, template.frame).texts == []


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("[titel]\nwidth = 3", "company.toml: titel = {'width': 3}: unknown key; did you mean title?"),
        ("[title]\nwidht = 3", "company.toml: title.widht = 3: unknown key; did you mean width?"),
        ("title = 3", "company.toml: title = 3: must be a table"),
        ("[title]\nwidth = 'x'", "company.toml: title.width = 'x': must be a number at least 5 mm and at most 1000 mm"),
        ("[title.cells]\nowner = 3", "company.toml: title.cells.owner = 3: must be a table, or false for none"),
        ("[title.cells]\nowner.widht = 3", "company.toml: title.cells.owner.widht = 3: unknown key; did you mean width?"),
        ("[title.cells]\nnew = { value = 'x' }", "company.toml: title.cells.new.left is missing: must be given, in mm"),
        (
            "[title.cells]\nowner.value = '{ower}'",
            "title.cells.owner.value = '{ower}': unknown in braces: ower; did you mean owner?",
        ),
        ("[title.cells]\nowner.value = 3", "company.toml: title.cells.owner.value = 3: must be a text"),
        ("[title.cells]\nowner.value = 'a\x7f'", "is not valid TOML"),
        (
            '[title.cells]\nowner.value = "a\\u0007"',
            "title.cells.owner.value = 'a\\x07': must be a text without hidden or control characters",
        ),
        ("[title.cells]\nowner.symbol = 'x'", "company.toml: title.cells.owner.symbol = 'x': must be"),
        ("[title.cells]\nowner.width = 60", "must not lie over the cell"),
        ("[title.cells]\nmaterial.height = 60", "must be inside the title block, 180 x 54 mm"),
        ("[revisions]\nmost = 2.5", "company.toml: revisions.most = 2.5: must be a whole number from 1 to 100"),
        ("[words.frame]\nonwer = 'x'", "company.toml: words.frame.onwer = 'x': unknown word; did you mean frame.owner?"),
        ("[words.frame]\nowner = { fr = 'x' }", "words.frame.owner = {'fr': 'x'}: must be a text, or texts for en, de, sv"),
        ("[words.frame]\nowner = 'a{b}'", "words.frame.owner = 'a{b}': unknown in braces: b; permitted: nothing"),
        ("[words.data]\nspan_teeth = 'k {'", "words.data.span_teeth = 'k {': has braces that do not match"),
        ("[frame]\ngrid_width = 12", "company.toml: frame.grid_width = 12 mm: must be at most"),
        ("[frame]\ngrid_text = 7", "company.toml: frame.grid_text = 7 mm: must be at most grid_width, 5"),
        ("[data_table]\ntext = 5", "company.toml: data_table.row = 6.4 mm: must be 2 mm more than text at least"),
        ("[data_table]\nrow = 'x'", "company.toml: data_table.row = 'x': must be a number"),
        (
            "[title.cells]\nowner = { bottom = 22, height = 5 }",
            "title.cells.owner.height = 5 mm: must have room for the caption",
        ),
        ("words = 3", "company.toml: words = 3: must be a table"),
        ("a = ", "company.toml: is not valid TOML: "),
    ],
)
def test_what_is_wrong_in_a_template_is_one_line_with_file_and_key(tmp_path: Path, content: str, message: str) -> None:
    file = tmp_path / "company.toml"
    file.write_text(content, encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        SheetTemplate.of(str(file))
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_a_template_that_cannot_be_read_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe")
    for name, message in (("none.toml", "cannot be read"), ("bytes.toml", "is not valid TOML")):
        with pytest.raises(SpecError, match=rf"{name}: {message}"):
            SheetTemplate.of(str(tmp_path / name))


def test_words_say_the_same_in_all_languages_with_letters_that_the_font_has() -> None:
    english, *others = (SheetWords.of(language).labels for language in Language)
    for labels in others:
        assert labels.keys() == english.keys()
        wrong = [
            key
            for key in english
            if sorted(re.findall(r"\{\w*\}", labels[key])) != sorted(re.findall(r"\{\w*\}", english[key]))
        ]
        assert wrong == []
    for labels in (english, *others):
        assert all(text.strip() == text and text for text in labels.values())
        assert {letter for text in labels.values() for letter in text if not has_glyph(letter)} == set()


def test_notes_stand_on_the_corner_that_they_are_moved_to() -> None:
    """The last note has its baseline at (0, 0), the first is above it; what they hold is not moved by their number."""
    one, two = (notes(["an edge", "a size"][:count], SHIPPED) for count in (1, 2))
    places = [[shape.at for shape in each.figure.shapes if isinstance(shape, Text)] for each in (one, two)]
    assert places[0] == [(0.0, 0.0)]
    assert min(places[1]) == (0.0, 0.0) and max(places[1])[1] > SHIPPED.notes.text
    assert notes([], SHIPPED).empty
