"""Evidence of verifications: a page of each, an index of a table's, and JUnit XML for test servers.

All are made of the documents (verify.json), so that the rows of a table need not be in memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
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


def conclusion_words(document: Document) -> str:
    """Return the verdict on claims, and on strength where it failed, as a sentence without its full stop."""
    passed = {True: "All claims passed", False: "Claims FAILED", None: "Nothing was judged"}[document["passed"]]
    if document["strength"] is not False:
        return passed
    return f"{passed.replace('All claims', 'All claims on files and figures')}; strength FAILED"


def verification_html(document: Document, head: Mapping[str, str], subject: Gear | GearPair | None = None) -> str:
    """Return the page of a verification: verdict, what was judged by whom, a picture of a gear or pair, all claims."""
    return page_html(
        "verify.html",
        str(document["name"]),
        of=document,
        strength=strength_words(document),
        head=head,
        conclusion=conclusion_words(document),
        subjects=judged_subjects(document),
        timed=any(claim["seconds"] for claim in document["claims"]),
        failed=[claim_texts(claim) for claim in document["claims"] if claim["passed"] is False],
        not_judged=unjudged_reasons(document),
        safeties=safety_texts(document),
        groups=claim_groups(document),
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


@dataclass(frozen=True)
class ClaimGroup:
    """Claims of one subject about one thing by one judge, as texts; `first` is true of the first group of its subject."""

    subject: str
    where: str
    judge: str
    first: bool
    claims: Sequence[Mapping[str, str]]


def claim_groups(document: Document, *, failed_first: bool = False) -> list[ClaimGroup]:
    """Return the claims in groups, in their order, or those that failed before all others; safeties are left out."""
    found: dict[tuple[bool, str, str, str], list[dict[str, str]]] = {}
    for claim in document["claims"]:
        if not _is_safety(claim):
            passed = not (failed_first and claim["passed"] is False)
            key = (passed, str(claim["claim"]), str(claim["where"]), str(claim["judge"]))
            found.setdefault(key, []).append(claim_texts(claim))
    groups, subject = list[ClaimGroup](), ""
    for (_, of, where, judge), claims in sorted(found.items(), key=lambda group: group[0][0]):
        groups.append(ClaimGroup(of, where, judge, of != subject, claims))
        subject = of
    return groups


def _is_safety(claim: Document) -> bool:
    """Return whether a claim is on a safety that has a value."""
    return claim["claim"] == "strength" and claim["computed"] is not None


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
            f"{claim['computed']:.3f}",
            f"{claim['reference']:.3f}" if isinstance(claim["reference"], int | float) else figure_text(claim["reference"]),
            VERDICTS[claim["passed"]],
        )
        for claim in document["claims"]
        if _is_safety(claim)
    ]


def claim_texts(claim: Document) -> dict[str, str]:
    """A claim as texts for a table."""
    return {
        "claim": str(claim["claim"]),
        "where": str(claim["where"]),
        "quantity": str(claim["quantity"]),
        "computed": figure_text(claim["computed"]),
        "reference": figure_text(claim["reference"]),
        "deviation": figure_text(claim["deviation"], _FEW),
        "permitted": figure_text(claim["permitted"], _FEW),
        "unit": str(claim["unit"]),
        "judge": str(claim["judge"]),
        "verdict": VERDICTS[claim["passed"]],
        "reason": str(claim["reason"]),
    }


_NOTHING = 1e-12
"""Deviation that is rounding of numbers, whatever its unit."""


_MANY, _FEW = 6, 3
"""Significant digits of values, and of deviations."""


def figure_text(value: float | str | None, digits: int = _MANY) -> str:
    """A value of a claim with so many significant digits, without those behind the decimal point of large numbers."""
    if value is None:
        return ""
    if isinstance(value, bool | str):
        return str(value) if len(str(value)) <= 80 else f"{str(value)[:77]}..."
    if isinstance(value, int) or (float(value).is_integer() and abs(value) < 1e15):
        return f"{int(value):,}".replace(",", "\u202f")
    if abs(value) >= 1e4:
        whole = len(f"{abs(value):.0f}")
        return f"{value:,.{max(digits - whole, 0)}f}".replace(",", "\u202f")
    if 0 < abs(value) < _NOTHING:
        return "< 1e-12"
    return f"{value:.2g}" if abs(value) < 1e-2 else f"{value:.{digits}g}"


# -------------------------------------------------------------------------------------------------- tables of designs


def verification_index(name: str, documents: Iterable[Document], errors: Sequence[str], moved: Sequence[MovedFigure]) -> str:
    """Return the page of a table: a row for each design with its verdicts, which sorts and filters, and links to its page.

    Designs with claims that failed come first, each with the first of these.
    """
    rows = []
    for document in documents:
        deviations = [
            (claim["deviation"] / claim["permitted"], claim)
            for claim in document["claims"]
            if claim["deviation"] is not None and claim["permitted"]
        ]
        share, nearest = max(deviations, key=lambda each: abs(each[0]), default=(None, None))
        nearest = next((claim for claim in document["claims"] if claim["passed"] is False), nearest)
        rows.append(
            {
                "name": document["name"],
                "verdict": VERDICTS[document["passed"]],
                "strength": "–" if document["level"] == "files" else VERDICTS[document["strength"]],
                "counts": [document["counts"].get(key, 0) for key in ("passed", "failed", "not judged")],
                "share": "" if share is None else f"{100 * abs(share):.0f}",
                "nearest": "" if nearest is None else f"{nearest['where']}: {nearest['quantity']}",
            }
        )
    rows.sort(key=lambda row: VERDICTS[False] not in (row["verdict"], row["strength"]))
    changes = [str(each) for each in moved]
    return page_html("verify_index.html", name, rows=rows, errors=list(errors), moved=changes)


def junit_xml(documents: Iterable[Document], errors: Iterable[str] = ()) -> str:
    """Return claims as test cases in JUnit XML, as Jenkins and GitLab read it: a suite for each design.

    The schema is that of the JUnit plug-in of Jenkins (junit-10.xsd). A claim that failed is a failure, one that was not
    judged is skipped; a row of a table that could not be made is an error.
    """
    suites, total = list[str](), [0, 0, 0]
    for document in documents:
        suite, counts = _suite(document)
        suites.append(_xml(suite))
        total = [one + two for one, two in zip(total, counts, strict=True)]
    if lines := list(errors):
        suite = ElementTree.Element("testsuite", name="rows", tests=str(len(lines)), failures="0", errors=str(len(lines)))
        for line in lines:
            case = ElementTree.SubElement(suite, "testcase", classname="rows", name=_legal(line.partition(":")[0]))
            ElementTree.SubElement(case, "error", message=_legal(line))
        suites.append(_xml(suite))
    head = f'name="gearcad verify" tests="{total[0] + len(lines)}" failures="{total[1]}" errors="{len(lines)}"'
    begun = f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites {head}'
    return f"{begun}>\n{''.join(suites)}</testsuites>\n" if suites else f"{begun} />\n"


def _xml(suite: ElementTree.Element) -> str:
    """Return a suite as lines that are indented by two."""
    ElementTree.indent(suite, level=1)
    return f"  {ElementTree.tostring(suite, encoding='unicode').rstrip()}\n"


def _suite(document: Document) -> tuple[ElementTree.Element, tuple[int, int, int]]:
    """Return the test cases of one design, and how many there are, failed, and were not judged."""
    claims, spent = document["claims"], sum(claim["seconds"] for claim in document["claims"])
    failures = sum(claim["passed"] is False for claim in claims)
    skipped = sum(claim["passed"] is None for claim in claims)
    suite = ElementTree.Element("testsuite", name=_legal(document["name"]), time=f"{spent:.3f}", errors="0")
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
            said = ", ".join(f"{key} {figure_text(claim[key])}" for key in ("computed", "reference", "deviation", "permitted"))
            failure = ElementTree.SubElement(case, "failure", message=_legal(claim["reason"] or claim["quantity"]))
            failure.text = _legal(f"{said} {claim['unit']}; judged by {claim['judge']}")
        elif claim["passed"] is None:
            ElementTree.SubElement(case, "skipped", message=_legal(claim["reason"]))
    return suite, (len(claims), failures, skipped)


def _legal(text: str) -> str:
    """Return a text without the control characters that XML 1.0 does not permit."""
    return "".join(letter if letter >= " " or letter in "\t\n" else "?" for letter in str(text))
