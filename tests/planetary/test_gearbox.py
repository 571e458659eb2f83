"""Gearboxes of several sets: printed ratios, Willis by hand, exact elimination, virtual work, and the balance of losses."""

import csv
import itertools
import json
import random
import re
from fractions import Fraction
from pathlib import Path

import pytest
from click.testing import CliRunner
from support.planetary_trains import TRAINS

import gearcad
from gearcad.cli import main
from gearcad.core.errors import GeometryError, ParameterError, SolverError
from gearcad.designs import PlanetaryGearboxDesign, open_table
from gearcad.jobs.gearbox import PlanetaryGearbox
from gearcad.planetary.gearbox import Gearbox, GearboxState, StateResult
from gearcad.planetary.gearbox_sets import MemberSet, SetCentral, SetPlanet
from gearcad.planetary.members import TrainLoad
from gearcad.planetary.power import power_flow

SPEC = """
[planetary]
input = "input"
output = "p4.carrier"
mesh_efficiency = 0.99
joined = [
  ["p1.sun", "p2.sun"], ["p1.carrier", "p4.ring"], ["p2.ring", "p3.sun"], ["p3.ring", "p4.sun"], ["input", "p2.carrier"]
]
set = [
  { name = "p1", sun.teeth = 48, ring.teeth = -96, planet = [{ teeth = 24 }] },
  { name = "p2", sun.teeth = 48, ring.teeth = -96, planet = [{ teeth = 24 }] },
  { name = "p3", sun.teeth = 69, ring.teeth = -111, planet = [{ teeth = 21 }] },
  { name = "p4", sun.teeth = 23, ring.teeth = -85, planet = [{ teeth = 31 }] },
]

[planetary.states]
1 = { held = ["p1.sun", "p1.ring"], joined = [["p4.sun", "input"]] }
2 = { held = ["p1.sun", "p1.ring"], joined = [["p3.sun", "p3.ring"]] }
3 = { held = ["p1.ring"], joined = [["p4.sun", "input"], ["p3.sun", "p3.ring"]] }
4 = { held = ["p1.ring"], joined = [["p3.carrier", "p4.carrier"], ["p3.sun", "p3.ring"]] }
5 = { held = ["p1.ring"], joined = [["p4.sun", "input"], ["p3.carrier", "p4.carrier"]] }
6 = { joined = [["p4.sun", "input"], ["p3.carrier", "p4.carrier"], ["p3.sun", "p3.ring"]] }
7 = { held = ["p1.sun"], joined = [["p4.sun", "input"], ["p3.carrier", "p4.carrier"]] }
8 = { held = ["p1.sun"], joined = [["p3.carrier", "p4.carrier"], ["p3.sun", "p3.ring"]] }
R = { held = ["p1.sun", "p1.ring"], joined = [["p3.carrier", "p4.carrier"]] }
"""
"""The ZF 8HP45: teeth, members and shift elements as published in encyclopedias of automatic transmissions."""

PRINTED = dict(zip("12345678R", (4.696, 3.130, 2.104, 1.667, 1.285, 1.000, 0.839, 0.667, -3.297), strict=True))
"""Ratios that ZF states for it, with three decimals."""


