"""A rating of external pairs by ISO 6336:2006, Methods B and C, one number after the other: shares nothing with the package.

Written from the equations alone, for steel of equal E, full discs with bores, nominal teeth and load cycles in the endurance
range. Standard's symbols throughout; lists are [pinion, wheel]; mm, N, MPa, µm, m/s.
"""

from dataclasses import dataclass
from itertools import pairwise
from math import acos, atan, cos, degrees, floor, hypot, log, pi, radians, sin, sqrt, tan
from typing import Any

D = (5, 20, 50, 125, 280, 560, 1000, 1600)
M = (0.5, 2, 3.5, 6, 10, 16)
B = (4, 10, 20, 40, 80, 160, 250, 400)
"""Limits of the ranges of ISO 1328-1:1995."""

HARDENED = ("Eh", "IF", "NT", "NV")
B_1_B_2 = {"none": (1, 1), "crowning": (1, 0.5), "helix correction": (0.1, 1), "end relief": (0.7, 0.7)}


@dataclass(frozen=True, kw_only=True)
class PlainGear:
    """A gear with what it bears; `strength` is sigma_0.2 of V, HB the hardness of V after Brinell."""

    z: int
    x: float
    b: float
    bore: float
    group: str
    sigma_Hlim: float
    sigma_Flim: float
    grade: int
    Rz: float
    Rz_root: float
    strength: float = 0.0
    HB: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PlainPair:
    """A pair, its load on the pinion (N·m, rpm), its life (h), its oil, and the place of the pinion on its shaft."""

    gears: tuple[PlainGear, PlainGear]
    m: float
    beta: float
    T: float
    n: float
    life: float
    K_A: float
    K_gamma: float
    nu_40: float
    modification: str
    shaft: tuple[float, float, float, float] | None
    """l, s, d_sh and K'; None in the middle."""


def plain_rating(p: PlainPair) -> dict[str, Any]:
    """Factors, stresses and safeties under their symbols."""
    g = _geometry(p)
    return g | (k := _load_factors(p, g)) | _flank(p, g, k) | _root(p, g, k)


def _inv(a: float) -> float:
    return tan(a) - a


def _geometry(p: PlainPair) -> dict[str, Any]:
    a_n, beta = radians(20), radians(p.beta)
    a_t = atan(tan(a_n) / cos(beta))
    z, x = [q.z for q in p.gears], [q.x for q in p.gears]
    d = [p.m * each / cos(beta) for each in z]
    d_b = [each * cos(a_t) for each in d]
    wanted, a_wt = _inv(a_t) + 2 * sum(x) * tan(a_n) / sum(z), a_t
    for _ in range(60):
        a_wt -= (_inv(a_wt) - wanted) / tan(a_wt) ** 2
    a_d = sum(d) / 2
    a = a_d * cos(a_t) / cos(a_wt)
    k = min(0.0, (a - a_d) / p.m - sum(x))
    d_a = [q + 2 * p.m * (1 + w + k) for q, w in zip(d, x, strict=True)]
    d_f = [q - 2 * p.m * (1.25 - w) for q, w in zip(d, x, strict=True)]
    b = min(q.b for q in p.gears)
    reach = sum(sqrt(q**2 - w**2) for q, w in zip(d_a, d_b, strict=True)) / 2 - a * sin(a_wt)
    beta_b = atan(tan(beta) * cos(a_t))
    F_t = 2000 * p.T / d[0]
    return {
        "z": z, "d": d, "d_b": d_b, "d_a": d_a, "d_f": d_f, "a_t": a_t, "a_wt": a_wt, "beta_b": beta_b, "b": b,
        "u": z[1] / z[0],
        "eps_a": reach * cos(beta) / (pi * p.m * cos(a_t)), "eps_b": b * sin(beta) / (pi * p.m), "F_t": F_t,
        "z_n": [q / (cos(beta_b) ** 2 * cos(beta)) for q in z], "v": pi * d[0] * p.n / 60_000, "w": F_t * p.K_A * p.K_gamma / b,
    }  # fmt: skip


def _mean(value: float, limits: tuple[float, ...]) -> float:
    least = max(limit for limit in limits if limit < value)
    return sqrt(least * limits[limits.index(least) + 1])


def _rounded(value: float) -> float:
    return floor(value + 0.5) if value > 10 else floor(2 * value + 0.5) / 2 if value >= 5 else floor(10 * value + 0.5) / 10


