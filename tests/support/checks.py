"""Checks to draw and to report, coarse solid pairs made once for all tests, and sizes of meshes that are made quickly."""

from dataclasses import replace
from functools import cache, lru_cache

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from gearcad import Body, Gear, GearPair, Load, Material, Mounting, ShaperCutter
from gearcad.check.convergence import Convergence, SweepPoint
from gearcad.check.gates import compare_plane, compare_solid
from gearcad.check.options import CheckOptions
from gearcad.check.pictures import tooth_stresses
from gearcad.check.result import PlaneCheck, SolidCheck
from gearcad.check.summary import PLANE, SOLID, summarise_plane, summarise_solid
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.plane.sector import Plane
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.records import Notice, PerGear, Role
from gearcad.designs import read_spec
from gearcad.geometry import FlankModification
from gearcad.meshing.outline import MeshSizes
from support.dense_contact import hertz_ellipse
from support.specs import TEMPLATES

NASTY_NAME = "<script>alert('gear')</script> & \"$x_1$\""
"""A name that would break HTML, and mathtext."""

_POSITIONS = 16

STEEL = Material()


@lru_cache
def small_check() -> PlaneCheck:
    """FZG's C gears with unequal widths and a limit for contact that they exceed."""
    pinion, wheel = (
        Gear(teeth=teeth, normal_module=4.5, profile_shift=shift, face_width=width, body=Body(bore=30))
        for teeth, shift, width in ((16, 0.1817, 16.0), (24, 0.1715, 14.0))
    )
    pair = GearPair(pinion=pinion, wheel=wheel)
    material, load = Material(name=NASTY_NAME, contact_limit=1500.0, root_limit=(430.0, 500.0)), Load(torque=302.0)
    options = CheckOptions(positions=_POSITIONS)
    model = plane_pair(pair, material)
    cycle = PlaneCycle.run(model, load.torque, _POSITIONS).searched(PLANE)
    summary = summarise_plane(cycle, model.single_stiffness(load.torque, 5))
    convergence = (
        Convergence("mean mesh stiffness", (15.4, 15.3, 15.2), (0.5, 1.0, 2.0), None, 0.006),
        Convergence("root tension, pinion", (380.0, 374.0, 372.0), (0.5, 1.0, 2.0), 1.58, 0.0081),
        Convergence("root tension, wheel", (360.0, 357.0, 356.0), (0.5, 1.0, 2.0), 1.58, 0.0042),
    )
    sweep = (
        SweepPoint(302.0, 15.2, 1700.0, PerGear(370.0, 350.0), PerGear(5.6e5, 9.8e5)),
        SweepPoint(75.5, 14.5, 850.0, PerGear(92.5, 87.5), PerGear(5.2e5, 9.2e5)),
    )
    task = CheckTask(pair=pair, material=material, load=load, mounting=Mounting(), options=options)
    return PlaneCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        sweep=sweep,
        convergence=convergence,
        comparisons=compare_plane(task, cycle, summary, convergence),
        notices=(Notice("test", "a warning with <b>tags</b>"),),
    )


@lru_cache
def small_solid_check() -> SolidCheck:
    """A coarse helical pair, misaligned and with a crowned pinion, whose root limit the wheel exceeds."""
    plain, torque = coarse_model("helical"), 120.0
    crowned = FlankModification(lead_crowning=4.0, tip_relief=10.0, tip_relief_length=0.8, helix_angle_modification=6.0)
    pair = replace(plain.pair, pinion=replace(plain.pair.pinion, modification=crowned))
    material, mounting = Material(name=NASTY_NAME, root_limit=300.0, yield_strength=2000.0), Mounting(misalignment=10.0)
    options = CheckOptions(model="3d", positions=12, body_teeth=3, refinement=0.7)
    task = CheckTask(pair=pair, material=material, load=Load(torque=torque), mounting=mounting, options=options)
    model = plain.remade(pair, mounting)
    cycle = SolidCycle.run(model, torque, 12).searched(SOLID)
    summary = summarise_solid(cycle, model.single_stiffness(torque, 5))
    convergence = (
        Convergence("mean mesh stiffness", (12.3, 12.1, 12.0), (0.8, 1.0, 1.25), 3.1, 0.02),
        Convergence("root tension, pinion", (303.0, 305.0, 304.0), (0.8, 1.0, 1.25), None, 0.008),
        Convergence("root tension, wheel", (312.0, 310.0, 309.0), (0.8, 1.0, 1.25), 3.1, 0.008),
    )
    sweep = (
        SweepPoint(120.0, 12.1, 1400.0, PerGear(305.0, 310.0), PerGear(2.6e5, 4.8e5)),
        SweepPoint(30.0, 11.5, 700.0, PerGear(76.0, 77.0), PerGear(2.2e5, 4.2e5)),
    )
    return SolidCheck(
        task=task,
        cycle=cycle,
        summary=summary,
        tooth_stresses=tooth_stresses(cycle),
        sweep=sweep,
        convergence=convergence,
        comparisons=compare_solid(task, cycle, summary, convergence),
        notices=(Notice("test", "a warning with <b>tags</b>"),),
    )