def simple(name: str, sun: int, ring: int) -> MemberSet:
    centrals = (SetCentral(name="sun", teeth=sun, meshes="planet"), SetCentral(name="ring", teeth=-ring, meshes="planet"))
    return MemberSet(name=name, centrals=centrals, planets=(SetPlanet(name="planet", teeth=(ring - sun) // 2),))


def ravigneaux(name: str, small: int, large: int, ring: int, short: int, long: int) -> MemberSet:
    centrals = (
        SetCentral(name="small", teeth=small, meshes="short"),
        SetCentral(name="large", teeth=large, meshes="long"),
        SetCentral(name="ring", teeth=-ring, meshes="long"),
    )
    planets = SetPlanet(name="long", teeth=long), SetPlanet(name="short", teeth=short, meshes="long")
    return MemberSet(name=name, centrals=centrals, planets=planets)


def stepped(name: str, sun: int, first: int, second: int, ring: int) -> MemberSet:
    centrals = SetCentral(name="sun", teeth=sun, meshes="first"), SetCentral(name="ring", teeth=-ring, meshes="second")
    planets = SetPlanet(name="first", teeth=first), SetPlanet(name="second", teeth=second, beside="first")
    return MemberSet(name=name, centrals=centrals, planets=planets)


def gearbox(sets: list[MemberSet], entering: str, leaving: str, state: GearboxState, **more: object) -> Gearbox:
    return Gearbox(name="box", sets=tuple(sets), input=entering, output=leaving, states=(state,), **more)  # type: ignore[arg-type]


def test_ratios_of_a_gearbox_of_four_sets_are_those_that_are_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("8hp.toml").write_text(SPEC, encoding="utf-8")
    done = CliRunner().invoke(main, ["planetary", "8hp.toml", "--json"])
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    assert {name: round(each["ratio"], 3) for name, each in document["states"].items()} == PRINTED
    assert document == json.loads(Path("output/8hp/planetary.json").read_text(encoding="utf-8"))
    told = CliRunner().invoke(main, ["planetary", "8hp.toml"]).stdout
    assert "4.6957" in told and "98.43 %" in told
    for state in document["states"].values():
        assert sum(torque for torque in state["torques"].values()) == pytest.approx(0, abs=1e-9)


def test_a_simpson_gearbox_by_hand() -> None:
    """Two like sets with one sun: first by Willis of both, second by the first set alone."""
    sets, z = [simple("front", 30, 66), simple("rear", 30, 66)], Fraction(66, 30)
    both = (("front.sun", "rear.sun"), ("front.carrier", "rear.ring"))
    states = {"first": ("rear.carrier",), "second": ("front.sun",)}
    found = {
        name: gearbox(sets, "front.ring", "rear.ring", GearboxState(name=name, held=held), joined=both).state(name).ratio
        for name, held in states.items()
    }
    assert found["first"] == pytest.approx(float((1 + 2 * z) / z), rel=1e-12)
    assert found["second"] == pytest.approx(float((1 + z) / z), rel=1e-12)
    state = GearboxState(name="reverse", held=("rear.carrier",))
    assert gearbox(sets, "front.sun", "rear.ring", state, joined=both).state("reverse").ratio == pytest.approx(
        -float(z), rel=1e-12
    )


def test_a_ravigneaux_set_by_hand() -> None:
    each = ravigneaux("r", 26, 34, 74, 19, 20)
    wanted = {
        ("r.small", ("r.carrier",)): Fraction(74, 26),
        ("r.large", ("r.carrier",)): Fraction(-74, 34),
        ("r.carrier", ("r.large",)): Fraction(74, 74 + 34),
        ("r.small", ("r.large",)): Fraction(74 * (26 + 34), 26 * (74 + 34)),
    }
    for (entering, held), ratio in wanted.items():
        found = gearbox([each], entering, "r.ring", GearboxState(name="it", held=held)).state("it")
        assert found.ratio == pytest.approx(float(ratio), rel=1e-12)


@pytest.mark.parametrize("efficiency", [1.0, 0.98])
@pytest.mark.parametrize("kind", ["A", "B"])
def test_one_set_has_the_power_flow_of_a_planetary_train(kind: str, efficiency: float) -> None:
    train = TRAINS[kind]
    a, b = train.meshes
    teeth = {mesh.central: (mesh.pair.gears.pick(mesh.central_role).teeth, mesh.rim.gear.teeth) for mesh in (a, b)}
    (sun, first), (ring, second) = teeth[a.central], teeth[b.central]
    planets = (SetPlanet(name="first", teeth=first), SetPlanet(name="second", teeth=second, beside="first"))
    centrals = (SetCentral(name="a", teeth=sun, meshes="first"), SetCentral(name="b", teeth=ring, meshes="second"))
    names = {train.centrals[0].name: "s.a", train.centrals[1].name: "s.b", train.carrier.name: "s.carrier"}
    load = TrainLoad(input_torque=1.0, speed=100.0, mesh_efficiency=efficiency)
    flow = power_flow(train, load)
    state = GearboxState(name="it", held=(names[train.fixed],))  # type: ignore[index]
    box = gearbox(
        [MemberSet(name="s", centrals=centrals, planets=planets)],
        names[train.input],
        names[train.output],
        state,
        mesh_efficiency=efficiency,
    )
    found = box.state("it")
    assert found.ratio == pytest.approx(train.ratio, rel=1e-12)
    assert found.efficiency == pytest.approx(flow.efficiency, rel=1e-12)
    for name, own in names.items():
        assert found.torques[own] == pytest.approx(flow.torques[name], rel=1e-9)


def _random_state(seed: int) -> tuple[Gearbox, StateResult]:
    """Return a random gearbox of two or three sets in a state in which it can run."""
    rng = random.Random(seed)
    while True:
        sets = []
        for number in range(rng.choice((2, 3))):
            sun, planet = rng.randint(18, 40), rng.randint(15, 40)
            name = f"set{number}"
            kind = rng.randrange(3)
            if kind == 0:
                sets.append(simple(name, sun, sun + 2 * planet))
            elif kind == 1:
                sets.append(ravigneaux(name, sun, sun + rng.randint(3, 9), sun + 2 * planet, rng.randint(15, 30), planet))
            else:
                sets.append(stepped(name, sun, planet, rng.randint(15, 40), sun + planet + rng.randint(15, 40)))
        members = [name for each in sets for name in each.members]
        across = [rng.choice(each.members) for each in sets]
        groups = [tuple(pair) for pair in itertools.pairwise(across)]
        others = [name for name in members if name not in across]
        if len(sets) > 1:
            groups.append(tuple(rng.sample(others, 2)))
        held, clutched = tuple(rng.sample(members, rng.choice((1, 1, 2)))), rng.choice(((), (tuple(rng.sample(members, 2)),)))
        entering, leaving = rng.sample(members, 2)
        efficiency = rng.choice((1.0, 0.995))
        try:
            box = gearbox(
                sets,
                entering,
                leaving,
                GearboxState(name="it", held=held, joined=clutched),
                joined=tuple(groups),
                mesh_efficiency=efficiency,
            )
            found = box.state("it")
        except (GeometryError, SolverError):
            continue
        if all(torque is not None for torque in (*found.torques.values(), *found.clutches.values(), *found.rolling.values())):
            return box, found


def _exact_motions(box: Gearbox, *, held: bool) -> list[dict[str, Fraction]]:
    """Return a basis of the motions of all bodies, by exact elimination; with the brakes open if not `held`."""
    names = sorted(
        {name for mesh in box.meshes for name in mesh[1:6] if isinstance(name, str)} | {*box.members, box.input, box.output}
    )
    place = {name: number for number, name in enumerate(names)}
    state = box.states[0]
    rows: list[list[Fraction]] = []

    def equation(*terms: tuple[str, int]) -> None:
        row = [Fraction(0)] * len(names)
        for name, factor in terms:
            row[place[name]] += factor
        rows.append(row)

    for mesh in box.meshes:
        both = mesh.first_teeth + mesh.second_teeth
        equation((mesh.first, mesh.first_teeth), (mesh.second, mesh.second_teeth), (mesh.carrier, -both))
    for group in (*box.joined, *state.joined):
        for first, second in itertools.pairwise(group):
            equation((first, 1), (second, -1))
    for name in state.held if held else ():
        equation((name, 1))
    pivots: list[int] = []
    for column in range(len(names)):
        at = len(pivots)
        found = next((row for row in range(at, len(rows)) if rows[row][column]), None)
        if found is None:
            continue
        rows[at], rows[found] = rows[found], rows[at]
        rows[at] = [value / rows[at][column] for value in rows[at]]
        for row in range(len(rows)):
            if row != at and rows[row][column]:
                rows[row] = [value - rows[row][column] * own for value, own in zip(rows[row], rows[at], strict=True)]
        pivots.append(column)
    motions = []
    for free in (column for column in range(len(names)) if column not in pivots):
        motion = [Fraction(0)] * len(names)
        motion[free] = Fraction(1)
        for row, column in enumerate(pivots):
            motion[column] = -rows[row][free]
        motions.append(dict(zip(names, motion, strict=True)))
    return motions


@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(60, 1000), marks=pytest.mark.long)], ids=["60", "1000"])
def test_random_states_by_exact_elimination_virtual_work_and_the_balance_of_losses(seeds: range) -> None:
    for seed in seeds:
        box, found = _random_state(seed)
        (motion,) = _exact_motions(box, held=True)
        exact = {name: speed / motion[box.input] for name, speed in motion.items()}
        for name, speed in found.speeds.items():
            assert speed == pytest.approx(float(exact[name]), abs=1e-11 * max(1.0, *map(abs, found.speeds.values()))), seed
        sizes = max(abs(torque) for torque in found.torques.values() if torque is not None)
        if box.mesh_efficiency == 1:
            for other in _exact_motions(box, held=False):  # with the brakes open, torques from outside do no work
                work = sum(torque * float(other[name]) for name, torque in found.torques.items())  # type: ignore[operator]
                assert work == pytest.approx(0, abs=1e-9 * sizes * max(map(abs, map(float, other.values())))), seed
            assert found.efficiency == pytest.approx(1, rel=1e-9), seed
        lost = sum(power for power in found.rolling.values() if power is not None) * (1 - box.mesh_efficiency)
        assert 1 - found.efficiency == pytest.approx(lost, abs=1e-9 * max(1.0, sizes)), seed


