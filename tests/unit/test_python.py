"""gearcad from Python: what objects show of themselves, and jobs on a pair that no spec describes."""

import inspect
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from functools import partial
from importlib import import_module
from inspect import signature
from pathlib import Path

import numpy as np
import pytest
from support.checks import coarse_pair
from support.specs import TEMPLATES

import gearcad
from gearcad import (
    ISO53_C,
    BasicRack,
    Body,
    FlankModification,
    Gear,
    HubSide,
    Load,
    Material,
    Mounting,
    ParameterError,
    ReliefShape,
    check,
    designs,
    dynamics,
)
from gearcad.check import CheckOptions
from gearcad.designs import Design, PairDesign, read_spec
from gearcad.dynamics import DynamicsOptions
from gearcad.jobs import VERBS, job_of, module_of
from gearcad.jobs.build import Build
from gearcad.jobs.job import as_design
from gearcad.jobs.modify import Modify
from gearcad.jobs.strength import Rate
from gearcad.solids import Format

FZG_C = coarse_pair("FZG C")

VOLVO = read_spec(TEMPLATES / "volvo-13-44.toml")

NAMES = {name: getattr(package, name) for package in (gearcad, check, designs, dynamics) for name in package.__all__}

PIXEL = 1.5
"""Of the picture: outlines may touch, and polygons are 0.2 of one off."""


@pytest.mark.parametrize(
    "shown",
    [
        Gear(teeth=20, normal_module=2, face_width=10),
        Gear(teeth=20, normal_module=2, face_width=10, tip_diameter=43.5, rack=ISO53_C, name="first"),
        VOLVO.pair,
        VOLVO,
        FlankModification(tip_relief=20, tip_relief_length=2, tip_relief_shape=ReliefShape.PARABOLIC),
        Body(bore=10, hub_diameter=20, hub_length=3, hub_side=HubSide.BOTH),
        BasicRack(root_radius="full"),
        Material(contact_limit=[1200, 1300]),
        Load(torque=-1 / 3),
        Mounting(misalignment=5),
        CheckOptions(model="3d", torques=[10, 20]),
        DynamicsOptions(),
        read_spec(TEMPLATES / "train-1-stage.toml").train,
    ],
    ids=lambda each: type(each).__name__,
)
def test_an_input_shows_in_one_line_what_was_given(shown: object) -> None:
    assert eval(repr(shown), NAMES) == shown
    assert "\n" not in repr(shown)


def test_nothing_that_is_a_default_or_derived_is_shown() -> None:
    assert repr(Gear(teeth=20, normal_module=2, face_width=10)) == "Gear(teeth=20, normal_module=2.0, face_width=10.0)"
    assert repr(Material()) == "Material()"
    assert len(repr(VOLVO.pair)) < 600
    assert repr(FZG_C.pinion.profile) == "<ToothProfile: 16 teeth, diameters 62.3853 to 82.4567 mm>"


def polygons(html: str) -> list[np.ndarray]:
    outlines = re.findall(r'd="M([^Za]*)Z', html)
    return [np.array([place.split(",") for place in outline.split()], float) * [1, -1] for outline in outlines]


def test_a_notebook_shows_the_gears_in_mesh() -> None:
    pair = VOLVO.pair  # helical, of unequal widths: seen where the pinion begins, the wheel stands turned
    assert pair is not None
    pinion, wheel = polygons(pair._repr_html_())
    for outline, gear, x in ((pinion, pair.pinion, 0.0), (wheel, pair.wheel, pair.centre_distance)):
        radii = np.hypot(outline[:, 0] - x, outline[:, 1])
        assert radii.max() == pytest.approx(gear.tip_diameter / 2, abs=0.1)
        assert radii.min() == pytest.approx(gear.root_diameter / 2, abs=0.1)
    from matplotlib.path import Path as Outline

    pixel = (pair.centre_distance + (pair.pinion.tip_diameter + pair.wheel.tip_diameter) / 2) / 240
    for one, other in ((pinion, wheel), (wheel, pinion)):
        inside = one[Outline(other).contains_points(one)]
        depth = [np.hypot(*(other - place).T).min() for place in inside]
        assert max(depth, default=0.0) < PIXEL * pixel
    nearest = min(np.hypot(*(pinion - place).T).min() for place in wheel)
    assert nearest < PIXEL * pixel