PAIRS = ("FZG C", "helical")

TORQUES = {"FZG C": 302.0, "helical": 60.0, "Alm": 12.7, "ring": 60.0}
"""N·m on the pinion."""


def coarse_pair(name: str) -> GearPair:
    """FZG C, Alm 18/161, or one of module 2 with 20 and 30 teeth at 20 degrees, or inside a ring of 54."""
    specs = {"FZG C": "fzg-c.toml", "Alm": "alm-18-161.toml"}
    if name in specs:
        pair = read_spec(TEMPLATES / specs[name]).pair
        assert pair is not None
        return pair
    pinion = Gear(teeth=20, normal_module=2, face_width=10, helix_angle=20, tooth_thinning=0.05, body=Body(bore=28))
    if name == "ring":
        cutter = ShaperCutter(teeth=18, tip_radius=0.15)
        ring = Gear(teeth=-54, normal_module=2, face_width=10, helix_angle=20, cutter=cutter)
        return GearPair(pinion=pinion, wheel=ring)
    wheel = Gear(teeth=30, normal_module=2, face_width=10, helix_angle=-20, tooth_thinning=0.05, body=Body(bore=48))
    return GearPair(pinion=pinion, wheel=wheel)


@cache
def coarse_model(name: str) -> SolidPair:
    """Three teeth of each gear, with half as many elements in their sections as usual."""
    with threadpool_limits(1):
        body, sizes = BodyModel(teeth=3), SolidSizes().refined(0.7)
        return solid_pair(coarse_pair(name), Material(), body=body, sizes=sizes)


COARSE = MeshSizes(flank=0.6, corner=0.5, fillet=0.4, outline=0.75, cut=0.75, rim=2.0, growth=0.5)


SPREAD = 20.0
"""mm: the face width of spur pairs whose root stress is compared along the face."""


def check_between_plane_states(model: SolidPair, torque: float, body: BodyModel, positions: int) -> None:
    """The stiffness lies between plane stress and strain; root stress is that of plane strain, but varies over the face."""
    solid = SolidCycle.run(model, torque, positions)
    stress, strain = (
        PlaneCycle.run(plane_pair(model.pair, STEEL, body=body, plane=plane), torque, positions)
        for plane in (Plane.STRESS, Plane.STRAIN)
    )
    soft, stiff = (cycle.values("stiffness").mean() for cycle in (stress, strain))
    assert soft < solid.values("stiffness").mean() < stiff
    for role in Role:
        plane = max(position.tension.pick(role).stress for position in strain.positions)
        heights, along = solid.root_along_face(role)
        assert np.interp(np.linspace(0, SPREAD, 401), heights, along).mean() == pytest.approx(plane, rel=0.04)
        assert along.max() == pytest.approx(plane, rel=0.12)


def check_reactions(model: SolidPair, torque: float, positions: int) -> None:
    """Reactions on both hubs are the torques at every position; a ring is turned the way its pinion turns.

    Where edges of tips touch, the wheel's is that of their levers: up to 3 % more or less than the ratio of teeth makes it.
    """
    ratio = abs(model.pair.wheel.teeth) / model.pair.pinion.teeth
    for position in SolidCycle.run(model, torque, positions).positions:
        levers = position.torque_ratios
        assert levers.wheel == 1.0 or (abs(levers.wheel - 1) < 0.03 and any(contact.edge for contact in position.contacts))
        assert position.torques == pytest.approx((torque, torque * ratio * levers.wheel), rel=0.003)


def check_mirrored(model: SolidPair, mirrored: SolidPair, torque: float) -> None:
    """The mirror image in a plane across the axes has the same figures to rounding."""
    one, other = (SolidCycle.run(each, torque, 3) for each in (model, mirrored))
    for name in ("stiffness", "transmission_error", "approach_parts", "torques"):
        assert other.values(name) == pytest.approx(one.values(name), rel=1e-6)
    assert other.load_along_face[1] == pytest.approx(one.load_along_face[1][::-1], rel=1e-4)
    for role in Role:
        assert other.root_along_face(role)[1] == pytest.approx(one.root_along_face(role)[1][::-1], rel=1e-5)


def check_ellipse(crowned: SolidPair, torque: float, across: float, crowning: float) -> None:
    """Pressure and width at the pitch point are those of Hertz's ellipse, by the crowning (µm) over `SPREAD`: 2 % is asked."""
    solved = crowned.solve(0.0, torque, single=True)
    along = SPREAD**2 / (8 * crowning / 1000)
    modulus = STEEL.youngs_modulus / (1 - STEEL.poisson_ratio**2) / 2
    pressure, _, lesser = hertz_ellipse(float(solved.forces.sum()), across, along, modulus)
    assert solved.pressures.max() == pytest.approx(pressure, rel=0.02)
    assert solved.half_widths.max() == pytest.approx(lesser, rel=0.02)


def load_tilt(model: SolidPair, torque: float) -> float:
    """How much more is carried at large z, over all."""
    across, load = SolidCycle.run(model, torque, 4).load_along_face
    return float((load * np.sign(across)).sum() / load.sum())
