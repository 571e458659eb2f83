"""Evidence of verifications: a page of each, an index of a table's, and JUnit XML for test servers.

All are made of the documents (verify.json), so that the rows of a table need not be in memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from typing import Any
from xml.etree import ElementTree

from gearcad.geometry import Gear, GearPair
from gearcad.plots.gears import pair_inches, plot_gear, plot_pair
from gearcad.report.document import ReportFigure, page_html, picture_address
from gearcad.verification.baseline import MovedFigure

Document = Mapping[str, Any]
"""Content of a verify.json."""

VERDICTS = {True: "passed", False: "FAILED", None: "not judged"}
"""Verdicts in words."""


def strength_words(document: Document) -> str:
    """Return the verdict on strength in words; at level files no claim needs it."""
    return "not part of level files" if document["level"] == "files" else VERDICTS[document["strength"]]


def verification_html(document: Document, head: Mapping[str, str], subject: Gear | GearPair | None = None) -> str:
    """Return the page of a verification: verdict, what was judged by whom, a picture of a gear or pair, all claims."""
    return page_html(
        "verify.html",
        str(document["name"]),
        of=document,
        strength=strength_words(document),
        head=head,
        subjects=judged_subjects(document),
        failed=[claim_texts(claim) for claim in document["claims"] if claim["passed"] is False],
        not_judged=unjudged_reasons(document),
        claims=[claim_texts(claim) for claim in document["claims"]],
        picture_of_design=None if subject is None else _picture(subject),
    )


def _picture(subject: Gear | GearPair) -> ReportFigure:
    if isinstance(subject, Gear):
        address = picture_address(partial(plot_gear, subject), "svg")
        return ReportFigure("The gear", address, "Section of the gear, and its circles.")
    address = picture_address(partial(plot_pair, subject), "svg", pair_inches(subject))
    return ReportFigure("The pair in mesh", address, "Both gears as the files have them.")


def judged_subjects(document: Document) -> list[dict[str, Any]]:
    """Return each subject that was judged, with its judges, its counts and the time."""
    found: dict[str, dict[str, Any]] = {}
    for claim in document["claims"]:
        of = found.setdefault(claim["claim"], {"name": claim["claim"], "judges": {}, "counts": [0, 0, 0], "seconds": 0.0})
        of["judges"][claim["judge"]] = None
        of["counts"][(True, False, None).index(claim["passed"])] += 1
        of["seconds"] += claim["seconds"]
    return [of | {"judges": ", ".join(of["judges"]), "seconds": f"{of['seconds']:.2f}"} for of in found.values()]


def unjudged_reasons(document: Document) -> dict[str, str]:
    """Return what was not judged, by the reason."""
    found: dict[str, dict[str, None]] = {}
    for claim in document["claims"]:
        if claim["passed"] is None:
            found.setdefault(claim["reason"], {})[f"{claim['claim']}: {claim['quantity']}"] = None
    return {reason: ", ".join(whats) for reason, whats in found.items()}


def safety_texts(document: Document) -> list[tuple[str, str, str, str, str]]:
    """Return a row for each safety: mesh, what it is of, value, minimum, verdict; those that were not judged are left out."""
    return [
        (
            str(claim["where"]),
            str(claim["quantity"]).removeprefix("safety, ").removeprefix("safety "),
            figure_text(claim["computed"]),
            figure_text(claim["reference"]),
            VERDICTS[claim["passed"]],
        )
        for claim in document["claims"]
        if claim["claim"] == "strength" and claim["computed"] is not None
    ]


def claim_texts(claim: Document) -> dict[str, str]:
    """A claim as texts for a table."""
    return {
        "claim": str(claim["claim"]),
        "where": str(claim["where"]),
        "quantity": str(claim["quantity"]),
        "computed": figure_text(claim["computed"]),
        "reference": figure_text(claim["reference"]),
        "deviation": figure_text(claim["deviation"]),
        "permitted": figure_text(claim["permitted"]),
        "unit": str(claim["unit"]),
        "judge": str(claim["judge"]),
        "verdict": VERDICTS[claim["passed"]],
        "reason": str(claim["reason"]),
    }


def figure_text(value: float | str | None) -> str:
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
                "verdict": VERDICTS[document["passed"]],
                "strength": strength_words(document),
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
                said = ", ".join(
                    f"{key} {figure_text(claim[key])}" for key in ("computed", "reference", "deviation", "permitted")
                )
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
