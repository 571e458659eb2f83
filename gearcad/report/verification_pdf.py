"""Evidence of a verification on A4 (PDF) with the company's heading: what one sends to a customer."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

from gearcad.core.output import source_date
from gearcad.report.document import symbolic
from gearcad.report.verification import (
    VERDICTS,
    Document,
    claim_groups,
    conclusion_words,
    judged_subjects,
    safety_texts,
    strength_words,
    unjudged_reasons,
)
from gearcad.version import __version__

if TYPE_CHECKING:
    from reportlab.pdfgen.canvas import Canvas
    from reportlab.platypus import Flowable, Paragraph

_MARGIN = 16.0
"""Margin of the page in mm."""

_SIZE, _LEADING, _PADDING = 7.0, 8.5, 2.0
"""Size of the letters in tables, distance of lines, and space beside a text, in points."""

_SUBJECTS, _FILES = (26.0, 87.0, 20.0, 20.0, 20.0), (45.0, 128.0)
_CLAIMS, _SAFETIES = (59.0, 28.0, 28.0, 18.0, 20.0, 20.0), (58.0, 55.0, 18.0, 20.0, 22.0)
"""Widths in mm of the columns of the tables."""

_ROOM = 40.0
"""Height (mm) below which a table begins on the next page."""

_LONGEST = 400
"""Letters of a text in a table: a row must fit on a page."""


def write_verification_pdf(document: Document, head: Mapping[str, str], path: Path) -> None:
    """Write a verification as a PDF of A4 pages with the company's heading.

    The same document and the same date of SOURCE_DATE_EPOCH give the same bytes.
    """
    from reportlab.lib.pagesizes import A4
    from reportlab.lib.units import mm
    from reportlab.platypus import SimpleDocTemplate

    margin = _MARGIN * mm
    paper = SimpleDocTemplate(
        str(path),
        pagesize=A4,
        leftMargin=margin,
        rightMargin=margin,
        topMargin=margin + 8 * mm,
        bottomMargin=margin,
        title=f"{document['name']}: verification",
        author=head.get("author", ""),
        subject="Verification of gear files and figures",
        creator=f"gearcad {__version__}",
        invariant=1 if source_date() is not None else 0,
    )
    furniture = partial(_furniture, document, head)
    paper.build(list(_story(document)), onFirstPage=furniture, onLaterPages=furniture)


def _furniture(document: Document, head: Mapping[str, str], canvas: Canvas, _paper: object) -> None:
    """Draw the heading and the foot of a page."""
    from reportlab.lib.pagesizes import A4
    from reportlab.lib.units import mm

    from gearcad.drawing.page_export import pdf_font

    font, left, right, top = pdf_font(), _MARGIN * mm, A4[0] - _MARGIN * mm, A4[1] - 12 * mm
    canvas.saveState()
    canvas.setFont(font, 11)
    canvas.drawString(left, top, head.get("company", "") or "Verification of gear files and figures")
    canvas.setFont(font, 8)
    canvas.drawRightString(right, top, " · ".join(value for key, value in head.items() if key in ("project", "number")))
    told = " · ".join(f"{key} {value}" for key, value in head.items() if key in ("author", "approved by", "revision", "date"))
    canvas.drawString(left, top - 5 * mm, f"{document['name']}: verification, level {document['level']}")
    canvas.drawRightString(right, top - 5 * mm, told)
    canvas.line(left, top - 8 * mm, right, top - 8 * mm)
    canvas.drawString(left, 9 * mm, f"gearcad {document['gearcad']}")
    canvas.drawRightString(right, 9 * mm, f"page {canvas.getPageNumber()}")
    canvas.restoreState()


def _story(document: Document) -> Iterable[Flowable]:
    """The content of the PDF."""
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.lib.units import mm
    from reportlab.platypus import CondPageBreak, Paragraph, Spacer

    from gearcad.drawing.page_export import pdf_font

    plain = ParagraphStyle("plain", fontName=pdf_font(), fontSize=9, leading=12, spaceAfter=4)
    title = ParagraphStyle("title", parent=plain, fontSize=15, leading=19)
    section = ParagraphStyle("section", parent=plain, fontSize=11, leading=14, spaceBefore=10)
    counts = document["counts"]
    yield Paragraph(escape(f"{document['name']}: {conclusion_words(document)}"), title)
    yield Paragraph(
        f"{counts['passed']} claims passed, {counts['failed']} failed, {counts['not judged']} not judged. Strength: "
        f"{strength_words(document)}. Each claim was judged by something that did not make it.",
        plain,
    )
    yield Paragraph("What was judged, and by whom", section)
    subjects = [(of["name"], of["judges"], *map(str, of["counts"])) for of in judged_subjects(document)]
    yield _table([("claim", "judges", "passed", "failed", "not judged"), *subjects], _SUBJECTS, numbers=(2, 3, 4))
    yield Paragraph(escape("Versions: " + ", ".join(f"{name} {found}" for name, found in document["judges"].items())), plain)
    if safeties := safety_texts(document):
        yield Paragraph("Strength", section)
        yield _table([("mesh", "safety", "value", "minimum", "verdict"), *safeties], _SAFETIES, numbers=(2, 3))
    if reasons := unjudged_reasons(document):
        yield Paragraph("Not judged", section)
        for reason, whats in reasons.items():
            yield Paragraph(f"{symbolic(whats)}: {symbolic(reason)}", plain)
    if document["warnings"]:
        yield Paragraph("Warnings", section)
        for warning in document["warnings"]:
            yield Paragraph(str(symbolic(str(warning))), plain)
    yield CondPageBreak(_ROOM * mm)
    yield Paragraph("Claims", section)
    rows: list[tuple[str, ...]] = [("quantity", "told", "found", "deviation", "permitted", "verdict")]
    groups, reasons_of_failures = list[int](), list[int]()
    for group in claim_groups(document, failed_first=True):
        groups.append(len(rows))
        rows.append((f"{group.subject} · {group.where}, by {group.judge}", *[""] * 5))
        for claim in group.claims:
            rows.append(_row(claim))
            if claim["verdict"] == VERDICTS[False] and claim["reason"]:
                reasons_of_failures.append(len(rows))
                rows.append((claim["reason"], *[""] * 5))
    yield _table(rows, _CLAIMS, numbers=(1, 2, 3, 4), groups=groups, notes=reasons_of_failures)
    if files := list(document["files"].items()):
        yield Paragraph("Files (SHA-256)", section)
        yield _table(files, _FILES, heading=False)
    yield Spacer(1, 2 * mm)


def _row(claim: Mapping[str, str]) -> tuple[str, ...]:
    """A claim as a row of a table."""
    permitted = f"{claim['permitted']} {claim['unit']}" if claim["permitted"] and claim["unit"] else claim["permitted"]
    return claim["quantity"], claim["computed"], claim["reference"], claim["deviation"], permitted, claim["verdict"]


def _table(
    rows: Sequence[Sequence[str]],
    widths: Sequence[float],
    *,
    numbers: Sequence[int] = (),
    groups: Sequence[int] = (),
    notes: Sequence[int] = (),
    heading: bool = True,
) -> Flowable:
    """Return a table with columns of these widths (mm), those of `numbers` with their texts at the right.

    The rows `groups` are headings over all columns, which do not stand last on a page; the rows `notes` are texts over all
    columns about the rows above them. Rows whose last text is a failure, and their notes, are red.
    """
    from reportlab.lib.units import mm
    from reportlab.platypus import Table

    heads, whole = {*groups, *notes}, sum(widths)
    cells = [
        [
            _cell(text, (whole if number in heads else width) * mm - 3 * _PADDING)
            for text, width in zip(row, widths, strict=True)
        ]
        for number, row in enumerate(rows)
    ]
    style = [*_style(heading=heading), *(("ALIGN", (column, 0), (column, -1), "RIGHT") for column in numbers)]
    for row in groups:
        style += [
            ("SPAN", (0, row), (-1, row)),
            ("ALIGN", (0, row), (0, row), "LEFT"),
            ("TOPPADDING", (0, row), (-1, row), 7.0),
            ("NOSPLIT", (0, row), (-1, min(row + 1, len(rows) - 1))),
        ]
    failed = [number for number, row in enumerate(rows) if row[-1] == VERDICTS[False]]
    style += [("TEXTCOLOR", (0, row), (-1, row), _red()) for row in (*failed, *notes)]
    style += [("SPAN", (0, row), (-1, row)) for row in notes]
    style += [("ALIGN", (0, row), (0, row), "LEFT") for row in notes]
    style += [("NOSPLIT", (0, row - 1), (-1, row)) for row in notes]
    return Table(cells, colWidths=[width * mm for width in widths], repeatRows=int(heading), style=style)


def _cell(text: str, width: float) -> str | Paragraph:
    """Return a text in lines of a width (points), or a paragraph where symbols have indices."""
    text = text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
    if "_" in text and "<sub>" in (set_text := str(symbolic(text))):
        return _paragraph(set_text)
    return "\n".join(_lines(text, width))


def _paragraph(text: str) -> Paragraph:
    from reportlab.lib.styles import ParagraphStyle
    from reportlab.platypus import Paragraph

    from gearcad.drawing.page_export import pdf_font

    return Paragraph(text, ParagraphStyle("cell", fontName=pdf_font(), fontSize=_SIZE, leading=_LEADING))


@cache
def _width(text: str) -> float:
    """Width of a word in points."""
    from reportlab.pdfbase.pdfmetrics import stringWidth

    from gearcad.drawing.page_export import pdf_font

    return float(stringWidth(text, pdf_font(), _SIZE))


def _lines(text: str, width: float) -> list[str]:
    """Return a text in lines that are at most so wide (points): broken between words, and within a word that is wider."""
    lines, line = list[str](), ""
    for word in text.split(" "):
        joined = f"{line} {word}" if line else word
        if sum(map(_width, joined)) <= width:
            line = joined
            continue
        lines += [line] if line else []
        line = ""
        for letter in word:
            if sum(map(_width, line + letter)) > width:
                lines.append(line)
                line = ""
            line += letter
    return [*lines, line]


def _red() -> Any:
    from reportlab.lib.colors import Color

    return Color(0.7, 0.22, 0.0)


def _style(*, heading: bool) -> list[tuple[Any, ...]]:
    """Letters, lines and spaces of a table."""
    from reportlab.lib.colors import Color

    from gearcad.drawing.page_export import pdf_font

    grey, pale = Color(0.7, 0.7, 0.7), Color(0.94, 0.94, 0.94)
    found: list[tuple[Any, ...]] = [
        ("FONT", (0, 0), (-1, -1), pdf_font(), _SIZE, _LEADING),
        ("LINEBELOW", (0, 0), (-1, -1), 0.3, grey),
        ("VALIGN", (0, 0), (-1, -1), "TOP"),
        ("LEFTPADDING", (0, 0), (-2, -1), _PADDING),
        ("LEFTPADDING", (-1, 0), (-1, -1), 2 * _PADDING),
        ("RIGHTPADDING", (0, 0), (-1, -1), _PADDING),
        ("TOPPADDING", (0, 0), (-1, -1), 1.5),
        ("BOTTOMPADDING", (0, 0), (-1, -1), 1.5),
    ]
    return [*found, ("BACKGROUND", (0, 0), (-1, 0), pale)] if heading else found
