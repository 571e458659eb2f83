"""Evidence of verifications: a page and a PDF of each, an index of a table's, and JUnit XML for test servers.

All are made of the documents (verify.json), so that the rows of a table need not be in memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree
from xml.sax.saxutils import escape

from gearcad.core.output import source_date
from gearcad.geometry import Gear, GearPair
from gearcad.plots.gears import pair_inches, plot_gear, plot_pair
from gearcad.report.document import ReportFigure, page_html, picture_address
from gearcad.verification.baseline import MovedFigure
from gearcad.version import __version__

if TYPE_CHECKING:
    from reportlab.pdfgen.canvas import Canvas
    from reportlab.platypus import Flowable

Document = Mapping[str, Any]
"""Content of a verify.json."""

_WORDS = {True: "passed", False: "FAILED", None: "not judged"}


def _strength(document: Document) -> str:
    """Return the verdict on strength in words; at level files no claim needs it."""
    return "not part of level files" if document["level"] == "files" else _WORDS[document["strength"]]


def verification_html(document: Document, head: Mapping[str, str], subject: Gear | GearPair | None = None) -> str:
    """Return the page of a verification: verdict, what was judged by whom, a picture of a gear or pair, all claims."""
    return page_html(
        "verify.html",
        str(document["name"]),
        of=document,
        strength=_strength(document),
        head=head,
        subjects=_subjects(document),
        failed=[_line(claim) for claim in document["claims"] if claim["passed"] is False],
        not_judged=_reasons(document),
        claims=[_line(claim) for claim in document["claims"]],
        picture_of_design=None if subject is None else _picture(subject),
    )


def _picture(subject: Gear | GearPair) -> ReportFigure:
    if isinstance(subject, Gear):
        address = picture_address(partial(plot_gear, subject), "svg")
        return ReportFigure("The gear", address, "Section of the gear, and its circles.")
    address = picture_address(partial(plot_pair, subject), "svg", pair_inches(subject))
    return ReportFigure("The pair in mesh", address, "Both gears as the files have them.")


def _subjects(document: Document) -> list[dict[str, Any]]:
    """Return each subject that was judged, with its judges, its counts and the time."""
    found: dict[str, dict[str, Any]] = {}
    for claim in document["claims"]:
        of = found.setdefault(claim["claim"], {"name": claim["claim"], "judges": {}, "counts": [0, 0, 0], "seconds": 0.0})
        of["judges"][claim["judge"]] = None
        of["counts"][(True, False, None).index(claim["passed"])] += 1
        of["seconds"] += claim["seconds"]
    return [of | {"judges": ", ".join(of["judges"]), "seconds": f"{of['seconds']:.2f}"} for of in found.values()]


def _reasons(document: Document) -> dict[str, str]:
    """Return what was not judged, by the reason."""
    found: dict[str, dict[str, None]] = {}
    for claim in document["claims"]:
        if claim["passed"] is None:
            found.setdefault(claim["reason"], {})[f"{claim['claim']}: {claim['quantity']}"] = None
    return {reason: ", ".join(whats) for reason, whats in found.items()}


def _line(claim: Document) -> dict[str, str]:
    """A claim as texts for a table."""
    return {
        "claim": str(claim["claim"]),
        "where": str(claim["where"]),
        "quantity": str(claim["quantity"]),
        "computed": _figure(claim["computed"]),
        "reference": _figure(claim["reference"]),
        "deviation": _figure(claim["deviation"]),
        "permitted": _figure(claim["permitted"]),
        "unit": str(claim["unit"]),
        "judge": str(claim["judge"]),
        "verdict": _WORDS[claim["passed"]],
        "reason": str(claim["reason"]),
    }


def _figure(value: float | str | None) -> str:
    """A value of a claim with sensible digits."""
    if value is None:
        return ""
    if isinstance(value, bool | str):
        return str(value) if len(str(value)) <= 80 else f"{str(value)[:77]}..."
    if isinstance(value, int) or (float(value).is_integer() and abs(value) < 1e15):
        return f"{int(value):,}".replace(",", "\u202f")
    if abs(value) >= 1e5:
        return f"{value:,.0f}".replace(",", "\u202f")
    return f"{value:.2g}" if abs(value) < 1e-2 else f"{value:.6g}"


# -------------------------------------------------------------------------------------------------- tables of designs


def verification_index(name: str, documents: Sequence[Document], errors: Sequence[str], moved: Sequence[MovedFigure]) -> str:
    """Return the page of a table: a row for each design with its verdicts, which sorts and filters, and links to its page."""
    rows = []
    for document in documents:
        deviations = [
            (claim["deviation"] / claim["permitted"], claim)
            for claim in document["claims"]
            if claim["deviation"] is not None and claim["permitted"]
        ]
        share, nearest = max(deviations, key=lambda each: abs(each[0]), default=(None, None))
        rows.append(
            {
                "name": document["name"],
                "verdict": _WORDS[document["passed"]],
                "strength": _strength(document),
                "counts": [document["counts"].get(key, 0) for key in ("passed", "failed", "not judged")],
                "share": "" if share is None else f"{100 * abs(share):.0f}",
                "nearest": "" if nearest is None else f"{nearest['where']}: {nearest['quantity']}",
            }
        )
    changes = [str(each) for each in moved]
    return page_html("verify_index.html", name, rows=rows, errors=list(errors), moved=changes)


def junit_xml(documents: Iterable[Document], errors: Iterable[str] = ()) -> str:
    """Return claims as test cases in JUnit XML, as Jenkins and GitLab read it: a suite for each design.

    The schema is that of the JUnit plug-in of Jenkins (junit-10.xsd). A claim that failed is a failure, one that was not
    judged is skipped; a row of a table that could not be made is an error.
    """
    root = ElementTree.Element("testsuites", name="gearcad verify")
    total = [0, 0, 0]
    for document in documents:
        claims, spent = document["claims"], sum(claim["seconds"] for claim in document["claims"])
        failures = sum(claim["passed"] is False for claim in claims)
        skipped = sum(claim["passed"] is None for claim in claims)
        suite = ElementTree.SubElement(root, "testsuite", name=_legal(document["name"]), time=f"{spent:.3f}", errors="0")
        for key, count in (("tests", len(claims)), ("failures", failures), ("skipped", skipped)):
            suite.set(key, str(count))
        for claim in claims:
            case = ElementTree.SubElement(
                suite,
                "testcase",
                classname=_legal(f"{document['name']}.{claim['claim']}"),
                name=_legal(f"{claim['where']}: {claim['quantity']}"),
                time=f"{claim['seconds']:.3f}",
            )
            if claim["passed"] is False:
                said = ", ".join(f"{key} {_figure(claim[key])}" for key in ("computed", "reference", "deviation", "permitted"))
                failure = ElementTree.SubElement(case, "failure", message=_legal(claim["reason"] or claim["quantity"]))
                failure.text = _legal(f"{said} {claim['unit']}; judged by {claim['judge']}")
            elif claim["passed"] is None:
                ElementTree.SubElement(case, "skipped", message=_legal(claim["reason"]))
        total = [one + two for one, two in zip(total, (len(claims), failures, skipped), strict=True)]
    lines = list(errors)
    if lines:
        suite = ElementTree.SubElement(
            root, "testsuite", name="rows", tests=str(len(lines)), failures="0", errors=str(len(lines))
        )
        for line in lines:
            case = ElementTree.SubElement(suite, "testcase", classname="rows", name=_legal(line.partition(":")[0]))
            ElementTree.SubElement(case, "error", message=_legal(line))
    root.set("tests", str(total[0] + len(lines)))
    root.set("failures", str(total[1]))
    root.set("errors", str(len(lines)))
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _legal(text: str) -> str:
    """Return a text without the control characters that XML 1.0 does not permit."""
    return "".join(letter if letter >= " " or letter in "\t\n" else "?" for letter in str(text))


# ---------------------------------------------------------------------------------------------------------------- PDF

_MARGIN = 16.0
"""Margin of the page in mm."""

_COLUMNS = (20.0, 36.0, 44.0, 26.0, 26.0, 26.0)
"""Widths in mm of the columns: claim, where, quantity, deviation of permitted, judge, verdict."""


def write_verification_pdf(document: Document, head: Mapping[str, str], path: Path) -> None:
    """Write a verification as a PDF of A4 pages with the company's heading: what one sends to a customer.

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
    from reportlab.platypus import Paragraph, Spacer, Table

    from gearcad.drawing.page_export import pdf_font

    font = pdf_font()
    plain = ParagraphStyle("plain", fontName=font, fontSize=9, leading=12, spaceAfter=4)
    small = ParagraphStyle("small", parent=plain, fontSize=7, leading=8.5, spaceAfter=0, wordWrap="CJK")
    title = ParagraphStyle("title", parent=plain, fontSize=15, leading=19)
    section = ParagraphStyle("section", parent=plain, fontSize=11, leading=14, spaceBefore=10, keepWithNext=1)

    def cells(rows: Iterable[Sequence[str]]) -> list[list[Paragraph]]:
        return [[Paragraph(escape(text), small) for text in row] for row in rows]

    counts = document["counts"]
    yield Paragraph(escape(f"{document['name']}: {_verdict(document)}"), title)
    yield Paragraph(
        f"{counts['passed']} claims passed, {counts['failed']} failed, {counts['not judged']} not judged. Strength: "
        f"{_strength(document)}. Each claim was judged by something that did not make what it is about.",
        plain,
    )
    yield Paragraph("What was judged, and by whom", section)
    rows = [("claim", "judges", "passed", "failed", "not judged")]
    rows += [(of["name"], of["judges"], *map(str, of["counts"])) for of in _subjects(document)]
    yield Table(cells(rows), colWidths=[w * mm for w in (28, 90, 20, 20, 20)], repeatRows=1, style=_style())
    yield Paragraph(escape("Versions: " + ", ".join(f"{name} {found}" for name, found in document["judges"].items())), plain)
    if reasons := _reasons(document):
        yield Paragraph("Not judged", section)
        for reason, whats in reasons.items():
            yield Paragraph(escape(f"{whats}: {reason}"), plain)
    if document["warnings"]:
        yield Paragraph("Warnings", section)
        for warning in document["warnings"]:
            yield Paragraph(escape(str(warning)), plain)
    yield Paragraph("Files (SHA-256)", section)
    files = [(name, digest) for name, digest in document["files"].items()]
    if files:
        yield Table(cells(files), colWidths=[45 * mm, 133 * mm], style=_style(heading=False))
    yield Paragraph("Claims", section)
    lines = sorted((_line(claim) for claim in document["claims"]), key=lambda line: line["verdict"] != _WORDS[False])
    heads = ("claim", "of", "quantity", "deviation / permitted", "judge", "verdict")
    table = [
        heads,
        *((line["claim"], line["where"], line["quantity"], _share(line), line["judge"], _said(line)) for line in lines),
    ]
    yield Table(cells(table), colWidths=[width * mm for width in _COLUMNS], repeatRows=1, style=_style())
    yield Spacer(1, 2 * mm)


