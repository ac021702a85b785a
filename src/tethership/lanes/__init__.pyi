from .compiler import identity as identity
from .compiler import widest as widest
from .not_compiled import NotCompiled as NotCompiled
from .program import Program as Program
from .program import Recipe as Recipe
from .program import Taken as Taken