@pytest.mark.parametrize("rim", [130.0, None])
def test_a_notebook_shows_a_ring_as_a_ring(rim: float | None) -> None:
    """Its opening inside its rim, which is dotted where it was not given; the shift of the profile in both signs."""
    bolts = {"bolt_circle": 120.0, "bolt_holes": 5, "bolt_diameter": 4.0} if rim else {}
    ring = Gear(teeth=-48, normal_module=2, face_width=10, profile_shift=-0.3, body=Body(rim_diameter=rim, **bolts))
    html = ring._repr_html_()
    radii = np.hypot(*polygons(html)[0].T)
    assert radii.min() == pytest.approx(-ring.tip_diameter / 2, abs=0.1)
    assert radii.max() == pytest.approx(-ring.root_diameter / 2, abs=0.1)
    outside = 130.0 if rim else -ring.root_diameter + 2 * 3.5 * 2.0
    (width,) = (float(box.split()[2]) for box in re.findall(r'viewBox="([^"]*)"', html))
    assert width == pytest.approx(outside, rel=1e-5)
    assert ("no body.rim_diameter is given" in html) is (rim is None)
    assert html.count("a2,2 0 1 0 4,0") == len(bolts) // 3 * 5
    assert "<td>-0.3</td>" in html and "<td>0.3</td>" in html
    ElementTree.fromstring(html.replace("cellpadding=3", ""))


def test_what_a_notebook_shows_is_small_and_sound() -> None:
    gear = Gear(teeth=31, normal_module=0.02, face_width=0.2, name="<b>&", body=Body(bore=0.3))
    for shown in (gear, VOLVO.pair):
        html = shown._repr_html_()
        assert len(html) < 30_000
        ElementTree.fromstring(html.replace("cellpadding=3", ""))
    assert "&lt;b&gt;&amp;" in gear._repr_html_()
    assert "<b>" not in gear._repr_html_()
    assert "tip diameter" in gear._repr_html_()


def test_a_job_takes_a_pair_and_a_load_as_it_takes_a_design() -> None:
    load, material = Load(torque=302), Material(youngs_modulus=210000)
    design = as_design(FZG_C, load, material=material)
    assert isinstance(design, Design)
    assert (design.pair, design.load, design.material, design.name) == (FZG_C, load, material, FZG_C.name)
    other = as_design(design, Load(torque=100), mounting=Mounting(misalignment=5))
    assert (other.load, other.material) == (Load(torque=100), material)
    one = gearcad.stiffness(FZG_C, load, methods=["iso6336"], material=material)
    two = gearcad.stiffness(design, methods=["iso6336"])
    assert one.cycles[0].mean == two.cycles[0].mean
    assert repr(one.cycles[0]).startswith("<MeshCycle by iso6336 at 302 N·m: ")


@pytest.mark.parametrize("verb", ["check", "rate", "stiffness", "dynamics", "modify"])
def test_a_job_without_a_load_or_on_something_else_is_one_line(verb: str) -> None:
    job, load, gear = getattr(gearcad, verb), Load(torque=60), FZG_C.pinion
    with pytest.raises(ParameterError, match=r"^load\.torque is missing: must be given"):
        job(FZG_C)
    with pytest.raises(ParameterError, match=r"^kind = 'gear': must be a pair"):
        job(gear, load)
    with pytest.raises(
        ParameterError,
        match=r"^subject = 3: must be a GearPair, a Gear, a RackPair, a Rack, a PlanetaryTrain,"
        r" a SplineJoint, or a design such as gearcad\.read gives$",
    ):
        job(3)
    with pytest.raises(ParameterError, match=r"^load = 5: must be a Load$"):
        job(FZG_C, 5)
    with pytest.raises(ParameterError, match=r"^material = 'steel': must be a Material$"):
        job(FZG_C, load, material="steel")


def test_what_is_permitted_beside_the_load_is_said() -> None:
    with pytest.raises(
        ParameterError, match=r"permitted: material, load, mounting, check, mesh, dynamics, rating, drawing, verify, modify$"
    ):
        gearcad.check(FZG_C, Load(torque=60), chek=CheckOptions())
    for methods in ("iso6336", [], 5):
        with pytest.raises(ParameterError, match=r"^methods = .*: must be a list of names"):
            gearcad.stiffness(FZG_C, Load(torque=60), methods=methods)
    with pytest.raises(ParameterError, match=r"^formats = 'step': must be a list of formats"):
        gearcad.build(FZG_C, "nowhere", "step")


def test_every_job_has_a_class_and_a_function_of_its_name() -> None:
    for verb in VERBS:
        assert job_of(verb).verb == verb
        function = getattr(import_module(f"gearcad.jobs.{module_of(verb)}"), verb)
        assert signature(getattr(gearcad, verb)) == signature(function)
        assert inspect.getdoc(function).split("\n")[0] in inspect.getdoc(getattr(gearcad, verb))