def _verdict(document: Document) -> str:
    return {True: "all claims passed", False: "claims FAILED", None: "nothing was judged"}[document["passed"]]


def _share(line: Mapping[str, str]) -> str:
    """The deviation beside what is permitted, or both values."""
    if line["deviation"]:
        return f"{line['deviation']} / {line['permitted']} {line['unit']}".strip()
    return " / ".join(filter(None, (line["computed"], line["reference"])))


def _said(line: Mapping[str, str]) -> str:
    return f"{line['verdict']}: {line['reason']}" if line["reason"] and line["verdict"] != _WORDS[None] else line["verdict"]


def _style(*, heading: bool = True) -> list[tuple[Any, ...]]:
    """Lines and spaces of a table."""
    from reportlab.lib.colors import Color

    grey, pale = Color(0.7, 0.7, 0.7), Color(0.94, 0.94, 0.94)
    found: list[tuple[Any, ...]] = [
        ("LINEBELOW", (0, 0), (-1, -1), 0.3, grey),
        ("VALIGN", (0, 0), (-1, -1), "TOP"),
        ("LEFTPADDING", (0, 0), (-1, -1), 2),
        ("RIGHTPADDING", (0, 0), (-1, -1), 2),
        ("TOPPADDING", (0, 0), (-1, -1), 1.5),
        ("BOTTOMPADDING", (0, 0), (-1, -1), 1.5),
    ]
    return [*found, ("BACKGROUND", (0, 0), (-1, 0), pale)] if heading else found
