"""`gearcad dynamics` as a user meets it."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from support.commands import invoke, read_json, run
from support.specs import TEMPLATES

PAIR = """
[pair]
normal_module = 2.0
face_width = 20.0
tooth_thinning = 0.05
[pinion]
teeth = 20
body.bore = 12.0
[wheel]
teeth = 30
body.bore = 20.0
[load]
torque = 50.0
speed = 6000.0
[dynamics]
stiffness = "potential-energy"
speeds = 40
"""

TRAIN = (TEMPLATES / "train-1-stage.toml").read_text(encoding="utf-8") + "speeds = 160\n"
FILES = [
    *(f"dynamics.{kind}" for kind in ("html", "json", "npz")),
    *(
        f"dynamics-{table}.csv"
        for table in ("chart", "displacements", "transmission-error", "modes", "component-modes", "course", "course-lines")
    ),
]


@pytest.fixture
def no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its pictures take longer than all that is asked here; tests of reports have them."""
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())


def spec(text: str) -> str:
    Path("it.toml").write_text(text, encoding="utf-8")
    return "it.toml"


@pytest.mark.usefixtures("no_pictures")
def test_a_train(here: Path) -> None:
    """Osinski's one stage: component modes of the paper, and the peak that an isolated pair does not have."""
    result = run("dynamics", spec(TRAIN), "--quiet")
    assert result.stdout.splitlines()[-10:] == [f"output/train-1-stage/{file}" for file in FILES]
    document = read_json("output/train-1-stage/dynamics.json")
    assert (document["kind"], document["model"]) == ("dynamics", "modes")
    assert document["modes"]["circular"] == pytest.approx([1641.941, 12752.092, 19861.483], abs=1e-3)
    peaks = document["chart"]["peaks"]["mesh"]
    assert max(peak["factor"] for peak in peaks) == pytest.approx(1.55, abs=0.01)
    assert min(abs(peak["frequency"] - 12650) for peak in peaks) < 150
    with np.load("output/train-1-stage/dynamics.npz", allow_pickle=False) as arrays:
        assert (
            arrays["kv"].shape == (len(document["speed"]), 1)
            and len(document["speed"]) >= 160
            and arrays["mode_shape"].shape == (3, 2)
        )
        assert arrays["kv"][:, 0].tolist() == document["chart"]["kv"]["mesh"]


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_the_greatest_factor_where_the_machine_runs_stands_first(here: Path) -> None:
    """A resonance beyond the operating range is none of its headline, nor is the course that is drawn."""
    text = PAIR.replace("speed = 6000.0\n", "") + "operating_from = 600.0\noperating_to = 2900.0\n"
    result = invoke("dynamics", spec(text), "--quiet")
    document = read_json("output/it/dynamics.json")
    operation, speed = document["operation"], np.array(document["speed"])
    inside = (speed >= 600.0) & (speed <= 2900.0)
    most = np.array(document["chart"]["kv"]["mesh"])[inside].max()
    assert (operation["first"], operation["last"], operation["source"]) == (600.0, 2900.0, "operating range")
    assert operation["greatest"]["factor"] == most < 0.8 * document["greatest"]["factor"]
    line = next(line for line in result.stdout.splitlines() if line.startswith("K_v"))
    assert line == f"K_v from 600 to 2900 rpm at most {most:.3f}, of mesh at {operation['greatest']['speed']:.5g} rpm"
    assert document["course"]["speed"] == pytest.approx(operation["greatest"]["speed"])
    assert not any("without effect" in warning for warning in document["warnings"])


@pytest.mark.usefixtures("no_report")
def test_a_new_train_is_sent_to_its_command(here: Path) -> None:
    result = invoke("new", "train-2")
    assert result.stderr == "Next: gearcad dynamics train-2-stage.toml\n"
    assert invoke("dynamics", "train-2-stage.toml", "--quiet").exit_code == 0


