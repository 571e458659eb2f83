"""Figures of runs beside each other, and what the browser fetches of them: only what a run has made, under fixed names."""

import zipfile
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from support.page_server import awaited

from gearcad.core.units import UnitSystem
from gearcad.designs.reader import starter_text
from gearcad.page.panels.runs import changes_between, figures_beside, verb_of
from gearcad.page.panels.spec import _names
from gearcad.page.run_process import DOWNLOADS
from gearcad.page.runs import Runs, RunState
from gearcad.page.words import PageLanguage, PageWords
from gearcad.solids import Format

pytest.importorskip("nicegui")
pytest.importorskip("httpx")

ENGLISH = PageWords.of(PageLanguage.ENGLISH)
REDUCER = starter_text("reducer")[1]


@pytest.fixture(scope="module")
def runs() -> Iterator[Runs]:
    """A rating of a pair, of one with another tooth, and the data of that."""
    made = Runs()
    other = REDUCER.replace("teeth = 21", "teeth = 22").replace('name = "reducer-21-43"', 'name = "Größe 2"')
    for kind, text in (("rate", REDUCER), ("rate", other), ("data", other)):
        assert made.start(kind, text, "mine", Path(), {}).ended.wait(60)
    assert [run.line for run in made.all if run.state is not RunState.DONE] == []
    yield made
    made.close()


@pytest.fixture(scope="module")
def client() -> Callable[[str], Any]:
    """What the server answers to a path."""
    import httpx
    from fastapi import FastAPI

    from gearcad.page.runs import add_made

    app = FastAPI()
    add_made(app)

    async def get(path: str) -> Any:
        async with httpx.AsyncClient(transport=httpx.ASGITransport(app), base_url="http://127.0.0.1") as asking:
            return await asking.get(path)

    return lambda path: awaited(get(path))


@pytest.mark.long
def test_figures_stand_beside_each_other(runs: Runs) -> None:
    first, second = runs.all[:2]
    assert (verb_of(first), first.line) == ("rate", "reducer-21-43 at 200 N·m, 1450 rpm: strength passed")
    rows = {row["key"]: row for row in figures_beside([second, first], ENGLISH)}
    assert rows["S_H.pinion"]["cells"] == [f"{run.figures['S_H.pinion']:.5g}" for run in (second, first)]
    assert rows["S_H.pinion"]["differs"] and rows["S_H.pinion"]["words"] == "pinion: safety of the flank against pitting"
    assert rows["passed"]["cells"] == ["yes", "yes"] and not rows["passed"]["differs"]
    assert rows["sigma_H.pinion"]["unit"] == "MPa"


def test_what_designs_differ_by() -> None:
    assert changes_between({"a.b": "1", "a.c": "2"}, {"a.b": "1", "a.d": "3"}, ENGLISH) == ["a.c 2 → -", "a.d - → 3"]
    assert changes_between({}, {str(each): "1" for each in range(20)}, ENGLISH)[-1] == "+ 8"
    inches = PageWords.of(PageLanguage.ENGLISH, UnitSystem.INCH)
    moved = changes_between({"pair.centre_distance": "101.6"}, {"pair.centre_distance": "102.87", "pinion.teeth": "20"}, inches)
    assert moved == ["pair.centre_distance 4 → 4.05", "pinion.teeth - → 20"]


@pytest.mark.long
def test_a_report_is_fenced_in(runs: Runs, client: Callable[[str], Any]) -> None:
    answer = client(f"/made/{runs.key}/0/rate.html")
    assert answer.status_code == 200 and "<h1>reducer-21-43" in answer.text
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts;") and "default-src 'none'" in policy and "allow-same-origin" not in policy
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize(
    "path",
    [
        "0/rate.json",
        "0/..%2f..%2fetc%2fpasswd",
        "0/%2fetc%2fpasswd",
        "9/rate.html",
        "-1",
        "-2/rate.html",
        "2/rate.html",
        "9",
    ],
)
def test_nothing_else_is_fetched(runs: Runs, client: Callable[[str], Any], path: str) -> None:
    assert client(f"/made/{runs.key}/{path}").status_code in (404, 422)


def test_nobody_else_fetches(runs: Runs, client: Callable[[str], Any]) -> None:
    for key in ("", "..", runs.key[:-1], runs.key + "x"):
        assert client(f"/made/{key}/0/rate.html").status_code == 404


def test_files_are_taken_along_under_the_name_of_the_design(runs: Runs, client: Callable[[str], Any]) -> None:
    one, several = client(f"/made/{runs.key}/2"), client(f"/made/{runs.key}/0")
    assert one.json()["name"] == "Größe 2"
    assert one.headers["content-disposition"] == "attachment; filename*=utf-8''Gr%C3%B6%C3%9Fe%202.json"
    assert several.headers["content-disposition"] == 'attachment; filename="reducer-21-43-rate.zip"'
    with zipfile.ZipFile(BytesIO(several.content)) as archive:
        assert archive.namelist() == ["rate.json", "rate.html"]


def test_every_format_of_solids_can_be_downloaded_under_a_name() -> None:
    assert {"step", "stl", "3mf", "glb", "dxf", "csv"} <= DOWNLOADS.keys()
    assert {each.value for each in Format} - DOWNLOADS.keys() == {"png"}, "the page has pictures"
    assert DOWNLOADS.keys() <= _names(ENGLISH).keys()
    assert (_names(ENGLISH)["3mf"], _names(ENGLISH)["dxf"]) == ("3MF", "contours (DXF)")
