"""Gears that between them show every feature and every corner of a tooth's outline."""

from __future__ import annotations

from gearcad import ISO53_D, BasicRack, Body, Gear

SAMPLES: dict[str, Gear] = {
    "spur": Gear(teeth=30, normal_module=2.0, face_width=10),
    "helical": Gear(teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, tooth_thinning=0.08),
    "left hand": Gear(teeth=44, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378),
    "many teeth": Gear(teeth=300, normal_module=0.5, face_width=5, profile_shift=0.3),
    "undercut": Gear(teeth=8, normal_module=1.0, face_width=5),
    "deeply undercut": Gear(teeth=8, normal_module=3.0, face_width=10, profile_shift=-0.15, rack=ISO53_D),
    "barely undercut": Gear(teeth=17, normal_module=4.0, face_width=10),
    "few teeth": Gear(teeth=6, normal_module=2.0, face_width=30, helix_angle=35, profile_shift=0.4),
    "three teeth": Gear(teeth=3, normal_module=2.0, face_width=20, helix_angle=60, profile_shift=0.1),
    "full radius": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius="full")),
    "sharp tool": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=0.0)),
    "sharp tool, undercut": Gear(teeth=10, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=0.0)),
    "nearly sharp tool": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=1e-4)),
    "high shift": Gear(teeth=40, normal_module=1.0, face_width=10, profile_shift=1.4, rack=BasicRack(addendum=0.8)),
    "shift beyond dedendum": Gear(
        teeth=60, normal_module=1.0, face_width=10, profile_shift=1.5, rack=BasicRack(addendum=0.7, dedendum=1.1)
    ),
    "14.5 degrees": Gear(teeth=20, normal_module=1.0, face_width=10, rack=BasicRack(pressure_angle=14.5)),
    "30 degrees": Gear(
        teeth=20,
        normal_module=1.0,
        face_width=10,
        rack=BasicRack(pressure_angle=30, dedendum=1.0, addendum=0.8, root_radius=0.2),
    ),
    "chamfered": Gear(teeth=30, normal_module=2.0, face_width=10, body=Body(tip_chamfer=0.3)),
    "shallow root above base circle": Gear(teeth=80, normal_module=1.0, face_width=10, root_diameter=78.0),
    "tiny": Gear(teeth=20, normal_module=0.1, face_width=1),
    "huge": Gear(teeth=20, normal_module=20, face_width=100, helix_angle=10),
}
