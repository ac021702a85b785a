"""Misprints of the paper and how each was settled. Data only.

They were found by deriving every equation again; the last column says what holds them in place here.
"""

from typing import NamedTuple


class Misprint(NamedTuple):
    """One misprint.

    Attributes
    ----------
    where : str
        Equation or table.
    printed, meant : str
        What stands there, and what has to.
    evidence : str
        How it was settled.
    """

    where: str
    printed: str
    meant: str
    evidence: str


MISPRINTS = (
    Misprint(
        "Table 2",
        "k1, k2, k3, k′ in kg, Jᵃ in kg m²",
        "factors without unit, and a squared radius of gyration in m²",
        "Lamb's formulas give the printed k1, k2; ρ𝒱 then makes masses of the right size",
    ),
    Misprint("Eq. 11, Eq. 25", "moment without its cross", "q × T, q × F", "a force makes no moment without its arm"),
    Misprint("Eq. 17 and 18", "a sign rule and a modulus", "one signed cos α", "the same force, without a case"),
    Misprint(
        "Eq. 20, 21, 24",
        "L̄ = ȳ₂/L_t; signs of Λ and of the force",
        "L̄ = L_t/ȳ₂; Λ and force as in the theory pages",
        "closed-form catenary, MoorPy to 1e-6, the paper's own 14 N (tests/validation)",
    ),
    Misprint(
        "Eq. 27, 37",
        "second term −(Mⁱw₀)× by operator (4)",
        "−C(Mⁱw₀), C(p, H) = [[0, p×], [p×, H×]]",
        "exact differentiation agrees to 9e-16; at rest both vanish, so no figure of the paper sees it",
    ),
    Misprint("Eq. 34", "components not said", "body components", "exact differentiation"),
    Misprint(
        "Eq. 40",
        "½ q_T2x/q_T3x, which is negative",
        "its modulus: two equal contributions to the pitching moment, as the text asks",
        "as printed #3, #4 cancel the moment of #2; the misfit of that reading is in the table of variants",
    ),
    Misprint(
        "Eq. 41, Table A.2",
        "F′ = 144.3 N, called a third of 481 N",
        "160.3 N",
        "Table 4 at 6 m/s: peak 156 N, rewind rate never reduced; only 160.3 N allows that",
    ),
    Misprint(
        "Eq. 42",
        "how the angle is computed is not said",
        "arcsine of the cross product of unit vectors",
        "misfit of the readings, in the table of variants: over the full circle the side thrusters chatter with the "
        "anchor astern, which the printed ADC and E exclude",
    ),
    Misprint(
        "Eq. 43",
        "+κ_U (U − Ū); index sets 1, 3, 4 / 2 / 4, 5",
        "−κ_U (U − Ū); 1, 5, 6 / 2 / 3, 4, as the text has them",
        "the printed sign is anti-damping; its misfit is in the table of variants",
    ),
)
"""All that were found."""