@pytest.mark.usefixtures("no_report")
def test_one_word_changes_the_model(here: Path) -> None:
    found = {}
    for model in ("isolated", "massless", "elements", "exact"):
        result = run("dynamics", spec(TRAIN.replace('model = "modes"', f'model = "{model}"')), "--quiet", "--json")
        found[model] = json.loads(result.stdout)["modes"]["circular"]
    assert found["isolated"][-1] == pytest.approx(19245.076, abs=1e-3)
    assert found["massless"] == pytest.approx([1681.679, 19656.795], abs=1e-3)
    assert found["exact"][:5] == pytest.approx(
        [1641.12352431, 10077.48060731, 12708.28743912, 19523.94715846, 20154.95062324], rel=1e-9
    )
    assert found["elements"][:5] == pytest.approx(found["exact"][:5], rel=1e-9)


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_a_pair_without_further_data(here: Path) -> None:
    """Inertias of its own solids, FE contact, K_v of ISO 6336 beside its own; at rest the load is the static one."""
    result = run("dynamics", spec(PAIR.partition("[dynamics]")[0]), "--quiet")
    document = read_json("output/it/dynamics.json")
    radii = (20 * math.cos(math.radians(20)), 30 * math.cos(math.radians(20)))
    inertias = (document["pinion_inertia"], document["wheel_inertia"])
    # Steel discs of the reference diameters, less their bores, within what teeth make of them.
    discs = [math.pi / 32 * (d**4 - b**4) * 20 * 7850e-15 for d, b in ((40, 12), (60, 20))]
    assert inertias == pytest.approx(discs, rel=0.06)
    mass = 1 / sum((radius / 1000) ** 2 / inertia for radius, inertia in zip(radii, inertias, strict=True))
    natural = math.sqrt(1e6 * document["mesh_stiffness_tangent_mean"] / mass) / (2 * math.pi)
    assert document["modes"]["frequency"] == pytest.approx([0.0, natural], rel=1e-6, abs=1e-6)
    assert document["stiffness_method"] == "plane-strain"
    assert document["chart"]["kv"]["mesh"][0] == pytest.approx(1, abs=0.01)
    assert len(document["chart"]["kv_iso6336"]) == len(document["speed"]) >= 1000 and document["resonance_speed_iso6336"] > 1000
    assert f"{document['resonance_speed_iso6336']:.5g} rpm" in result.stdout
    assert document["course"]["speed"] == pytest.approx(6000, rel=1e-12)


@pytest.mark.usefixtures("no_report")
def test_a_small_pair_has_dynamics_without_the_standard(here: Path) -> None:
    """ISO 1328-1 ends at module 0.5: only the comparison with ISO 6336-1 goes, with the reason."""
    small = PAIR.replace(
        "normal_module = 2.0\nface_width = 20.0\ntooth_thinning = 0.05", "normal_module = 0.3\nface_width = 3.0"
    )
    small = small.replace("body.bore = 12.0\n", "").replace("body.bore = 20.0\n", "").replace("torque = 50.0", "torque = 0.05")
    run("dynamics", spec(small + "pinion_inertia = 3e-10\nwheel_inertia = 1.5e-9\n"), "--quiet")
    document = read_json("output/it/dynamics.json")
    assert max(document["chart"]["kv"]["mesh"]) > 1.5
    assert document["chart"]["kv_iso6336"] is None and document["resonance_speed_iso6336"] is None
    assert any("reference_diameter" in each or "normal_module" in each for each in document["warnings"])


def test_a_train_without_teeth(here: Path) -> None:
    """Two discs on a spring: its mode, no chart."""
    discs = "".join(f'[[train.inertia]]\nname = "{name}"\ninertia = 0.02\n' for name in "ab")
    shaft = '[[train.shaft]]\nname = "s"\nstart = "a"\nend = "b"\ntorsional_stiffness = 4e4\n'
    result = run("dynamics", spec(f'[train]\nname = "two"\n{discs}{shaft}'), "--quiet")
    assert f"{math.sqrt(2 * 4e4 / 0.02):.6g}" in result.stdout and "K_v" not in result.stdout
    document = read_json("output/two/dynamics.json")
    assert document["modes"]["circular"] == pytest.approx([0, 2000], abs=1e-6) and "chart" not in document
    page = Path("output/two/dynamics.html").read_text(encoding="utf-8")
    assert "Natural modes" in page and "Without teeth in mesh nothing shakes the train" in page


