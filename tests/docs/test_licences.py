"""Licences of what gearcad needs, as the installed packages state them, are those of LICENSES.md."""

import re
import tomllib
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

import pytest

requirements = pytest.importorskip("packaging.requirements")

ROOT = Path(__file__).parents[2]

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

PAGE = (ROOT / "LICENSES.md").read_text(encoding="utf-8")

NOTICE_ONLY = re.compile(
    r"(MIT(-CMU)?|BSD(-[23]-Clause)?|0BSD|Apache([- ]2\.0)?|LLVM-exception|PSF(-2\.0)?|Python Software Foundation|ISC"
    r"|Zlib|CC0-1\.0)( Software)?( License)?( ISCL)?"
)
"""Licences that ask for a notice and no more, as metadata write them."""

FAMILIES = {
    "PSF-based": "Python Software Foundation License",
    "GPL-2.0-or-later": "GNU General Public License v2 or later (GPLv2+)",
}


def stated(package: Distribution) -> str:
    """The licence by the expression, else by the classifiers, else by the first line of the field."""
    metadata = package.metadata
    named = [each.split(" :: ")[-1] for each in metadata.get_all("Classifier") or [] if each.startswith("License ::")]
    return str(metadata.get("License-Expression") or "; ".join(named) or (metadata.get("License") or "?").split("\n")[0])


def needed(given: list[str]) -> dict[str, Distribution]:
    """All that the requirements bring, by name, as far as it is installed."""
    found: dict[str, Distribution] = {}
    open_ones = [requirements.Requirement(each) for each in given]
    while open_ones:
        wanted = open_ones.pop()
        name = re.sub(r"[-_.]+", "-", wanted.name).lower()
        if name == "gearcad" or name in found or (wanted.marker and not wanted.marker.evaluate({"extra": ""})):
            continue
        try:
            found[name] = distribution(name)
        except PackageNotFoundError:
            continue  # an extra that is not installed here
        open_ones += [requirements.Requirement(each) for each in found[name].requires or ()]
    return found


def table(heading: str) -> dict[str, str]:
    """Package -> licence of a table of the page."""
    section = PAGE.split(f"## {heading}\n")[1].split("\n## ")[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if line.startswith("| ")]
    return {name: licence for names, licence, *_ in rows[1:] for name in names.split(", ")}


def test_every_package_that_asks_for_more_than_a_notice_is_told() -> None:
    extras = [
        each for name, given in PROJECT["optional-dependencies"].items() if name not in ("bench", "dev") for each in given
    ]
    told = set(table("Conditions beyond a notice"))
    asking = set()
    for name, package in needed([*PROJECT["dependencies"], *extras]).items():
        parts = re.split(r"; | AND | OR | WITH ", stated(package).replace("(", "").replace(")", ""))
        if not all(NOTICE_ONLY.fullmatch(part.strip()) for part in parts):
            asking.add(name)
    assert asking <= told
    assert "gmsh" in asking


def test_what_the_default_installation_needs_is_listed_with_its_licence() -> None:
    listed = table("What the default installation needs")
    names = [requirements.Requirement(each).name for each in PROJECT["dependencies"]]
    assert sorted(listed) == sorted(names)
    for name, package in ((name, distribution(name)) for name in names):
        said = stated(package)
        assert FAMILIES.get(listed[name], listed[name]).split("-")[0].lower() in said.lower(), (name, said)


def test_the_address_of_the_project_stands_once() -> None:
    """Until there is one it is a placeholder; whoever puts the address there needs to change nothing else."""
    first = PROJECT["urls"]["Homepage"]
    assert all(address.startswith(first) for address in PROJECT["urls"].values())
    pages = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CITATION.cff", *(ROOT / "docs").rglob("*.md")]
    assert not [page for page in pages if first in page.read_text(encoding="utf-8")]


def test_the_libraries_of_the_manual_on_read_the_docs_are_those_of_the_machine() -> None:
    listed = set((ROOT / ".ci" / "libraries.txt").read_text(encoding="utf-8").split()) - {"python3-venv"}
    line = re.search(r"apt_packages: \[(.*)\]", (ROOT / ".readthedocs.yaml").read_text(encoding="utf-8"))
    assert line and set(line[1].split(", ")) == listed
