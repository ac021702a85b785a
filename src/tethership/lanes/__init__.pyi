from .compiler import identity as identity
from .not_compiled import NotCompiled as NotCompiled
from .program import Program as Program
from .program import Taken as Taken