@pytest.mark.long
@pytest.mark.usefixtures("no_pictures")
def test_a_pair_on_bearings(here: Path, request: pytest.FixtureRequest) -> None:
    """Stiff bearings leave the torsional pair; soft ones bring frequencies of their own."""
    found = {}
    for stiffness in ("100.0", "1e7"):
        bearings = f"speeds = 40\npinion_bearing_stiffness = {stiffness}\nwheel_bearing_stiffness = {stiffness}"
        bearings += "\nbearing_damping = 1000.0"
        result = run("dynamics", spec(PAIR.replace("speeds = 40", bearings)), "--quiet", "--json")
        found[stiffness] = json.loads(result.stdout)
        request.getfixturevalue("no_report")  # one is enough
    stiff, soft = found["1e7"], found["100.0"]
    assert stiff["frequencies_on_bearings"][1] == pytest.approx(stiff["modes"]["frequency"][1], rel=1e-4)
    assert soft["frequencies_on_bearings"][1] < 0.7 * soft["modes"]["frequency"][1]
    alone = json.loads(invoke("dynamics", spec(PAIR), "--quiet", "--json").stdout)
    # Maxima find speeds of their own: compared at those that were asked for.
    asked = np.intersect1d(stiff["speed"], np.intersect1d(soft["speed"], alone["speed"]))
    at_asked = [np.array(each["chart"]["kv"]["mesh"])[np.isin(each["speed"], asked)] for each in (stiff, soft, alone)]
    assert len(asked) >= 40 and at_asked[0] == pytest.approx(at_asked[2], rel=1e-3)
    assert at_asked[1] != pytest.approx(at_asked[2], rel=0.05)


@pytest.mark.usefixtures("no_report")
def test_pitch_deviations_given_or_drawn(here: Path) -> None:
    """A tooth that stands proud by 40 µm shakes the train once a turn; one seed gives one gear."""
    assert "preload" in TRAIN
    given = [0.0] * 18
    given[4], given[5] = 40.0, -40.0
    found = []
    for more in (f"pitch_deviations = {given}\n", "", "drawn", "drawn", "other"):
        text = TRAIN.replace("speeds = 160", "speeds = 20\nspeed_from = 9000.0")
        if more in ("drawn", "other"):
            text += f"tooth_errors = 'on'\naccuracy_grade = 7\nseed = {int(more == 'other')}\n"
        else:
            text = text.replace("[dynamics]", f"{more}[dynamics]")
        result = run("dynamics", spec(text), "--quiet", "--json")
        found.append(json.loads(result.stdout)["chart"]["kv"]["mesh"])
    assert max(found[0]) > max(found[1]) + 0.05
    assert found[2] == found[3] != found[4]


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_a_chart_that_begins_where_flanks_part_is_integrated_in_time(here: Path) -> None:
    """The branch of motions turns back before the first speed of the chart: both runs are in time."""
    wild = TRAIN.replace("variation = 0.206", "variation = 0.3\nbacklash = 80.0").replace(
        "damping = 14660.0", "damping_ratio = 0.02"
    )
    few = wild.replace("speed_to = 16000.0", "speed_from = 9900.0\nspeed_to = 10400.0").replace("speeds = 160", "speeds = 40")
    document = json.loads(run("dynamics", spec(few), "--quiet", "--json").stdout)
    assert 2 < max(document["chart"]["kv"]["mesh"]) < max(document["chart_down"]["kv"]["mesh"]) < 5
    assert "integrated-in-time" in [each["code"] for each in document["notices"]]


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_tooth_errors_and_flanks_that_part_are_integrated_in_time(here: Path) -> None:
    text = PAIR.replace("speeds = 40", "speeds = 3\nspeed_from = 24000.0\nspeed_to = 27000.0\ntooth_errors = 'on'")
    result = run("dynamics", spec(text), "--quiet")
    assert re.search(r"Warning: flanks part at tooth frequencies .* are integrated in time", result.stdout)