def test_planets_beside_each_other_lead_to_one_body() -> None:
    planets = SetPlanet(name="a", teeth=20, beside="b"), SetPlanet(name="b", teeth=21, beside="a")
    with pytest.raises(ParameterError, match=r"s\.a\.beside = 'b': must not lead back to itself"):
        MemberSet(name="s", centrals=(SetCentral(name="sun", teeth=24, meshes="a"),), planets=planets)


def test_states_that_cannot_be() -> None:
    each = [simple("s", 24, 66)]
    with pytest.raises(GeometryError, match=r"states\.it = 'nothing held or joined': must leave one speed free, and leaves 2"):
        gearbox(each, "s.sun", "s.carrier", GearboxState(name="it")).state("it")
    with pytest.raises(GeometryError, match="must let the input turn: hold or join fewer members"):
        gearbox(each, "s.sun", "s.carrier", GearboxState(name="it", held=("s.ring", "s.carrier"))).state("it")
    with pytest.raises(GeometryError, match="must let the output turn"):
        gearbox(each, "s.sun", "s.ring", GearboxState(name="it", held=("s.ring",))).state("it")
    with pytest.raises(ParameterError, match=r"states\.it\.held = 's\.rim': must be a shaft without a dot, or one"):
        gearbox(each, "s.sun", "s.ring", GearboxState(name="it", held=("s.rim",)))
    with pytest.raises(ParameterError, match="state = '2': must be one of it"):
        gearbox(each, "s.sun", "s.carrier", GearboxState(name="it", held=("s.ring",))).state("2")


