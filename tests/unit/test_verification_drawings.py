"""Drawings that were tampered with: every row of a table, dimensions, sizes, title and mass are noticed, with their words."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import ezdxf
import pytest
from support.specs import TEMPLATES

from gearcad.designs import read_spec
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.geometry.fits import limit_deviations
from gearcad.jobs.build import products_of
from gearcad.jobs.job import Data
from gearcad.jobs.verification_sheets import judge_sheets, make_sheets
from gearcad.solids import FileOptions
from gearcad.verification.claims import Claim
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.limits_of_fit import fit_limits

STARTERS = ("spur", "volvo-13-44", "reducer-21-43", "ring-22-70", "rack", "double-23-81", "planetary-24-21-66", "planetary-alm")


class Judged:
    """A design with its sheets in a folder."""

    def __init__(self, name: str, folder: Path, text: str | None = None) -> None:
        path = TEMPLATES / f"{name}.toml"
        if text is not None:
            path = folder / f"{name}.toml"
            path.write_text(text, encoding="utf-8")
        design = read_spec(path)
        assert isinstance(design, ToothedDesign)
        parts, _ = products_of(design, FileOptions())
        self.design, self.folder = design, folder
        self.exact = {key: ExactPart(getattr(each, "gear", None) or each.rack) for key, each in parts.items()}
        self.reason = make_sheets(design, folder)

    def claims(self) -> list[Claim]:
        return list(judge_sheets(self.design, self.folder, self.exact, Data().document(self.design), self.reason))

    def wrong(self) -> list[Claim]:
        return [claim for claim in self.claims() if claim.passed is not True]


@pytest.mark.parametrize("name", STARTERS)
def test_sheets_as_they_are_drawn_pass(name: str, tmp_path: Path) -> None:
    judged = Judged(name, tmp_path)
    assert [claim.text for claim in judged.wrong()] == []
    assert len(judged.claims()) >= 30


@pytest.mark.parametrize("language", ["de", "sv"])
def test_sheets_in_other_languages_pass(language: str, tmp_path: Path) -> None:
    text = (TEMPLATES / "reducer-21-43.toml").read_text(encoding="utf-8")
    judged = Judged("reducer-21-43", tmp_path, f'{text}\n[drawing]\nlanguage = "{language}"\n')
    assert [claim.text for claim in judged.wrong()] == []


@pytest.fixture(scope="module")
def volvo(tmp_path_factory: pytest.TempPathFactory) -> Judged:
    return Judged("volvo-13-44", tmp_path_factory.mktemp("volvo"))


def edited(judged: Judged, name: str, change: Callable[[Any], None]) -> list[Claim]:
    """Return the claims that no longer pass after a change to a sheet, which is then restored."""
    path = judged.folder / name
    before = path.read_bytes()
    document = ezdxf.readfile(path)
    change(document)
    document.saveas(path)
    try:
        return judged.wrong()
    finally:
        path.write_bytes(before)


def replaced(old: str, new: str) -> Callable[[Any], None]:
    """Return a change of the first text of these words in model space or in a dimension."""

    def change(document: Any) -> None:
        texts = [*document.modelspace().query("TEXT"), *(each for block in document.blocks for each in block.query("TEXT"))]
        next(each for each in texts if each.dxf.text == old).dxf.text = new

    return change


PINION, ASSEMBLY = "drawing-pinion.dxf", "drawing-assembly.dxf"

EDITS = [
    (PINION, "31.094", "31.095", "Root diameter"),
    (PINION, "21 µm", "12 µm", "Total pitch deviation"),
    (PINION, "13", "14", "Number of teeth"),
    (PINION, "44 / Gear wheel", "45 / Gear wheel", "Mating gear: teeth / number"),
    (PINION, "28.0000°", "28.0001°", "Helix angle"),
    (PINION, "right", "left", "Hand of helix"),
    (PINION, "+0.1070", "−0.1070", "Profile shift coefficient"),
    (PINION, "19.193", "19.192", "Span over 3 teeth"),
    (PINION, "−95 µm", "−59 µm", "Thickness allowance, DIN 3967"),
    (PINION, "80.000 ±0.015", "80.000 ±0.051", "Centre distance"),
    (PINION, "0.48", "0.38", "Basic rack, root radius"),
    (PINION, "external, helical", "external, spur", "Teeth"),
    (PINION, "6 (assumed)", "5 (assumed)", "Accuracy grade, ISO 1328-1:1995"),
    (PINION, "Ra 0.8 µm", "Ra 8 µm", "Flank roughness"),
    (PINION, "36.809", "37", "Reference diameter"),
    (PINION, "⌀16", "⌀17", "size, bore"),
    (PINION, "case hardened", "nitrided", "heat treatment"),
    (PINION, "0.125 kg", "0.152 kg", "mass"),
    (PINION, "Pinion", "Piston", "title"),
    (PINION, "⌀42.307", "⌀42.370", "dimensions that tell what they measure"),
    (PINION, "H7", "H8", ", H8"),
    (PINION, "+0.018", "+0.019", ", H7"),
    (PINION, "h11", "h10", ", h10"),
    (ASSEMBLY, "±0.015", "±0.016", ", js7"),
    (ASSEMBLY, "3.3846", "3.3864", "Gear ratio"),
    (ASSEMBLY, "0.183", "0.138", "Normal backlash"),
    (ASSEMBLY, "13 / 44", "44 / 13", "Numbers of teeth, items 1 / 2"),
    ("drawing-wheel.dxf", "128.783", "128.738", "Size over balls or pins"),
]


@pytest.mark.parametrize(("name", "old", "new", "quantity"), EDITS, ids=[f"{old} to {new}" for _, old, new, _ in EDITS])
def test_an_edited_text_is_noticed(volvo: Judged, name: str, old: str, new: str, quantity: str) -> None:
    wrong = edited(volvo, name, replaced(old, new))
    assert any(quantity in claim.quantity for claim in wrong)
    assert all(claim.where == name for claim in wrong)


CLASSES = [f"{letter}{grade}" for letter in ("d", "e", "f", "g", "h", "js", "k", "m", "n", "p") for grade in range(5, 13)]
SIZES = (2.0, 5.0, 8.0, 14.0, 24.0, 45.0, 60.0, 100.0, 150.0, 200.0, 280.0, 350.0, 450.0)


@pytest.mark.parametrize("name", [*CLASSES, *(name.upper() for name in CLASSES)])
def test_limits_of_the_judge_and_of_the_drawings_agree(name: str) -> None:
    """Tables and formulas; limits that are 2 µm apart more, or 10 % and 6 µm to the side, are not those of the class."""
    judged = 0
    for size in SIZES:
        limits, told = fit_limits(name, size), limit_deviations(name, size)
        if limits is None:
            continue
        judged += 1
        assert limits.has(told.upper, told.lower), (size, told, limits)
        assert not limits.has(told.upper + 2.0, told.lower), (size, told, limits)
        aside = 6.0 + 0.1 * abs(limits.upper)
        assert not limits.has(told.upper + aside, told.lower + aside), (size, told, limits)
    known = not name.startswith("K") or 6 <= int(name[1:]) <= 8
    assert judged >= 10 or not known or name in ("M5", "N5", "P5", "K5")


@pytest.mark.parametrize("name", ["r6", "s6", "u6", "Z7", "H4", "h17", "J7", "nothing"])
def test_what_the_judge_of_limits_does_not_know_is_not_judged(name: str) -> None:
    assert fit_limits(name, 30.0) is None


def test_a_row_that_was_deleted_or_renamed_is_noticed(volvo: Judged) -> None:
    wrong = edited(volvo, PINION, replaced("Base diameter", "Bass diameter"))
    assert {claim.reason for claim in wrong} >= {"the row is missing"}
    assert {claim.quantity for claim in wrong} >= {"Base diameter"}


def test_a_symbol_and_limits_that_were_exchanged_are_noticed(volvo: Judged) -> None:
    assert [each.quantity for each in edited(volvo, PINION, replaced("dR", "dK"))] == ["Size over pins"]

    def exchange(document: Any) -> None:
        upper, lower = (
            next(each for each in document.modelspace().query("TEXT") if each.dxf.text == text) for text in ("4.057", "4.027")
        )
        upper.dxf.text, lower.dxf.text = lower.dxf.text, upper.dxf.text

    assert [each.quantity for each in edited(volvo, PINION, exchange)] == ["Normal tooth thickness"]


def test_a_dimension_whose_points_were_moved_is_noticed(volvo: Judged) -> None:
    def stretch(document: Any) -> None:
        dimension = document.modelspace().query("DIMENSION")[0]
        dimension.dxf.defpoint3 += ezdxf.math.Vec3(0.02, 0.02, 0)

    wrong = edited(volvo, PINION, stretch)
    assert [each.quantity for each in wrong] == ["dimensions that tell what they measure"]
    assert "measures" in wrong[0].reason


def test_broken_and_missing_sheets_fail_and_an_empty_folder_is_not_judged(volvo: Judged, tmp_path: Path) -> None:
    path = volvo.folder / PINION
    before = path.read_bytes()
    path.write_bytes(before[: len(before) // 2])
    broken = volvo.wrong()
    path.unlink()
    missing = volvo.wrong()
    path.write_bytes(before)
    assert broken
    assert {claim.where for claim in broken} == {PINION}
    assert [(claim.quantity, claim.passed) for claim in missing] == [("is there", False)]
    data = Data().document(volvo.design)
    (claim,) = judge_sheets(volvo.design, tmp_path, volvo.exact, data)
    assert claim.passed is None
    assert "no file" in claim.reason


def test_a_design_that_cannot_be_drawn_is_not_judged(tmp_path: Path) -> None:
    text = (TEMPLATES / "volvo-13-44.toml").read_text(encoding="utf-8")
    judged = Judged("volvo-13-44", tmp_path, f'{text}\n[drawing]\nsheet = "A4"\nscale = "10:1"\n')
    (claim,) = judged.wrong()
    assert claim.passed is None
    assert "no drawing can be made" in claim.reason