@pytest.mark.long
@pytest.mark.usefixtures("no_pictures")
def test_the_contact_model_of_the_thesis(here: Path) -> None:
    text = (TEMPLATES / "uhlir-19-23.toml").read_text(encoding="utf-8")
    short = text.replace("speeds = 41", "speeds = 3").replace("duration = 1.0", "duration = 0.2")
    result = run("dynamics", spec(short), "--quiet")
    document = read_json("output/uhlir-19-23/dynamics.json")
    assert document["natural_frequency"] == pytest.approx(488.98723, abs=1e-3)
    assert document["damping_ratio"] == pytest.approx(0.01536199, rel=1e-6)
    assert document["campbell"]["speeds"] == [0.0, 10000.0, 20000.0]
    assert re.search(r"Warning: .*1\.6 mm at rest", result.stdout)


@pytest.mark.usefixtures("no_report")
def test_the_simple_model_of_the_thesis(here: Path) -> None:
    """One spring that does not vary: a vibration that dies away, in closed form, in the angles of both gears."""
    assert invoke("new", "uhlir-19-23-simple").exit_code == 0
    text = Path("uhlir-19-23-simple.toml").read_text(encoding="utf-8")
    short = text.replace("speeds = 41", "speeds = 2").replace("duration = 1.0", "duration = 0.2")
    result = run("dynamics", spec(short), "--quiet")
    assert "489 Hz" in result.stdout.replace("488.987", "489") and "612" not in result.stdout
    folder = Path("output/uhlir-19-23-simple")
    document = read_json(folder / "dynamics.json")
    assert (document["zone"], document["contact_ratio"]) == ("one pair", 1.0)
    assert [peaks[0][0] for peaks in document["campbell"]["peaks"]] == [490.0, 490.0]  # 5 Hz apart
    zeta, omega = document["damping_ratio"], 2 * math.pi * document["natural_frequency"]
    with np.load(folder / "dynamics.npz", allow_pickle=False) as arrays:
        time, approach = arrays["history_time"], arrays["history_approach"]
        angles = (arrays["history_pinion_angle"], arrays["history_wheel_angle"])
    phase = omega * math.sqrt(1 - zeta**2) * time
    fading = np.exp(-zeta * omega * time) * (np.cos(phase) + zeta / math.sqrt(1 - zeta**2) * np.sin(phase))
    assert approach == pytest.approx(document["static_approach"] * (1 - fading), abs=1e-6)
    # The gears' shares are as their radii squared over inertias; together they turn by what the flanks approach.
    radii = [1.75 * z / 2 * math.cos(math.radians(20)) for z in (19, 23)]
    uniform = 6 * 20000.0 * time
    moved = [np.radians(angles[0] - uniform) * radii[0], np.radians(angles[1] + uniform * 19 / 23) * radii[1]]
    assert 1000 * (moved[0] + moved[1]) == pytest.approx(approach, abs=1e-5)
    shares = [radius**2 / inertia for radius, inertia in zip(radii, (1.7399409e-5, 3.7362114e-5), strict=True)]
    assert moved[0] * shares[1] == pytest.approx(moved[1] * shares[0], abs=1e-3 * max(shares) * 1e-6)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (PAIR.replace("speeds = 40", "zone = 'two pairs'"), "line 17: dynamics.zone = 'two pairs': must be one of"),
        (TRAIN.replace("speeds = 160", "zone = 'one pair'"), "dynamics.zone: unknown key"),
        (PAIR.replace("torque = 50.0", "torque = 0.0"), "load.torque = 0: must be given"),
        ("[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 10.0\n", "must be a pair, a rack and pinion or a train"),
        (PAIR.replace("potential-energy", "iso6336"), "line 16: dynamics.stiffness = 'iso6336': must be one of"),
        (PAIR.replace("speeds = 40", "damping_ratio = -0.1"), "line 17: dynamics.damping_ratio = -0.1: must be"),
        (PAIR.replace("speeds = 40", "pinion_inertia = 0.0"), "line 17: dynamics.pinion_inertia = 0 kg·m²: must be"),
        (
            PAIR.replace("[pinion]", "helix_angle = 20.0\n[pinion]").replace("speeds = 40", "model = 'contact'"),
            "helix_angle = 20 deg: must be 0",
        ),
        (TRAIN.replace("inertia = 0.0058 ", "inertia = 0.0 "), "line 17: pinion.inertia = 0 kg·m²: must be"),
        (TRAIN.replace("stiffness = 705.0 ", "stiffness = -705.0 "), "mesh.stiffness = -705 N/µm: must be"),
        (
            TRAIN.replace("variation = 0.206", "pitch_deviations = [1.0, 2.0]"),
            "mesh.pitch_deviations = 2: must be 18 numbers in µm",
        ),
        (
            PAIR.replace("speeds = 40", "pinion_bearing_stiffness = 5.0"),
            "line 17: dynamics.pinion_bearing_stiffness = 5 N/µm: must be given together",
        ),
        (
            TRAIN.replace("variation = 0.206", "variation = 0.206\nshape = 'square'\ncontact_ratio = 1.6"),
            "mesh.variation = 0.206: not with a square wave",
        ),
        (TRAIN.replace("variation = 0.206", "variation = 1.2"), "mesh.variation = 1.2: must be"),
        (TRAIN.replace('wheel = "wheel"', 'wheel = "whel"'), "'whel'"),
        (TRAIN.replace("teeth = 18 ", "tooth = 18 "), "train.mesh[0].tooth: unknown key; did you mean teeth?"),
        (TRAIN.replace("teeth = 18 ", "# teeth = 18 "), "line 45: teeth is missing in [[train.mesh]]"),
        (TRAIN.replace("[dynamics]", "[pair]\n[dynamics]"), "[pair] cannot stand beside [train]"),
        (TRAIN.replace("speeds = 160", "stiffness = '3d'"), "dynamics.stiffness: unknown key"),
        (TRAIN.replace('model = "modes" ', 'model = "modal" '), "train.model = 'modal'"),
    ],
)
def test_what_makes_no_dynamics(here: Path, text: str, message: str) -> None:
    result = run("dynamics", spec(text), status=2)
    last = result.stderr.splitlines()[-1]
    assert last.startswith("Error: ") and message in last
    assert not Path("output").exists()


