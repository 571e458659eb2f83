"""What stands around the code is true: paths that CONTRIBUTING.md names, libraries of the image, forms, what is to be cited."""

import re
import sys
import tomllib
from pathlib import Path
from types import CodeType, FrameType

import pytest
from support.commands import run

from gearcad.solids.exact.solid import gear_boundary

ROOT = Path(__file__).parents[2]


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def version(words: str) -> tuple[int, ...]:
    return tuple(int(part) for part in words.split("."))


def test_every_path_that_is_named_is_there() -> None:
    found = 0
    for named in re.findall(r"`([\w./-]+)`", text("CONTRIBUTING.md")):
        if "/" in named or named.endswith((".md", ".toml", ".cff")):
            assert (ROOT / named).exists(), named
            found += 1
    assert found > 25
    for folder in re.findall(
        r"`(\w+)`", text("CONTRIBUTING.md").split("in folders of these names:")[1].split(". A tolerance")[0]
    ):
        assert (ROOT / "tests" / folder).is_dir(), folder


WAYS = dict(re.findall(r"\n## From .*: `gearcad (\w+) pair\.toml`\n\n((?:\d+\. .*\n)+)", text("gearcad/README.md")))
"""The two ways through the house, as the map has them: numbered lines by the verb of the command."""


@pytest.mark.parametrize("verb", ["build", pytest.param("check", marks=pytest.mark.long)])
def test_a_command_goes_the_way_that_the_map_shows(verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    steps = re.findall(r"^\d+\. `(\S+)` `(\S+)`", WAYS[verb], re.MULTILINE)
    coarse = '[check]\nconvergence = "off"\npositions = 12\n'
    (tmp_path / "pair.toml").write_text(text("templates/fzg-c.toml") + coarse, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    entered: dict[int, CodeType] = {}
    gear_boundary.cache_clear()  # of a gear that another test has built

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            entered.setdefault(id(frame.f_code), frame.f_code)

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        run(verb, "pair.toml", "--quiet")
    finally:
        sys.setprofile(before)
    found = [(code.co_filename.removeprefix(f"{ROOT}/gearcad/"), code.co_qualname) for code in entered.values()]
    assert [each for each in found if each in steps] == steps and len(steps) == 10


def test_the_image_has_the_libraries_that_the_readme_installs() -> None:
    libraries = {each for each in text(".ci/libraries.txt").split() if each.startswith("lib")}
    image = text("Dockerfile").split("\nFROM")[-1]
    assert libraries and libraries == set(re.findall(r"\blib[a-z]\w*[\w.-]*", image.split("rm -rf")[0]))


def test_forms_ask_for_what_is_needed() -> None:
    yaml = pytest.importorskip("yaml")
    asked = {}
    for path in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"):
        form = yaml.safe_load(path.read_text(encoding="utf-8"))
        asked[path.stem] = {each["id"] for each in form.get("body", ()) if each.get("validations", {}).get("required")}
    assert asked["bug"] == {"what", "spec", "version", "platform"}
    assert asked["wrong_number"] == {"result", "found", "source", "spec", "version"}
    assert asked["feature"] == {"task"}


def test_what_is_cited_is_a_release_up_to_the_one_that_the_tree_leads_to() -> None:
    yaml = pytest.importorskip("yaml")
    cited = yaml.safe_load(text("CITATION.cff"))
    fallback = tomllib.loads(text("pyproject.toml"))["tool"]["hatch"]["version"]["fallback-version"]
    assert version(cited["version"]) <= version(fallback.removesuffix(".dev0"))
    assert version(cited["version"]) >= (0, 2, 0)
    assert cited["license"] == "MIT" and re.fullmatch(r"\d{4}-\d\d-\d\d", cited["date-released"])