def _deviations(p: PlainPair, gear: PlainGear, d: float) -> tuple[float, float, float]:
    """f_pt, f_falpha and f_Hbeta by ISO 1328-1:1995."""
    m, d, b, q = _mean(p.m, M), _mean(d, D), _mean(gear.b, B), 2 ** ((gear.grade - 5) / 2)
    fifth = 0.3 * (m + 0.4 * sqrt(d)) + 4, 2.5 * sqrt(m) + 0.17 * sqrt(d) + 0.5, 0.07 * sqrt(d) + 0.45 * sqrt(b) + 3
    f_pt, f_f, f_H = (_rounded(q * each) for each in fifth)
    return f_pt, f_f, f_H


def _worn(p: PlainPair, v: float, f: float, *, alpha: bool) -> float:
    """y_alpha or y_beta: the mean over both gears."""
    total = 0.0
    for gear in p.gears:
        if gear.group in HARDENED:
            total += min(0.075 * f, 3) if alpha else min(0.15 * f, 6)
        else:
            most = 1e9 if v <= 5 else (12800 if alpha else 25600) / (2 if v > 10 else 1) / gear.sigma_Hlim
            total += min((160 if alpha else 320) / gear.sigma_Hlim * f, most)
    return total / 2


def _load_factors(p: PlainPair, g: dict[str, Any]) -> dict[str, Any]:
    (x_1, x_2), (z_1, z_2), w, d, b = [q.x for q in p.gears], g["z_n"], g["w"], g["d"], g["b"]
    q = 0.04723 + 0.15551 / z_1 + 0.25791 / z_2 - 0.00635 * x_1 - 0.11654 * x_1 / z_1 - 0.00193 * x_2 - 0.24188 * x_2 / z_2
    q += 0.00529 * x_1**2 + 0.00182 * x_2**2
    c = 0.8 * 0.975 * cos(radians(p.beta)) / q * min(1, w / 100) ** 0.25
    c_a = c * (0.75 * g["eps_a"] + 0.25)
    d_m = [(top + low) / 2 for top, low in zip(g["d_a"], g["d_f"], strict=True)]
    bodies = [
        pi / 8 * 7850e-9 * (1 - (gear.bore / mean) ** 4) * mean**4 / base**2
        for gear, mean, base in zip(p.gears, d_m, g["d_b"], strict=True)
    ]
    N = p.n * pi * p.gears[0].z / 30_000 * sqrt(bodies[0] * bodies[1] / sum(bodies) / c_a)
    found = [_deviations(p, gear, each) for gear, each in zip(p.gears, d, strict=True)]
    f_pb, f_f = max(each[0] for each in found) * cos(g["a_t"]), max(each[1] for each in found)
    B_p, B_f = (c * (f - _worn(p, g["v"], f, alpha=True)) / w for f in (f_pb, f_f))
    K_v = _dynamic(N, B_p, B_f, w, g["eps_a"] + g["eps_b"])
    F_m = w * K_v
    span, s, d_sh, K = p.shaft or (0, 0, 1, 0)
    f_sh = F_m * 0.023 * (abs(1 + K * span * s / d[0] ** 2 * (d[0] / d_sh) ** 4 - 0.3) + 0.3) * (b / d[0]) ** 2
    B_1, B_2 = B_1_B_2[p.modification]
    slopes = [each[2] for each in found]
    F_x = max(1.33 * B_1 * f_sh + B_2 * hypot(*slopes), 0.005 * F_m, 0.5 * max(slopes))
    over = (F_x - _worn(p, g["v"], F_x, alpha=False)) * 0.85 * c_a / (2 * F_m)
    K_Hb = 2 * sqrt(over) if over >= 1 else 1 + over
    b_h = max(3, min(2 * gear.b / (top - low) for gear, top, low in zip(p.gears, g["d_a"], g["d_f"], strict=True)))
    K_Fb = K_Hb if p.modification in ("crowning", "end relief") else K_Hb ** (b_h**2 / (1 + b_h + b_h**2))
    f, eps = max(f_pb, f_f), g["eps_a"] + g["eps_b"]
    q_H = c_a * (f - _worn(p, g["v"], f, alpha=True)) / (F_m * K_Hb)
    K_a = eps / 2 * (0.9 + 0.4 * q_H) if eps <= 2 else 0.9 + 0.4 * sqrt(2 * (eps - 1) / eps) * q_H
    Z_e2 = (4 - g["eps_a"]) / 3 * (1 - g["eps_b"]) + g["eps_b"] / g["eps_a"] if g["eps_b"] < 1 else 1 / g["eps_a"]
    most = eps / (g["eps_a"] * Z_e2), eps / (0.25 * g["eps_a"] + 0.75)
    K_Ha, K_Fa = (max(1, min(K_a, each)) for each in most)
    return {"K_v": K_v, "K_Hbeta": K_Hb, "K_Fbeta": K_Fb, "K_Halpha": K_Ha, "K_Falpha": K_Fa, "Z_eps": sqrt(Z_e2), "N": N}