IMPORTS = (
    "import gearcad",
    "from gearcad.check import CheckOptions",
    "from gearcad import check",
    "import gearcad.jobs.strength",
)


@pytest.mark.parametrize("first", range(len(IMPORTS)))
def test_a_room_can_be_called_as_its_job_however_it_was_imported(first: int) -> None:
    lines = [*IMPORTS[first:], *IMPORTS[:first]]
    code = "\n".join([*lines, "assert check is gearcad.check", "gearcad.check.Model", "check(3)"])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "ParameterError: subject = 3: must be" in done.stderr, done.stderr


@pytest.mark.long
def test_a_type_checker_knows_what_verbs_take_and_give(tmp_path: Path) -> None:
    (tmp_path / "user.py").write_text(
        "import gearcad\n"
        "from gearcad.check import CheckOptions, CheckResult\n"
        "def use(pair: gearcad.GearPair, load: gearcad.Load) -> CheckResult:\n"
        "    gearcad.dynamics(gearcad.read('a.toml'))\n"
        "    gearcad.stiffness(pair, 5)\n"
        "    return gearcad.check(pair, load, check=CheckOptions())\n"
    )
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "user.py"], capture_output=True, text=True, cwd=tmp_path)
    assert [line for line in done.stdout.splitlines() if line.startswith("user.py")] == [
        'user.py:5: error: Argument 2 to "stiffness" has incompatible type "int"; expected "Load | None"  [arg-type]'
    ]


@pytest.mark.parametrize("room", ["check", "dynamics", "geometry", "meshing", "rating", "solids", "designs", "stiffness"])
def test_every_package_says_what_it_has(room: str) -> None:
    package = import_module(f"gearcad.{room}")
    assert [name for name in package.__all__ if getattr(package, name, None) is None] == []
    with pytest.raises(AttributeError, match=r"attribute '?nothing"):
        package.nothing  # noqa: B018


def test_jobs_refuse_what_their_functions_refuse(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"^formats = 'csv': must be a list of formats"):
        Build(formats="csv")
    assert Build(formats=("csv",)).formats == (Format.CSV,)
    with pytest.raises(ParameterError, match=r"^shape = 'cubic': must be one of"):
        Modify(shape="cubic")
    rate = Rate(report=False)
    made = rate.write(rate.run(PairDesign(name="pair", pair=FZG_C, load=Load(torque=60))), str(tmp_path))
    assert made == [tmp_path / "rate.json"] == list(tmp_path.iterdir())


GEAR = gearcad.Gear(teeth=20, normal_module=2, face_width=5)
SEVERAL = np.array([True, False])
"""No switch, number or word, though Python would ask it for its truth."""


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: gearcad.picture(GEAR, "it.png", size=5), "size = 5: must be width and height in pixels"),
        (lambda: gearcad.build(GEAR, "out", progress=5), "progress = 5: must be a function"),
        *[
            (
                partial(gearcad.build, GEAR, "out", ["csv"], **{name: SEVERAL}),
                f"{name} = array([ True, False]): must be true or",
            )
            for name in ("bracket", "circles", "carrier", "exploded", "turning")
        ],
        (lambda: gearcad.picture(GEAR, "it.png", explode=SEVERAL), "explode = array([ True, False]): must be true or false"),
        (lambda: gearcad.planetary(GEAR, response=SEVERAL), "response = array([ True, False]): must be true or false"),
        (lambda: gearcad.planetary(GEAR, speeds=SEVERAL), "speeds = array([ True, False]): must be speeds by the names"),
        (lambda: gearcad.mesh(GEAR, what=SEVERAL), "what = array([ True, False]): must be "),
        (
            lambda: gearcad.stiffness(FZG_C, Load(torque=60), positions=SEVERAL),
            "positions = array([ True, False]): must be",
        ),
        (lambda: gearcad.build(GEAR, 5), "output = 5: must be a path"),
        (lambda: gearcad.build(GEAR, "a\0b"), r"output = 'a\x00b': must be a path"),
        (lambda: gearcad.picture(GEAR, 5), "file = 5: must be a path"),
        (lambda: gearcad.read(None), "file = None: must be a path"),
        (lambda: gearcad.read("\ud800"), "is no name that a file can have"),
        (lambda: gearcad.read("/dev/zero"), "/dev/zero: cannot be read (it is a device or a pipe, not a file)"),
    ],
)
def test_wrong_types_are_errors_of_ours(call: Callable[[], object], said: str) -> None:
    with pytest.raises(gearcad.core.errors.GearcadError, match=re.escape(said)):
        call()
