"""What a plane does not know of bodies, and says: thin faces, and roots that are wider than the mesh."""

from __future__ import annotations

from dataclasses import replace

import pytest
from support.checks import small_check

from gearcad import Body, Gear, GearPair, Material
from gearcad.check.gates import standards
from gearcad.check.run import plane_notices
from gearcad.check.summary import SummaryFigures, figures
from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidSizes, solid_pair
from gearcad.core.records import texts
from gearcad.load import Load
from gearcad.rating import Edition, RatingOptions
from gearcad.stiffness import PlaneStrainContact, PlaneStressContact, StrainEnergy

STRAIN, STRESS = (PlaneElasticity(Material(), plane) for plane in Plane)


def task_of(pair: GearPair, **changes: object) -> CheckTask:
    """The task of a small check with another pair, and changes."""
    return replace(small_check().task, pair=pair, **changes)


def fzg(pinion_width: float, wheel_width: float) -> GearPair:
    """FZG's C gears in other widths; the teeth of both are 7.66 and 7.63 mm thick."""
    pinion, wheel = (
        Gear(teeth=teeth, normal_module=4.5, profile_shift=shift, face_width=width, body=Body(bore=30))
        for teeth, shift, width in ((16, 0.1817, pinion_width), (24, 0.1715, wheel_width))
    )
    return GearPair(pinion=pinion, wheel=wheel)


def plane_texts(task: CheckTask, elasticity: PlaneElasticity) -> tuple[str, ...]:
    plane = "strain" if elasticity.plane is Plane.STRAIN else "stress"
    return texts(plane_notices(replace(task, material=elasticity.material, options=replace(task.options, plane=plane))))


def test_a_face_thinner_than_its_teeth_is_told() -> None:
    thin, wide = plane_texts(task_of(fzg(14.0, 7.0)), STRAIN)
    assert thin.startswith("the wheel's face width of 7 mm is below its tooth thickness, 7.63 mm: so thin a body is nearer to ")
    assert "up to 9 % too stiff" in thin
    assert wide.startswith("the pinion is 14 mm wide, and the plane model has the 7 mm in mesh; by ISO 6336-3 14 mm carry")
    assert plane_texts(task_of(fzg(14.0, 14.0)), STRAIN) == ()
    (pressure,) = plane_texts(task_of(fzg(5.0, 5.0)), STRESS)
    assert pressure == "plane stress: the contact itself stays in plane strain, where its pressure is up to 4.8 % higher"


def test_methods_in_plane_strain_tell_a_thin_face() -> None:
    load = Load(torque=10.0)
    for method in (PlaneStrainContact, StrainEnergy):
        (thin,) = method(pair=fzg(7.0, 14.0)).notices(load)
        assert thin.code == "thin-face" and "nearer to plane stress" in thin.text
        assert not list(method(pair=fzg(14.0, 14.0)).notices(load))
    assert not list(PlaneStressContact(pair=fzg(7.0, 14.0)).notices(load))


def test_a_wider_root_is_told() -> None:
    """16 mm on 14 mm: ISO's root carries on all of it, at most m_n on either side; by the standard asked for."""
    (found,) = plane_texts(task_of(fzg(16.0, 14.0)), STRAIN)
    assert found == (
        "the pinion is 16 mm wide, and the plane model has the 14 mm in mesh; by ISO 6336-3 16 mm carry at its root, with 12 % "
        "less stress; --model 3d has the whole width"
    )
    german = task_of(fzg(14.0, 40.0), rating_options=RatingOptions(standard=Edition.DIN_1987))
    (found,) = plane_texts(german, STRAIN)
    assert "the wheel is 40 mm wide" in found and "by DIN 3990-3 23 mm carry" in found
    source = next(each.source for each in standards(german, small_check().summary) if each.quantity == "root stress, wheel")
    assert source == "sigma_F0, DIN 3990-3:1987 Method B, over b = 23 mm"


@pytest.mark.long
def test_solid_bodies_show_what_is_told() -> None:
    """A thin pair is almost as soft as in plane stress; a pinion that stands over has less stress at its root."""

    def solid(pair: GearPair, torque: float) -> SummaryFigures:
        return figures(SolidCycle.run(solid_pair(pair, Material(), sizes=SolidSizes().refined(0.8)), torque, 12))

    strain, stress = (figures(PlaneCycle.run(plane_pair(fzg(1.5, 1.5), Material(), plane=plane), 32.4, 12)) for plane in Plane)
    thin = solid(fzg(1.5, 1.5), 32.4)
    assert thin.mesh_stiffness - stress.mesh_stiffness < 0.2 * (strain.mesh_stiffness - stress.mesh_stiffness)
    # 4.5 mm on both sides, one module: ISO has 14/23 = 0.61 of the stress.
    even, wider = solid(fzg(14.0, 14.0), 302.0), solid(fzg(23.0, 14.0), 302.0)
    assert wider.root_tension.pinion / even.root_tension.pinion == pytest.approx(0.705, abs=0.01)
    assert wider.root_tension.wheel == pytest.approx(even.root_tension.wheel, rel=0.01)