def _dynamic(N: float, B_p: float, B_f: float, w: float, eps: float) -> float:
    """K_v; B_k = 1, as from grade 6 on."""
    C = [0.32, 0.34, 0.23, 0.90, 0.47, 0.47, 0.75 if eps <= 1.5 else 0.125 * sin(pi * (eps - 2)) + 0.875]
    if eps > 2:
        C[1:4] = 0.57 / (eps - 0.3), 0.096 / (eps - 1.56), (0.57 - 0.05 * eps) / (eps - 1.44)
        C[5:] = 0.12 / (eps - 1.74), 1 if eps > 2.5 else C[6]
    N_S = 0.85 if w >= 100 else 0.5 + 0.35 * sqrt(w / 100)
    if N <= N_S:
        return N * (C[0] * B_p + C[1] * B_f + C[2]) + 1
    near, beyond = C[0] * B_p + C[1] * B_f + C[3] + 1, C[4] * B_p + C[5] * B_f + C[6]
    return near if N <= 1.15 else beyond if N >= 1.5 else beyond + (near - beyond) / 0.35 * (1.5 - N)


def _flank(p: PlainPair, g: dict[str, Any], k: dict[str, Any]) -> dict[str, Any]:
    u, eps_a, eps_b, a_wt, z = g["u"], g["eps_a"], g["eps_b"], g["a_wt"], g["z"]
    Z_H = sqrt(2 * cos(g["beta_b"]) * cos(a_wt) / (cos(g["a_t"]) ** 2 * sin(a_wt)))
    Z_E, Z_beta = sqrt(206000 / (2 * pi * (1 - 0.3**2))), 1 / sqrt(cos(radians(p.beta)))
    s_0 = Z_H * Z_E * k["Z_eps"] * Z_beta * sqrt(g["F_t"] / (g["d"][0] * g["b"]) * (u + 1) / u)
    r = [sqrt((top / base) ** 2 - 1) for top, base in zip(g["d_a"], g["d_b"], strict=True)]
    Z = []
    for one, two in ((0, 1), (1, 0)):
        inner = sqrt((r[one] - 2 * pi / z[one]) * (r[two] - (eps_a - 1) * 2 * pi / z[two]))
        whole = tan(a_wt) / inner
        Z.append(1 if eps_b >= 1 else max(1, whole - eps_b * (whole - 1)))
    common = sqrt(p.K_A * p.K_gamma * k["K_v"] * k["K_Hbeta"] * k["K_Halpha"])
    soft = min(gear.sigma_Hlim for gear in p.gears)
    C_L = 0.83 if soft < 850 else 0.91 if soft > 1200 else soft / 4375 + 0.6357
    C_R = 0.15 if soft < 850 else 0.08 if soft > 1200 else 0.32 - 0.0002 * soft
    Z_L = C_L + 4 * (1 - C_L) / (1.2 + 134 / p.nu_40) ** 2
    Z_v = C_L + 0.02 + 2 * (0.98 - C_L) / sqrt(0.8 + 32 / g["v"])
    r_1, r_2 = (base / 2 * tan(a_wt) for base in g["d_b"])
    rho = r_1 * r_2 / (r_1 + r_2)
    pinion, wheel = p.gears
    Z_R = (3 / ((pinion.Rz + wheel.Rz) / 2 * (10 / rho) ** (1 / 3))) ** C_R
    Z_W = [1.0, 1.0]
    if pinion.group in HARDENED and wheel.group == "V":
        R = pinion.Rz * (10 / rho) ** 0.33 * (pinion.Rz / wheel.Rz) ** 0.66 / (p.nu_40 * g["v"] / 1500) ** 0.33
        Z_W[1] = max(1, (1.2 - (min(470, max(130, wheel.HB)) - 130) / 1700) * (3 / min(16, max(3, R))) ** 0.15)
    elif pinion.group == wheel.group == "V" and (ratio := pinion.HB / wheel.HB) >= 1.2:
        Z_W[1] = 1 + (0.00698 if ratio > 1.7 else 0.00898 * ratio - 0.00829) * (min(u, 20) - 1)
    knees = [2e6 if gear.group in ("NT", "NV") else 5e7 for gear in p.gears]
    Z_NT = [0.85 ** (log(n / knee) / log(1e10 / knee)) for n, knee in zip(_cycles(p, g), knees, strict=True)]
    s_H = [each * s_0 * common for each in Z]
    s_HG = [q.sigma_Hlim * y * Z_L * Z_v * Z_R * hard for q, y, hard in zip(p.gears, Z_NT, Z_W, strict=True)]
    return {
        "Z_H": Z_H, "Z_E": Z_E, "Z_beta": Z_beta, "Z_B": Z[0], "Z_D": Z[1], "Z_L": Z_L, "Z_v": Z_v, "Z_R": Z_R, "Z_W": Z_W,
        "Z_NT": Z_NT, "sigma_H0": s_0, "sigma_H": s_H, "sigma_HG": s_HG, "S_H": [q / w for q, w in zip(s_HG, s_H, strict=True)],
    }  # fmt: skip


