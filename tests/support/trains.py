"""Trains that several tests use: those of Osinski's paper, and random ones."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from gearcad.dynamics.trains.members import GROUND, Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train

LONG, SHORT = ((750.0, 56.7), (1000.0, 18.5)), ((100.0, 34.4), (200.0, 12.4))
"""Lengths and diameters (mm) of input and output shaft: (2.1) and (2.4) of the paper."""


def one_stage(model: str, shafts: tuple[tuple[float, float], ...] = LONG, **more: Any) -> Train:
    """Figure 1 of the paper, its far ends clamped; two modes of the first shaft and one of the second where modes are kept."""
    damping_ratio = more.pop("damping_ratio", 0.05)
    return Train(
        model=model,
        inertias=(Inertia(name="pinion", inertia=0.0058), Inertia(name="wheel", inertia=0.2228)),
        shafts=tuple(
            Shaft(name=name, start=GROUND, end=gear, length=length, diameter=diameter, modes=modes, damping_ratio=damping_ratio)
            for name, gear, (length, diameter), modes in zip(
                ("input", "output"), ("pinion", "wheel"), shafts, (2, 1), strict=True
            )
        ),
        meshes=(
            ToothMesh(
                name="mesh",
                pinion="pinion",
                wheel="wheel",
                base_radii=(50.7, 135.3),
                stiffness=705.0,
                teeth=18,
                damping=14660.0,
                variation=0.206,
                preload=2256 / 0.0507,
            ),
        ),
        **more,
    )


def two_stages(between: float, model: str = "massless") -> Train:
    """Figure 7 of the paper: equal gears, `between` (N·m/rad) the shaft from one stage to the next."""
    springs = (("input", GROUND, "1", 1e5), ("between", "2", "3", between), ("output", "4", GROUND, 921.0))
    return Train(
        model=model,
        inertias=tuple(Inertia(name=name, inertia=0.0446) for name in "1234"),
        shafts=tuple(Shaft(name=name, start=a, end=b, torsional_stiffness=k) for name, a, b, k in springs),
        meshes=tuple(
            ToothMesh(name=a + b, pinion=a, wheel=b, base_radii=(90.2, 90.2), stiffness=750.0, teeth=32)
            for a, b in ("12", "34")
        ),
        torques={"1": 2256.0, "4": -2256.0},
    )


@st.composite
def random_trains(draw: st.DrawFn, *, order: int = 24) -> Train:
    """Two to five inertias joined one after the other by a mesh, a coupling or a shaft, and held by up to two shafts more."""

    def number(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    def shaft(name: str, start: str, end: str) -> Shaft:
        if draw(st.booleans()):
            return Shaft(name=name, start=start, end=end, torsional_stiffness=10 ** number(2, 6))
        return Shaft(name=name, start=start, end=end, length=number(100, 1000), diameter=number(15, 80))

    count = draw(st.integers(2, 5))
    names = [f"i{place}" for place in range(count)]
    shafts, meshes = [], []
    for place in range(1, count):
        before, here = names[draw(st.integers(0, place - 1))], names[place]
        if draw(st.booleans()):
            shafts.append(shaft(f"s{place}", before, here))
        else:
            radii = (number(20, 100), number(101, 200))
            internal, k = draw(st.booleans()), number(50, 900)
            meshes.append(
                ToothMesh(
                    name=f"m{place}", pinion=before, wheel=here, base_radii=radii, stiffness=k, teeth=20, internal=internal
                )
            )
    for place in range(draw(st.integers(0, 2))):
        shafts.append(shaft(f"g{place}", GROUND, draw(st.sampled_from(names))))
    inertias = [Inertia(name=name, inertia=10 ** number(-3, 0)) for name in names]
    return Train(model="elements", inertias=inertias, shafts=shafts, meshes=meshes, order=order)
