"""Methods of stiffness that do not treat rings: they say so in one line, and why."""

from gearcad import Gear, GearPair, Load, stiffness

RING = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=16.0),
    wheel=Gear(teeth=-70, normal_module=2.0, face_width=14.0),
)


def test_methods_without_an_internal_form_say_why() -> None:
    found = stiffness(RING, Load(torque=50), methods=("iso6336", "potential-energy", "weber-banaschek"))
    assert [cycle.method for cycle in found.cycles] == ["iso6336"]
    said = "wheel.teeth = -70: must be above 0 for {}: {}"
    expected = {
        "potential-energy": "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them",
        "weber-banaschek": "its beam and half-plane are those of teeth that stand out from their body",
    }
    assert {name: found.left_out[name] for name in expected} == {name: said.format(name, why) for name, why in expected.items()}
