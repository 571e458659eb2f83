"""Claims of level "strength": contact, root stress and stiffness of the structural check, and the safeties of the rating."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.check.comparison import Comparison, ComparisonRole
from gearcad.check.comparison import Subject as CheckSubject
from gearcad.check.result import CheckResult
from gearcad.core.records import Verdict
from gearcad.dynamics.planetary.planetary_strength import TrainStrength
from gearcad.rating.strength import PartStrength, StrengthRating
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel

INFORMATION = "outside the band of the standard, which is information and decides nothing"
"""Reason of a comparison with a standard that is outside its band, as the check has it."""


def judge_check(result: CheckResult, where: str) -> Iterator[Claim]:
    """Yield the comparisons of a structural check as claims: gates decide, bands of a standard inform.

    What a gate could not evaluate has failed, as in the check; information is passed or not judged.
    """
    for each in result.comparisons:
        if each.subject is CheckSubject.STRENGTH:
            continue  # safeties are the rating's
        judge = Judge(_subject(each), VerificationLevel.STRENGTH, where, each.source.partition(":")[0])
        gate = each.role is ComparisonRole.GATE
        passed = each.passed if gate else (each.passed or None)
        reason = each.reason or ("" if each.passed else each.note if gate else INFORMATION)
        yield _claim(judge, each, passed=passed, reason=reason)


def _subject(each: Comparison) -> ClaimSubject:
    """Return the subject of a comparison of the check."""
    if "stiffness" in each.quantity:
        return ClaimSubject.STIFFNESS
    return ClaimSubject.ROOT if "root" in each.quantity else ClaimSubject.CONTACT


def _claim(judge: Judge, each: Comparison, *, passed: bool | None, reason: str) -> Claim:
    share = each.tolerance is not None
    return Claim(
        subject=judge.subject,
        level=judge.level,
        where=judge.where,
        quantity=f"{each.quantity} ({each.unit})" if each.unit else each.quantity,
        judge=judge.name,
        computed=each.computed,
        reference=each.reference,
        deviation=each.deviation if share else None,
        permitted=each.tolerance,
        unit="",
        passed=passed,
        reason=reason,
    )


_VERDICTS = {Verdict.PASSED: True, Verdict.FAILED: False}


def judge_rating(rating: StrengthRating | TrainStrength, where: str) -> Iterator[Claim]:
    """Yield the safeties of a rating as claims: judged beside what is required, or not judged, for the reason.

    The verdicts are those of the rating.
    """
    if isinstance(rating, StrengthRating):
        yield from _judge_mesh(rating, where)
        return
    for name, mesh in rating.meshes.items():
        yield from _judge_mesh(mesh, name)
    for name, reason in rating.unrated.items():
        yield Judge(ClaimSubject.STRENGTH, VerificationLevel.STRENGTH, name, "rating").not_judged("safeties", reason)


def _judge_mesh(rating: StrengthRating, where: str) -> Iterator[Claim]:
    """The safeties of one pair: of each flank and root, and against scuffing."""
    judge = Judge(ClaimSubject.STRENGTH, VerificationLevel.STRENGTH, where, f"rating by {rating.options.standard.value}")
    if not rating.asked:
        yield judge.not_judged("safeties", rating.verdict)
        return
    for name, part in rating.every:
        yield _safety(judge, f"safety, {name}", part)
    required, scuffing = rating.options.required_safety_scuffing, rating.scuffing
    if required is None:
        return
    yield Claim(
        subject=judge.subject,
        level=judge.level,
        where=judge.where,
        quantity="safety against scuffing, integral temperature",
        judge=judge.name,
        computed=None if scuffing is None else scuffing.integral_safety,
        reference=required,
        passed=_VERDICTS.get(rating.scuffing_verdict),
        reason=rating.not_judged.get("scuffing", ""),
    )


def _safety(judge: Judge, quantity: str, part: PartStrength) -> Claim:
    """The safety of a flank or a root beside the required one."""
    return Claim(
        subject=judge.subject,
        level=judge.level,
        where=judge.where,
        quantity=quantity,
        judge=judge.name,
        computed=part.safety,
        reference=part.required,
        passed=_VERDICTS.get(part.verdict),
        reason=part.reason if part.safety is None else "" if part.verdict is Verdict.PASSED else "below the required safety",
    )
