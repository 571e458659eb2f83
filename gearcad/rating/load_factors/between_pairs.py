"""K_Halpha and K_Falpha of a pair: by Method B of ISO 6336-1, or as given."""

from __future__ import annotations

from gearcad.rating.deviations import base_pitch_deviations, profile_form_deviations
from gearcad.rating.iso6336_2 import contact_ratio_factor
from gearcad.rating.load_factor_options import AlphaDeviation
from gearcad.rating.load_factors.finding import GIVEN, Finding
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.load_factors.transverse import flank_limit, root_limit, transverse_load_factor, within

__all__ = ["transverse_load_factors"]


def transverse_load_factors(mesh: LoadedMesh, mean_load: float) -> Finding:
    """K_Halpha and K_Falpha under F_tH/b (N/mm), by the larger of f_pb and f_falpha. Raises ParameterError as tolerances do."""
    given = mesh.options.transverse_load_factor
    if not isinstance(given, str):
        return Finding(factors={"K_Halpha": given, "K_Falpha": given}, sources={"K_Halpha": GIVEN, "K_Falpha": GIVEN})
    pair, stiffness = mesh.pair, mesh.stiffness.mesh_alpha
    gamma, alpha = pair.total_contact_ratio, pair.transverse_contact_ratio
    pitch, profile = max(base_pitch_deviations(pair, mesh.options)), max(profile_form_deviations(pair, mesh.options))
    deviation = max(pitch, profile)
    literal = mesh.options.alpha_deviation_rule is AlphaDeviation.LITERAL
    worn = float(mesh.wear.alpha(deviation if literal else pitch, mesh.speed))
    factor = transverse_load_factor(gamma, stiffness, deviation, worn, mean_load)
    of_flank = flank_limit(gamma, alpha, contact_ratio_factor(alpha, pair.overlap_ratio))
    of_root = root_limit(gamma, alpha)
    return Finding(
        factors={"K_Halpha": within(factor, of_flank), "K_Falpha": within(factor, of_root)},
        sources=dict.fromkeys(("K_Halpha", "K_Falpha"), mesh.cited("8.3", "Method B")),
        details={
            "F_tH_b": mean_load,
            "f_pb": pitch,
            "f_falpha": profile,
            "y_alpha": worn,
            "c_gamma_alpha": stiffness,
            "K_alpha": factor,
            "K_Halpha_max": of_flank,
            "K_Falpha_max": of_root,
        },
    )