@pytest.mark.parametrize("command", ["build", "check", "stiffness", "modify"])
def test_other_commands_send_a_train_here(here: Path, command: str) -> None:
    result = run(command, spec(TRAIN), status=2)
    permitted = {
        "build": "a gear, a pair, a rack, a rack and pinion, a planetary train, a spline or a shaft",
        "modify": "a pair",
    }.get(command, "a pair or a rack and pinion")
    said = f"Error: kind = 'train': must be {permitted}: a train is for `gearcad dynamics` and `gearcad data`\n"
    assert result.stderr == said


@pytest.mark.usefixtures("no_report")
def test_one_accuracy_grade_for_the_standard(here: Path) -> None:
    """That of [rating], unless [dynamics] has its own."""
    charts = []
    for own, grade in (("", 9), ("accuracy_grade = 9\n", 5)):
        chart = "pinion_inertia = 6e-5\nwheel_inertia = 3e-4\nspeed_to = 1500.0\n"
        text = (
            PAIR.replace("speeds = 40", "speeds = 4")
            + chart
            + own
            + f"[rating]\naccuracy_grade = {grade}\n[material]\ngroup = 'Eh'\n"
        )
        result = run("dynamics", spec(text), "--quiet", "--json")
        charts.append(json.loads(result.stdout))
    assert charts[0] == charts[1]
    assert not any("K_v of ISO 6336-1" in warning for warning in charts[0]["warnings"])


@pytest.mark.usefixtures("no_report")
def test_why_the_standard_has_no_factor(here: Path) -> None:
    result = run("dynamics", spec(PAIR + "[material]\ngroup = 'V'\n"), "--quiet")
    assert "Warning: no K_v of ISO 6336-1: material.contact_endurance_limit is missing: must be given for material group V" in (
        result.stdout
    )
    assert "resonance speed, ISO 6336-1" not in result.stdout
