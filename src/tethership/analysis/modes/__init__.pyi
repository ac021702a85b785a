from .modes import Mode as Mode
from .modes import Modes as Modes
from .spectrum import Complex as Complex
from .spectrum import Real as Real
