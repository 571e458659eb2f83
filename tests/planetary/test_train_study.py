"""The study of a planetary train: from a spec to its numbers, and what is said where one cannot be had."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import pytest
from support.batches import read_results
from support.commands import read_json, run
from support.planetary_trains import simple_set
from support.specs import TEMPLATES

import gearcad
from gearcad.core.errors import ParameterError
from gearcad.core.records import Notice, joined
from gearcad.designs import PlanetaryDesign, read_spec
from gearcad.dynamics.planetary.planetary_excitation import QUICK
from gearcad.dynamics.planetary.planetary_result import PARTS, PlanetaryStudy
from gearcad.jobs.planetary import Planetary, Studied
from gearcad.planetary import TrainLoad
from gearcad.rating.options import RatingOptions
from gearcad.stiffness.methods import METHODS


def starter(name: str) -> PlanetaryDesign:
    design = read_spec(TEMPLATES / f"planetary-{name}.toml")
    assert isinstance(design, PlanetaryDesign)
    return design


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mean mesh stiffnesses in place of computed courses."""
    monkeypatch.setitem(METHODS, QUICK, METHODS["iso6336"])


@pytest.fixture(scope="module")
def alm() -> Studied:
    """The thesis's train, its two meshes 0.99 together as in the reference."""
    design = starter("alm")
    load = replace(design.load, mesh_efficiency=0.99**0.5)
    return Planetary().run(replace(design, load=load))


def test_the_train_of_the_alm_thesis(alm: Studied) -> None:
    """Own reference: i = -124.2807, i_0 = 1.0775510, 0.886 of the set; the pre-stage loses as one mesh."""
    study = alm.study
    assert study.why_not == {}
    assert study.train.ratio == pytest.approx(-124.2807, abs=5e-5)
    flow, forces = study.flow, study.forces
    assert flow is not None and flow.efficiency is not None and forces is not None
    assert flow.efficiency == pytest.approx(0.886 * 0.99**0.5, abs=5e-4)
    assert forces.meshes["ring_5-rim_3p"].normal == pytest.approx(6063.69, abs=5e-3)
    assert study.phases["ring_5-rim_3p"].relative == pytest.approx((0, 0, 0), abs=1e-9)
    assert sorted(study.phases["ring_4-rim_3"].relative) == pytest.approx((0, 1 / 3, 2 / 3), abs=1e-9)


def test_resonances_are_where_harmonics_meet_modes(alm: Studied) -> None:
    campbell, modes = alm.study.campbell, alm.study.modes
    assert campbell is not None and modes is not None and alm.study.response is None
    assert campbell.highest_speed == pytest.approx(2 * 954.93)
    pinion_to_ring = 954.93 / 60 * 18 / 161 * 70  # Hz of the mesh of ring 4, which stands, at the speed of the load
    lines = {(line.source, line.harmonic): line.per_rpm for line in campbell.lines}
    assert lines["ring_4-rim_3", 1] * 954.93 == pytest.approx(pinion_to_ring)
    lowest = min(each.speed for each in campbell.excited)
    assert lowest * lines["ring_4-rim_3", 6] <= modes.frequency.max()


@pytest.mark.long
def test_the_response_is_there_if_it_is_asked_for() -> None:
    """Some 10 s."""
    study = gearcad.planetary(starter("differential"), response=True)
    assert study.response is not None
    most = study.response.greatest_in_operation
    assert 1 < most.factor < 2 and most.speed > 0


@pytest.mark.usefixtures("no_pictures")
def test_the_document_has_what_the_design_promises(alm: Studied, tmp_path: Path) -> None:
    job = Planetary()
    files = job.write(alm, tmp_path)
    specs = ["ring_4-rim_3.toml", "ring_5-rim_3p.toml", "pre_stage.toml"]
    names = ["planetary.html", "data.json", "planetary.json", *specs]
    assert [file.name for file in files] == names

    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    document = json.loads((tmp_path / "planetary.json").read_text(encoding="utf-8"), parse_constant=refuse)
    wanted = "kind ratio efficiency members planet_angles phases forces torsional_stiffness load_sharing frequencies gears"
    assert set(wanted.split()) <= set(document)
    assert document["members"]["ring_5"] == {
        "speed": pytest.approx(954.93 / -124.2807, rel=1e-6),
        "torque": 1600.0,
        "role": "output",
    }
    assert set(document["frequencies"][0]) == {"frequency", "kind", "multiplicity"}
    data = json.loads((tmp_path / "data.json").read_text(encoding="utf-8"), parse_constant=refuse)
    assert document["gears"] == {name: data[name] for name in alm.design.gears}
    assert data["planetary"]["basic_ratio"] == pytest.approx(1.0775510, abs=5e-8)
    assert list(data["planetary"]["meshes"]) == ["ring_4-rim_3", "ring_5-rim_3p"]


