"""The paper's study: its figures and claims, computed. Data only; `view` draws them.

Riboldi, Croce, Pagani, He, Bortolini, *Airship dynamics in a tethered docking maneuver*.
"""

from tethership.studies.docking_paper.claim import Claim
from tethership.studies.docking_paper.linear_claims import CLAIMS, check_claims
from tethership.studies.docking_paper.linear_figures import FIGURES, LinearFigure, Panel, linear_figure

__all__ = ["CLAIMS", "FIGURES", "Claim", "LinearFigure", "Panel", "check_claims", "linear_figure"]
