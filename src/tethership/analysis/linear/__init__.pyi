from .linearize import comparable_coordinates as comparable_coordinates
from .linearize import linearize as linearize
from .model import LinearModel as LinearModel
from .right_side import input_vector as input_vector
from .right_side import right_side as right_side
from .semi_analytic import SemiAnalytic as SemiAnalytic
from .semi_analytic import semi_analytic as semi_analytic