def _cycles(p: PlainPair, g: dict[str, Any]) -> list[float]:
    return [60 * p.n * p.life, 60 * p.n * p.life / g["u"]]


def _root(p: PlainPair, g: dict[str, Any], k: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, list[float]] = {}
    eps_an = g["eps_a"] / cos(g["beta_b"]) ** 2
    Y_beta = 1 - min(g["eps_b"], 1) * min(p.beta, 30) / 120
    common = p.K_A * p.K_gamma * k["K_v"] * k["K_Fbeta"] * k["K_Falpha"]
    for place, gear in enumerate(p.gears):
        Y_F, Y_S, q_s = _tooth(gear.x, g["z_n"][place], (g["d_a"][place] - g["d"][place]) / p.m, eps_an)
        s_0 = g["F_t"] / (min(gear.b, g["b"] + 2 * p.m) * p.m) * Y_F * Y_S * Y_beta
        rho = {"Eh": 0.003, "IF": 0.003, "NT": 0.1005, "NV": 0.1005}.get(gear.group) or _slip_of_v(gear.strength)
        Y_d = (1 + sqrt(0.2 * rho * (1 + 2 * q_s))) / (1 + sqrt(1.2 * rho))
        nitrided = gear.group in ("NT", "NV")
        Y_R = 4.299 - 3.259 * (gear.Rz_root + 1) ** 0.0058 if nitrided else 1.674 - 0.529 * (gear.Rz_root + 1) ** 0.1
        Y_X = 1.0 if p.m <= 5 else max(0.85, 1.03 - 0.006 * p.m) if gear.group == "V" else max(0.8, 1.05 - 0.01 * p.m)
        Y_NT = 0.85 ** (log(_cycles(p, g)[place] / 3e6) / log(1e10 / 3e6))
        s_FG, s_F = 2 * gear.sigma_Flim * Y_NT * Y_d * Y_R * Y_X, s_0 * common
        values = {"Y_F": Y_F, "Y_S": Y_S, "Y_delta_relT": Y_d, "Y_RrelT": Y_R, "Y_X": Y_X, "Y_NT": Y_NT, "sigma_F0": s_0}
        for symbol, value in (values | {"sigma_F": s_F, "sigma_FG": s_FG, "S_F": s_FG / s_F}).items():
            found.setdefault(symbol, []).append(value)
    return {"Y_beta": Y_beta, **found}


def _slip_of_v(strength: float) -> float:
    points = ((500, 0.0281), (600, 0.0194), (800, 0.0064), (1000, 0.0014))
    (low, first), (high, last) = next(pair for pair in pairwise(points) if strength <= pair[1][0])
    return first + (last - first) * (strength - low) / (high - low)


def _tooth(x: float, z: float, tip: float, eps_an: float) -> tuple[float, float, float]:
    """Y_F, Y_S and q_s of the virtual tooth in modules; `tip` is (d_a - d)/m_n. Rack ISO 53 A."""
    a, rho = radians(20), 0.38
    E = pi / 4 - 1.25 * tan(a) - (1 - sin(a)) * rho / cos(a)
    G, H, theta = rho - 1.25 + x, 2 / z * (pi / 2 - E) - pi / 3, pi / 6
    for _ in range(300):
        theta = 2 * G / z * tan(theta) - H
    s = z * sin(pi / 3 - theta) + sqrt(3) * (G / cos(theta) - rho)
    fillet = rho + 2 * G**2 / (cos(theta) * (z * cos(theta) ** 2 - 2 * G))
    base = z * cos(a)
    reach = sqrt((z + tip) ** 2 - base**2) / 2 - pi * cos(a) * (eps_an - 1)
    d_e = 2 * hypot(reach, base / 2)
    a_e = acos(base / d_e)
    gamma = (pi / 2 + 2 * x * tan(a)) / z + _inv(a) - _inv(a_e)
    a_F = a_e - gamma
    h = ((cos(gamma) - sin(gamma) * tan(a_F)) * d_e - z * cos(pi / 3 - theta) - (G / cos(theta) - rho)) / 2
    q_s, L = s / (2 * fillet), s / h
    assert degrees(theta) < 60
    return 6 * h * cos(a_F) / (s**2 * cos(a)), (1.2 + 0.13 * L) * q_s ** (1 / (1.21 + 2.3 / L)), q_s
