"""The report of a planetary train holds what its study holds, names what it does not, and needs nothing from elsewhere."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import lxml.etree
import lxml.html
import pytest
from matplotlib.figure import Figure
from support.planetary import simple_train
from support.planetary_trains import TRAINS
from support.specs import TEMPLATES

from gearcad.designs import PlanetaryDesign, read_spec
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.planetary.planetary_excitation import QUICK
from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy
from gearcad.dynamics.planetary.planetary_study import study_planetary
from gearcad.planetary import PlanetaryTrain, TrainLoad
from gearcad.plots.paper import short
from gearcad.report import planetary_html, write_planetary_report
from gearcad.report.document import figure_address
from gearcad.report.planetary_tables import mesh_table
from gearcad.stiffness.methods import METHODS

OWN = METHODS[QUICK]

NASTY_NAME = 'a <b>"train"</b> & $more$'

ALWAYS = ["Scheme", "Gears", "Assembly"]
LOADED = ["Power", "Forces", "Load sharing", "Torsional stiffness", "Running", "Rating of the meshes"]
VIBRATING = ["Natural frequencies and modes", "Campbell diagram"]


def _drawn_only(draw: Callable[[Figure], object], _kind: str, inches: tuple[float, float]) -> str:
    """A picture that is drawn, but not written, which takes most of the time."""
    draw(Figure(figsize=inches))
    return "data:image/svg+xml;base64,"


@pytest.fixture(scope="module", autouse=True)
def quick() -> Iterator[None]:
    """Mean mesh stiffnesses in place of computed courses, and pictures that are not written."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(METHODS, QUICK, METHODS["iso6336"])
        patch.setattr("gearcad.report.planetary.figure_address", _drawn_only)
        yield


def starter(name: str) -> PlanetaryStudy:
    design = read_spec(TEMPLATES / f"planetary-{name}.toml")
    assert isinstance(design, PlanetaryDesign)
    return study_planetary(_weighed(design.train), design.load, design.speeds)


def _weighed(train: PlanetaryTrain) -> PlanetaryTrain:
    """With masses, so that no solids need be made to find them."""
    centrals = tuple(replace(central, mass=5.0, inertia=0.05) for central in train.centrals)
    carrier = replace(train.carrier, mass=8.0, inertia=0.05, planet_mass=0.6, planet_inertia=4e-4)
    return replace(train, centrals=centrals, carrier=carrier)


@pytest.fixture(scope="module")
def alm() -> PlanetaryStudy:
    return starter("alm")


