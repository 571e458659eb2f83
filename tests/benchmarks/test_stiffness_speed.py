"""Timings of mesh stiffness in closed form, side by side with ROSS's gear element where it is installed (the `bench` extra).

`pytest -m benchmark_suite tests/benchmarks/test_stiffness_speed.py --benchmark-columns=median,rounds -s`

Times are after imports, on one core, from the gears' own data on: their profiles are part of them. Compare within one run.
"""

import math
import time
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.records import PerGear
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness import CLOSED_FORMS, METHODS, PotentialEnergy, StiffnessMethod

pytestmark = pytest.mark.benchmark_suite

PAIRS = {"20/40": ((20, 40), (20.0, 40.0)), "60/62": ((60, 62), (70.0, 70.0))}
"""Teeth, and bores in mm, of spur gears with module 2 mm, 20 mm wide, without profile shift."""

POSITIONS = 200

SECONDS = 0.1
"""What all methods in closed form may take together. They take 0.02 to 0.04 s."""

RATIO = 20.0
"""How many times as long as our potential energy ROSS must take: it takes 35 times (on a busy machine) to 95 times as long."""

SAME_TOOTH = 1e-9
"""Relative difference in bending, shear and axial stiffness: both integrate them along the same involute and trochoid."""

ANGLES = (16.0, 20.0, 23.0, 24.0)
"""Pressure angles of contact points in degrees, on the involutes of all these gears."""

_MODULE, _WIDTH, _YOUNG, _POISSON = 2.0, 20.0, 206e3, 0.3
_RACK = BasicRack(dedendum=1.25, root_radius=0.25 / (1 - math.sin(math.radians(20.0))))
"""The tool of ROSS: its tip is round for the whole of the clearance."""


def _method(of: type[StiffnessMethod], name: str) -> StiffnessMethod:
    """A method with new gears, which have no profile yet."""
    teeth, bores = PAIRS[name]
    pinion, wheel = (Gear(teeth=z, normal_module=_MODULE, face_width=_WIDTH, rack=_RACK) for z in teeth)
    material, body = Material(youngs_modulus=_YOUNG, poisson_ratio=_POISSON), BodyModel(inner_diameters=PerGear(*bores))
    return of(pair=GearPair(pinion=pinion, wheel=wheel), material=material, body=body, positions=POSITIONS)


def _cycles(methods: tuple[str, ...], name: str) -> list[MeshCycle]:
    return [_method(METHODS[of], name)(Load(torque=50.0)) for of in methods]


def _ross_mesh(name: str) -> Any:
    """The pair in ROSS (SI units). Its constructor evaluates 1000 positions, which no time here holds."""
    # Here and not above: ROSS takes seconds to import, also where no timing is wanted.
    ross = pytest.importorskip("ross", reason="the bench extra is not installed")
    steel = ross.Material("Steel", rho=7850, E=1e6 * _YOUNG, Poisson=_POISSON)
    gears = (
        ross.GearElementTVMS(
            n=0, material=steel, width=1e-3 * _WIDTH, bore_diameter=1e-3 * bore, module=1e-3 * _MODULE, n_teeth=teeth,
            pr_angle=math.radians(20.0), addendum_coeff=1.0, tip_clearance_coeff=0.25,
        )
        for teeth, bore in zip(*PAIRS[name], strict=True)
    )  # fmt: skip
    return ross.Mesh(*gears)


def _median_seconds(run: Callable[[], Any], rounds: int) -> float:
    run()  # imports are done
    seconds = []
    for _ in range(rounds):
        began = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - began)
    return median(seconds)


@pytest.mark.parametrize("name", PAIRS)
def test_all_closed_forms(benchmark: Any, name: str) -> None:
    benchmark.group = f"mesh stiffness in closed form at {POSITIONS} positions: {name}"
    with threadpool_limits(1):
        cycles = benchmark.pedantic(lambda: _cycles(CLOSED_FORMS, name), rounds=15, warmup_rounds=2)
    assert all(len(cycle.roll_angle) >= POSITIONS for cycle in cycles if not cycle.mean_only)
    assert benchmark.stats.stats.median < SECONDS


# ROSS warns that Sainsot's series is extrapolated, for each tooth at each position.
@pytest.mark.filterwarnings("ignore:Extrapolating gear body coefficients")
@pytest.mark.parametrize("name", PAIRS)
def test_ratio_to_ross(benchmark: Any, name: str) -> None:
    mesh = _ross_mesh(name)
    benchmark.group = f"mesh stiffness, potential energy at {POSITIONS} positions: {name}"
    with threadpool_limits(1):
        benchmark.pedantic(lambda: _cycles((PotentialEnergy.name,), name), rounds=15, warmup_rounds=2)
        ross = _median_seconds(lambda: mesh.get_stiffness_for_mesh_period(n_points=POSITIONS), rounds=5)
    own = benchmark.stats.stats.median
    benchmark.extra_info |= {"ROSS": ross, "ratio": ross / own}
    print(f"\n{name}: potential energy {1e3 * own:.1f} ms, ROSS {1e3 * ross:.0f} ms, ratio {ross / own:.0f}")
    assert ross > RATIO * own


@pytest.mark.filterwarnings("ignore:Extrapolating gear body coefficients")
@pytest.mark.parametrize("name", PAIRS)
def test_ross_has_the_same_teeth(name: str) -> None:
    """Like is timed with like.

    Foundations differ: ROSS takes u up to the contact instead of to the centre line, and a theta_f without the clearance.
    """
    mesh, method = _ross_mesh(name), _method(PotentialEnergy, name)
    assert isinstance(method, PotentialEnergy)
    angles = np.radians(ANGLES)
    for role, element in PerGear(mesh.driving_gear, mesh.driven_gear).items():
        load = method.teeth.pick(role).load_at(1e3 * element.base_radius * np.tan(angles))
        parts = method.tooth_parts(role, load)
        for part, formula in (("bending", element._inv_kb), ("shear", element._inv_ks), ("axial", element._inv_ka)):
            theirs = [formula(element._to_tau(angle)) for angle in angles]  # m/N
            np.testing.assert_allclose(1e-3 * parts[part] / _WIDTH, theirs, rtol=SAME_TOOTH)