@pytest.mark.usefixtures("no_pictures")
def test_specs_of_the_meshes_are_those_of_the_train_at_its_load(alm: Studied, tmp_path: Path) -> None:
    Planetary().write(alm, tmp_path)
    pair = read_spec(tmp_path / "ring_5-rim_3p.toml")
    loads, sharing = alm.study.loads, alm.study.sharing
    assert loads is not None and sharing is not None
    assert pair.pair == replace(alm.study.train.meshes[1].pair, name=pair.name)
    assert pair.load == loads["ring_5-rim_3p"].load
    assert pair.load.application_factor == pytest.approx(sharing.mesh_load_factor)


@pytest.mark.usefixtures("quick")
def test_what_is_not_given_is_named_and_the_rest_is_there() -> None:
    study = gearcad.planetary(simple_set())
    assert isinstance(study, PlanetaryStudy)
    assert study.train.ratio == 3.75
    speed = "no speed is given: that of sun stands in [load], others in [planetary.speeds]"
    assert {part: why for part, why in study.why_not.items() if why == speed}.keys() == {
        "speeds", "power", "loads", "sharing", "forces", "rating", "running", "campbell"
    }  # fmt: skip
    assert "load.output_torque" in study.why_not["torsion"]
    assert study.stiffness is not None and all(mesh.nominal for mesh in study.stiffness.values())
    assert set(study.why_not) <= set(PARTS)
    told = {notice.text: notice.where for notice in study.notices if notice.code == "not-computed"}
    assert list(told) == list(dict.fromkeys(study.why_not.values()))
    assert told[speed].startswith("no speeds, torques and efficiency, ")
    weighed = gearcad.planetary(simple_set(rim_diameter=160.0), TrainLoad(torque=100, speed=1000))
    inertia = "carrier.inertia is missing: must be given in kg·m²: without it there are no dynamics"
    assert weighed.why_not == {"modes": inertia, "campbell": inertia}
    assert weighed.sharing is not None


@pytest.mark.usefixtures("quick")
def test_a_differential_needs_a_second_speed() -> None:
    train, load = simple_set(30, 18, planets=4, fixed=None), TrainLoad(torque=300, speed=1500)
    alone = gearcad.planetary(train, load)
    assert alone.speeds is None and alone.flow is None
    assert alone.why_not["speeds"] == (
        "a second speed is needed, as no member is fixed: of ring, carrier, in [load] or [planetary.speeds]"
    )
    study = gearcad.planetary(train, load, speeds={"ring": -300})
    assert study.speeds is not None
    turning = study.speeds.members  # 96 n_c = 30 n_s + 66 n_r
    assert 96 * turning["carrier"] == pytest.approx(30 * turning["sun"] + 66 * turning["ring"])
    both = gearcad.planetary(train, TrainLoad(torque=300), speeds={"carrier": turning["carrier"], "ring": -300})
    assert both.speeds is not None and both.speeds.members == pytest.approx(turning)
    assert both.flow is not None and study.flow is not None
    assert both.flow.torques == pytest.approx(study.flow.torques)
    assert both.flow.torques["sun"] == pytest.approx(300 / (1 + 66 / 30))  # without losses


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"sun": 10.0}, "speeds.sun = 10 rpm: must not be given too: load.speed is that of sun"),
        ({"carrier": 10.0}, "must not be given too"),
        ({"moon": 10.0}, "moon"),
    ],
)
def test_speeds_that_contradict_each_other_are_refused(given: dict[str, float], words: str) -> None:
    with pytest.raises(ParameterError) as caught:
        gearcad.planetary(simple_set(), TrainLoad(torque=100, speed=1000), speeds=given)
    assert words in str(caught.value)


@pytest.mark.usefixtures("quick")
def test_a_speed_of_any_member_will_do() -> None:
    study = gearcad.planetary(simple_set(), TrainLoad(torque=100), speeds={"carrier": 400.0})
    assert study.load is not None and study.load.speed == pytest.approx(1500.0)


@pytest.mark.usefixtures("quick")
def test_what_is_given_in_place_of_the_designs_own() -> None:
    design = starter("24-21-66")
    rated = gearcad.planetary(design, rating=RatingOptions(accuracy_grade=9)).rating
    assert rated is not None and list(rated.meshes) == ["sun-planet", "ring-planet"]
    with pytest.raises(ParameterError, match=r"^load = .*: must be a TrainLoad$"):
        gearcad.planetary(design, gearcad.Load(torque=3))  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="must be a planetary train: only planets go round"):
        gearcad.planetary(read_spec(TEMPLATES / "volvo-13-44.toml"))


@pytest.mark.usefixtures("quick", "no_pictures")
def test_the_command_shows_the_figures_and_writes_the_files(tmp_path: Path) -> None:
    spec = TEMPLATES / "planetary-24-21-66.toml"
    result = run("planetary", str(spec), "-o", str(tmp_path), "--quiet")
    lines = {line[:22].strip(): line[22:].split() for line in result.stdout.splitlines()}
    assert lines["set"][:2] == ["type", "A,"] and lines["set"][-3:] == ["i", "=", "3.75"]
    assert lines["sun"] == ["1500", "54.123", "8501.6", "input"]
    assert lines["carrier"] == ["400", "-200", "-8377.6", "output"]
    assert lines["efficiency"][0] == "98.54"
    assert (tmp_path / "sun-planet.toml").exists()
    assert run("planetary", status=2).stderr.startswith("Error: spec is missing: must be given")
    assert json.loads(run("planetary", str(spec), "-o", str(tmp_path), "--json", "--quiet").stdout)["ratio"] == 3.75