@pytest.fixture(scope="module")
def page(alm: PlanetaryStudy, tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("report") / "planetary.html"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gearcad.report.planetary.figure_address", figure_address)
        patch.setattr("gearcad.report.document.new_figure", lambda inches: Figure(figsize=inches))  # without layout
        write_planetary_report(alm, NASTY_NAME, path)
    return path.read_text(encoding="utf-8")


def table(text: str, head: str) -> list[list[str]]:
    """Cells of the body of the first table whose first heads are these, with commas between them."""
    for found in lxml.html.document_fromstring(text).xpath("//table"):
        heads = [cell.text_content() for cell in found.xpath("./thead/tr/th")]
        if ",".join(heads).startswith(head):
            return [[cell.text_content() for cell in row] for row in found.xpath("./tbody/tr")]
    raise AssertionError(head)


def titles(text: str) -> list[str]:
    return [each.text_content() for each in lxml.html.document_fromstring(text).xpath("//h2")]


def test_the_page_is_well_formed_and_needs_nothing_from_elsewhere(page: str) -> None:
    root = lxml.etree.fromstring(page.removeprefix("<!DOCTYPE html>").strip().encode())
    figures = root.xpath("//figure/@id")
    assert figures == [f"figure-{number}" for number in range(1, len(figures) + 1)]
    document = lxml.html.document_fromstring(page)
    assert document.xpath("//link | //script | //iframe | //object | //embed | //a[not(starts-with(@href, '#'))]") == []
    assert all(address.startswith("data:image/svg+xml;base64,") for address in document.xpath("//@src"))
    assert NASTY_NAME in document.xpath("string(//h1)")
    words = document.text_content().replace("resonance", "")
    assert "nan" not in words.replace("finance", "") and "None" not in words


def test_it_holds_the_speeds_torques_and_shares_of_the_study(alm: PlanetaryStudy, page: str) -> None:
    assert alm.why_not == {} and alm.flow is not None and alm.speeds is not None and alm.sharing is not None
    rows = {row[0]: row[2:] for row in table(page, "member or shaft")}
    for name, speed in alm.speeds.members.items():
        assert rows[name][:2] == [short(speed), short(alm.flow.torques.get(name, 0.0))]
    assert rows["planets on their pins"][0] == short(alm.speeds.planet_relative)
    shares = table(page, "planet,share")
    assert [row[3] for row in shares] == [f"{share:.4f}" for share in alm.sharing.greatest_shares]
    gears = {row[0]: row[2] for row in table(page, "gear")}
    assert gears == {"ring_4": "-70", "ring_5": "-72", "rim_3": "22", "rim_3p": "21", "pinion_1": "18", "gear_2": "161"}
    assert "The ratio is -124.2807" in page
    assert set(ALWAYS + LOADED + VIBRATING) <= set(titles(page)) and "Loads over speed" not in titles(page)
    assert alm.campbell is not None and len(table(page, "line,mode")) == min(len(alm.campbell.excited), 24)
    assert "What could not be computed" not in titles(page)


def test_what_is_missing_is_named_with_its_reason(alm: PlanetaryStudy) -> None:
    weighed = _weighed(TRAINS["A"])
    study = study_planetary(replace(weighed, carrier=replace(weighed.carrier, inertia=None)))
    assert "carrier.inertia" in study.why_not["modes"]
    text = planetary_html(study, "bare")
    found = titles(text)
    assert not set(LOADED) & set(found) and set(ALWAYS) <= set(found)
    missing = lxml.html.document_fromstring(text).xpath("//h2[text()='What could not be computed']/following::ul[1]/li/text()")
    assert missing and all(any(reason in each for each in missing) for reason in study.why_not.values())
    assert "Load sharing:" not in text and "Torques:" not in text


@pytest.mark.parametrize("torque", [0.0, -300.0])
def test_trains_without_torque_and_driven_back_have_a_report(torque: float) -> None:
    text = planetary_html(study_planetary(_weighed(TRAINS["A"]), TrainLoad(torque=torque, speed=900.0)), "A")
    assert set(ALWAYS) <= set(titles(text))
    assert ("Load sharing" in titles(text)) == bool(torque)


@pytest.mark.parametrize("planets", [1, 2])
def test_few_planets_have_a_report(planets: int) -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), planets)
    text = planetary_html(study_planetary(_weighed(train), TrainLoad(torque=100.0, speed=0.0)), "few")
    words = [row[0] for row in table(text, "quantity,symbol,value,unit,source")]
    assert any(each.startswith("room between tips") for each in words) == (planets > 1)


@pytest.mark.long
def test_a_differential_has_no_efficiency_from_end_to_end() -> None:
    study = starter("differential")
    text = planetary_html(study, "differential")
    assert "it is a differential" in text and "The ratio" not in text
    assert "all power that goes out over all that goes in" in text
    locked = replace(study, why_not={})
    assert planetary_html(locked, "differential") == text


@pytest.mark.long
def test_loads_over_speed_are_there_where_they_were_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the method itself: a mean alone shakes nothing."""
    monkeypatch.setitem(METHODS, QUICK, OWN)
    train = _weighed(TRAINS["A"])
    options = DynamicsOptions(stiffness=QUICK, speeds=5, speed_from=1500.0, speed_to=2500.0, harmonics=2)
    study = study_planetary(train, TrainLoad(torque=100.0, speed=2000.0), dynamics=options, response=True)
    assert study.response is not None
    text = planetary_html(study, "A")
    assert "Loads over speed" in titles(text)
    most = study.response.greatest_in_operation
    assert f"is {most.factor:.3f} times that at rest, in {most.mesh} at" in " ".join(text.split())


def test_many_planets_are_not_listed_in_a_line() -> None:
    train = _weighed(simple_train((159, 21, -201), (0.0, 0.0, 0.0), 20))
    text = planetary_html(study_planetary(train), "many")
    (angles,) = [row for row in table(text, "quantity,symbol,value,unit,source") if row[0] == "angles of the planets"]
    assert angles[2] == "0, 18, ..., 342"
    assert "sun-planet: planets are out of phase." in text
    assert len(table(text, "mesh,planet")) == 2 * 20


@pytest.mark.parametrize("kind", TRAINS)
def test_teeth_stand_in_the_order_of_the_name_of_their_mesh(kind: str) -> None:
    """Where the planet is the smaller gear it is the pinion of the pair."""
    train = TRAINS[kind]
    teeth = [row[1] for row in mesh_table(train).rows]
    assert teeth == [f"{mesh.central.gear.teeth} / {mesh.rim.gear.teeth}" for mesh in train.meshes]
