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
    claim_texts,
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

_SUBJECTS, _FILES = (28.0, 90.0, 20.0, 20.0, 20.0), (45.0, 133.0)
_CLAIMS, _SAFETIES = (17.0, 35.0, 44.0, 32.0, 24.0, 26.0), (60.0, 58.0, 20.0, 20.0, 20.0)
"""Widths in mm of the columns of the tables."""

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
        topMargin=margin + 18 * mm,
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
    from reportlab.platypus import Paragraph, Spacer

    from gearcad.drawing.page_export import pdf_font

    plain = ParagraphStyle("plain", fontName=pdf_font(), fontSize=9, leading=12, spaceAfter=4)
    title = ParagraphStyle("title", parent=plain, fontSize=15, leading=19)
    section = ParagraphStyle("section", parent=plain, fontSize=11, leading=14, spaceBefore=10, keepWithNext=1)
    counts = document["counts"]
    yield Paragraph(escape(f"{document['name']}: {_verdict(document)}"), title)
    yield Paragraph(
        f"{counts['passed']} claims passed, {counts['failed']} failed, {counts['not judged']} not judged. Strength: "
        f"{strength_words(document)}. Each claim was judged by something that did not make it.",
        plain,
    )
    yield Paragraph("What was judged, and by whom", section)
    rows = [("claim", "judges", "passed", "failed", "not judged")]
    rows += [(of["name"], of["judges"], *map(str, of["counts"])) for of in judged_subjects(document)]
    yield _table(rows, _SUBJECTS, numbers=(2, 3, 4))
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
    yield Paragraph("Claims", section)
    lines = sorted((claim_texts(claim) for claim in document["claims"]), key=lambda line: line["verdict"] != VERDICTS[False])
    heads = ("claim", "of", "quantity", "deviation / permitted", "judge", "verdict")
    table = [(line["claim"], line["where"], line["quantity"], _share(line), line["judge"], _said(line)) for line in lines]
    yield _table([heads, *table], _CLAIMS)
    if files := list(document["files"].items()):
        yield Paragraph("Files (SHA-256)", section)
        yield _table(files, _FILES, heading=False)
    yield Spacer(1, 2 * mm)


def _verdict(document: Document) -> str:
    return {True: "all claims passed", False: "claims FAILED", None: "nothing was judged"}[document["passed"]]


def _share(line: Mapping[str, str]) -> str:
    """The deviation beside what is permitted, or both values where they differ."""
    if line["deviation"]:
        return f"{line['deviation']} / {line['permitted']} {line['unit']}".strip()
    return " / ".join(dict.fromkeys(filter(None, (line["computed"], line["reference"]))))


def _said(line: Mapping[str, str]) -> str:
    return f"{line['verdict']}: {line['reason']}" if line["reason"] and line["verdict"] != VERDICTS[None] else line["verdict"]


def _table(
    rows: Sequence[Sequence[str]], widths: Sequence[float], *, numbers: Sequence[int] = (), heading: bool = True
) -> Flowable:
    """Return a table with columns of these widths (mm), those of `numbers` with their texts at the right."""
    from reportlab.lib.units import mm
    from reportlab.platypus import Table

    cells = [[_cell(text, width * mm - 2 * _PADDING) for text, width in zip(row, widths, strict=True)] for row in rows]
    style = [*_style(heading=heading), *(("ALIGN", (column, 0), (column, -1), "RIGHT") for column in numbers)]
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


def _style(*, heading: bool) -> list[tuple[Any, ...]]:
    """Letters, lines and spaces of a table."""
    from reportlab.lib.colors import Color

    from gearcad.drawing.page_export import pdf_font

    grey, pale = Color(0.7, 0.7, 0.7), Color(0.94, 0.94, 0.94)
    found: list[tuple[Any, ...]] = [
        ("FONT", (0, 0), (-1, -1), pdf_font(), _SIZE, _LEADING),
        ("LINEBELOW", (0, 0), (-1, -1), 0.3, grey),
        ("VALIGN", (0, 0), (-1, -1), "TOP"),
        ("LEFTPADDING", (0, 0), (-1, -1), _PADDING),
        ("RIGHTPADDING", (0, 0), (-1, -1), _PADDING),
        ("TOPPADDING", (0, 0), (-1, -1), 1.5),
        ("BOTTOMPADDING", (0, 0), (-1, -1), 1.5),
    ]
    return [*found, ("BACKGROUND", (0, 0), (-1, 0), pale)] if heading else found