@pytest.mark.usefixtures("quick", "no_pictures")
def test_the_screen_says_who_drives_a_differential(tmp_path: Path) -> None:
    """The carrier turns at (30·1500 + 66·300)/96; sun and ring put power in, as the starter says."""
    spec = TEMPLATES / "planetary-differential.toml"
    result = run("planetary", str(spec), "-o", str(tmp_path), "--quiet")
    lines = {line[:22].strip(): line[22:].split() for line in result.stdout.splitlines()}
    assert lines["sun"][3:] == ["input,", "drives"] and lines["ring"][3:] == ["drives"]
    assert lines["carrier"] == ["675", "-300", "-21206", "output,", "is", "driven"]
    assert float(lines["sun"][2]) + float(lines["ring"][2]) == pytest.approx(21206 / 0.9924, rel=1e-4)


def test_equal_notices_are_told_once_with_their_places() -> None:
    one, other = Notice("rigid", "taken for rigid"), Notice("rigid", "soft")
    found = joined([one.within("a"), other.within("a"), one.within("b"), one.within("a"), other])
    assert list(map(str, found)) == ["a, b: taken for rigid", "a: soft"]


@pytest.mark.usefixtures("quick", "no_pictures")
def test_without_a_speed_torques_are_known_and_nothing_is_said_to_stand(tmp_path: Path) -> None:
    text = (TEMPLATES / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    spec = tmp_path / "slow.toml"
    spec.write_text(text.replace("\nspeed = ", "\n# speed = "), encoding="utf-8")
    result = run("planetary", str(spec), "-o", str(tmp_path / "out"), "--quiet")
    lines = {line[:22].strip(): line[22:].split() for line in result.stdout.splitlines()}
    assert lines["sun"] == ["-", "54.123", "-", "input"] and "planet" not in lines
    document = read_json(tmp_path / "out" / "planetary.json")
    assert {member["speed"] for member in document["members"].values()} == {None}
    page = (tmp_path / "out" / "planetary.html").read_text(encoding="utf-8")
    assert "Speeds and torques" in page and "Lever of the speeds" not in page
    assert document["planet_speed"] is None and "speed of sun" in document["why_not"]["speeds"]


def test_the_data_sheet_has_the_train_and_a_column_for_each_mesh() -> None:
    sheet = run("data", str(TEMPLATES / "planetary-alm.toml")).stdout
    assert sheet.startswith("planetary-alm: planetary train of type D, z = -70 / -72 / 22 / 21 / 18 / 161\n")
    lines = {line[:38].strip(): line[38:].split() for line in sheet.splitlines()}
    assert lines["ratio, speed of input over output"][-1] == "-124.2807"
    assert lines["sum of the profile shifts"] == [
        "Σx",
        "-0.7025",
        "-1.1794",
        "0.5104",
    ]  # the thesis prints the second as x of 5
    assert "ring_4-rim_3 ring_5-rim_3p pre_stage" in " ".join(sheet.split())


@pytest.mark.long
@pytest.mark.usefixtures("quick")
def test_rows_of_a_table_have_the_figures(tmp_path: Path) -> None:
    lines = (TEMPLATES / "planetary-sets.csv").read_text(encoding="utf-8").splitlines()
    heading = next(number for number, line in enumerate(lines) if line.startswith("name,"))
    table = tmp_path / "sets.csv"
    table.write_text("\n".join([lines[heading], lines[heading + 1], lines[heading + 4]]), encoding="utf-8")
    run("batch", str(table), "-o", str(tmp_path / "out"), "--do", "planetary", "-j", "1", "--quiet")
    plain, stepped = read_results(tmp_path / "out")
    assert float(plain["planetary.ratio"]) == 3.75
    assert float(stepped["planetary.ratio"]) == pytest.approx(13.894737, abs=1e-6)
    assert float(plain["planetary.members.carrier.torque"]) == -200.0
    assert float(plain["planetary.meshes.sun-planet.transverse_contact_ratio"]) > 1.2
    document = read_json(tmp_path / "out" / plain["name"] / "planetary.json")
    assert float(plain["planetary.torsional_stiffness"]) == document["torsional_stiffness"]["stiffness"]
    with (tmp_path / "out" / "columns.csv").open(encoding="utf-8", newline="") as file:
        told = {row["column"]: (row["symbol"], row["unit"], row["of"]) for row in csv.DictReader(file)}
    assert told["planetary.members.carrier.torque"] == ("T", "N·m", "carrier")
    assert told["load.output_torque"] == ("T", "N·m", "")
    assert told["planetary.frequency_1"] == ("f_1", "Hz", "") if "planetary.frequency_1" in told else True
    unknown = [name for name, (symbol, unit, _) in told.items() if name.startswith("planetary.") and not (symbol or unit)]
    assert "planetary.ratio" not in unknown and "planetary.mesh_load_factor" not in unknown