def test_a_gearbox_that_locks_itself() -> None:
    """Two rings of nearly one size on stepped planets: driven backwards, friction takes more than all."""
    planets = SetPlanet(name="first", teeth=30), SetPlanet(name="second", teeth=31, beside="first")
    centrals = SetCentral(name="a", teeth=-90, meshes="first"), SetCentral(name="b", teeth=-92, meshes="second")
    sets = [MemberSet(name="s", centrals=centrals, planets=planets)]
    state = GearboxState(name="it", held=("s.a",))
    assert gearbox(sets, "s.carrier", "s.b", state, mesh_efficiency=0.98).state("it").efficiency == pytest.approx(0.2, abs=0.2)
    with pytest.raises(SolverError, match="the gearbox locks itself"):
        gearbox(sets, "s.b", "s.carrier", state, mesh_efficiency=0.98).state("it")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('name = "p1", ', "", r"planetary\.set\[0\]\.name is missing: a name"),
        ("sun.teeth = 69", "sun.teeth = 2", r"planetary\.set\[2\]\.sun\.teeth = 2: must be a whole number from 3 to 2000"),
        (
            "ring.teeth = -111",
            "ring.tooth = -111",
            r"planetary\.set\[2\]\.ring\.tooth: unknown key; permitted are teeth, meshes",
        ),
        ("planet = [{ teeth = 31 }]", "planet = []", r"meshes is missing: the planet that it meshes with"),
        (
            'name = "p1", ',
            'name = "p1", carrier = 3, ',
            r"planetary\.set\[0\]\.carrier = 3: must be a name, in quotation marks",
        ),
        ("ring.teeth = -111", "ring.teeth = -111, ring.meshes = [1]", r"set\[2\]\.ring\.meshes = \[1\]: must be a name"),
        ('held = ["p1.sun"]', 'held = "p1.sun"', r"must be names in brackets"),
        ("mesh_efficiency = 0.99", "mesh_efficiency = 1.2", r"planetary\.mesh_efficiency = 1\.2: must be .*at most 1"),
        ('output = "p4.carrier"', 'output = "p5.carrier"', r"planetary\.output = 'p5\.carrier': must be a shaft without a dot"),
    ],
)
def test_wrong_input_is_one_line(old: str, new: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert old in SPEC
    Path("8hp.toml").write_text(SPEC.replace(old, new), encoding="utf-8")
    done = CliRunner().invoke(main, ["planetary", "8hp.toml"])
    assert done.exit_code == 2 and re.search(message, done.stderr), done.stderr
    assert done.stderr.startswith("Error: 8hp.toml") and done.stderr.count("\n") == 1 and not Path("output").exists()


def test_other_commands_say_which_reads_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("8hp.toml").write_text(SPEC, encoding="utf-8")
    reads = "a gearbox of planetary sets is for `gearcad planetary`, data and build"
    for verb in ("draw", "check", "mesh", "rate", "stiffness", "dynamics", "modify", "shafts", "verify", "picture"):
        done = CliRunner().invoke(main, [verb, "8hp.toml"])
        assert done.exit_code == 2 and done.stderr.endswith(f"{reads}\n") and done.stderr.count("\n") == 1, (verb, done.stderr)
    no_table = "a gearbox of planetary sets has no page and no such table: use `gearcad planetary` or a column gearbox"
    done = CliRunner().invoke(main, ["study", "8hp.toml", "--vary", "mesh_efficiency=0.98,0.99", "-o", "t.csv"])
    assert done.exit_code == 2 and done.stderr.endswith(f"planetary.set: {no_table}\n") and done.stderr.count("\n") == 1
    assert not Path("output").exists()


def test_a_design_table_changes_values_of_a_spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ratios of the first state by Willis: p1 stands still with p4's ring, so it is 1 + 85/z of p4's sun."""
    monkeypatch.chdir(tmp_path)
    Path("8hp.toml").write_text(SPEC, encoding="utf-8")
    heading = "name,gearbox,set[3].sun.teeth,states.1.held,mesh_efficiency\n"
    rows = ["plain,8hp.toml,,,", "other,8hp.toml,25,,0.98", 'held,8hp.toml,,"[""p1.ring"", ""p1.sun""]",']
    Path("boxes.csv").write_text(heading + "\n".join(rows) + "\n", encoding="utf-8")
    found = [row.design() for row in open_table("boxes.csv").rows()]
    for design, teeth in zip(found, (23, 25, 23), strict=True):
        assert isinstance(design, PlanetaryGearboxDesign)
        assert design.gearbox.state("1").ratio == pytest.approx(1 + 85 / teeth, rel=1e-12)
    assert isinstance(found[1], PlanetaryGearboxDesign) and found[1].gearbox.mesh_efficiency == 0.98
    assert [design.name for design in found] == ["plain", "other", "held"]
    done = CliRunner().invoke(main, ["batch", "boxes.csv", "--do", "data,planetary", "-j", "1"])
    assert done.exit_code == 0, done.stderr
    with Path("output/boxes/results.csv").open(encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    assert [float(each["planetary.1.ratio"]) for each in lines] == pytest.approx([1 + 85 / 23, 1 + 85 / 25, 1 + 85 / 23])
    again = CliRunner().invoke(main, ["batch", "boxes.csv", "--do", "data,planetary", "-j", "1"])
    assert again.exit_code == 0
    with Path("output/boxes/results.csv").open(encoding="utf-8") as file:
        assert [each["seconds"] for each in csv.DictReader(file)] == ["", "", ""]  # nothing was made again


@pytest.mark.parametrize(
    ("heading", "cell", "message"),
    [
        (
            "set[3].sun.teeth",
            "2",
            r"boxes\.csv row 2 column C \(it\): planetary\.set\[3\]\.sun\.teeth = 2: must be a whole number",
        ),
        ("set[7].sun.teeth", "20", r"planetary\.set\[7\]\.sun\.teeth: the spec of the gearbox has no such place"),
        ("input.teeth", "20", r"planetary\.input\.teeth: the spec of the gearbox has no such place"),
        ("colour", "red", r"column C \(it\): planetary\.colour: unknown key; permitted are name, input"),
        ("states.1.held", "[p1", r"planetary\.states\.1\.held: is not valid TOML"),
        ("gearbox", "none.toml", r"none\.toml: cannot be read"),
        ("gearbox", "pair.toml", r"must be the spec of a gearbox of planetary sets"),
    ],
)
def test_wrong_rows_say_where(heading: str, cell: str, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("8hp.toml").write_text(SPEC, encoding="utf-8")
    Path("pair.toml").write_text("[gear]\nteeth = 20\n", encoding="utf-8")
    columns, cells = (
        ("name,gearbox", f"it,{cell}") if heading == "gearbox" else (f"name,gearbox,{heading}", f"it,8hp.toml,{cell}")
    )
    Path("boxes.csv").write_text(f"{columns}\n{cells}\n", encoding="utf-8")
    (row,) = open_table("boxes.csv").rows()
    (fault,) = row.all_faults()
    assert re.search(message, fault) and "\n" not in fault, fault


def test_the_job_in_python_and_the_data_sheet(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("8hp.toml").write_text(SPEC, encoding="utf-8")
    design = gearcad.read("8hp.toml")
    assert isinstance(design, PlanetaryGearboxDesign)
    for subject in (design, design.gearbox):
        study = gearcad.planetary(subject)
        assert {name: round(each.ratio, 3) for name, each in study.states.items()} == PRINTED
    with pytest.raises(ParameterError, match="must be left out: the states of a gearbox have no load"):
        gearcad.planetary(design, TrainLoad(input_torque=1.0))  # type: ignore[call-overload]
    job = PlanetaryGearbox()
    document = job.complete_document(job.run(design))
    assert [document[key] for key in ("passed", "strength", "not_judged", "warnings")] == [None, None, [], []]
    assert job.write(job.run(design), Path("found")) == [Path("found/planetary.json")]
    data = gearcad.data(design)
    assert data["kind"] == "planetary_gearbox" and data["planetary"]["sets"]["p4"]["centrals"]["ring"]["teeth"] == -85
    sheet = CliRunner().invoke(main, ["data", "8hp.toml"]).stdout
    assert "gearbox of 4 planetary sets" in sheet and "z = -111, meshes planet" in sheet and "held: p1.sun, p1.ring" in sheet
