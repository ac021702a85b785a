"""JAX as this package needs it: set up when first imported, whole before threads meet in it. Depends on: nothing.

Importing this package must not import JAX, which takes half a second that `tethership --version` does not have. So
the one place through which every import goes, Python's own, is told what to do.

Two threads must not import JAX or numpy at the same time: where one is in the middle of `import jax`, Python lets
another begin with `jax.numpy`, and they meet modules half made ("partially initialized", "deadlock detected") or wait
for each other for ever. So JAX is imported, as a whole and numpy with it, before any module of this package that uses
either: the second thread then waits for the first.
"""

import importlib.util
import sys
from importlib.machinery import ModuleSpec
from typing import Any

from tethership._cache import use_compilation_cache

COMMAND = ("cli.", "studies.docking_paper.cli.")
"""Modules of commands begin so: they import what computes when they are called."""

PLAIN = (
    "results.files",
    "results.limits",
    "results.lock",
    "results.metric_names",
    "results.schema",
    "scenario.packaged",
    "scenario.reading",
    "scenario.units",
    "studies.docking_paper",
    "studies.docking_paper.cli",
)
"""Other modules with neither JAX nor numpy, and packages that hold such ones."""

COMPUTING = ("_kept", "_outline", "_programs", "cli.between", "studies.docking_paper.cli.figures")
"""Modules of the package's root and of commands that compute."""


def computes(name: str) -> bool:
    """Return whether a module is one that uses JAX or numpy; the faces of rooms use nothing."""
    package, _, inside = name.partition(".")
    if package != "tethership" or inside in PLAIN:
        return False
    return inside in COMPUTING or ("." in inside and not inside.startswith(COMMAND))


def set_up() -> None:
    """Switch JAX to double precision and keep what it compiles."""
    import jax

    jax.config.update("jax_enable_x64", True)
    use_compilation_cache()


class _Finder:
    """Finds JAX where Python does, and sets it up before its import ends: no thread sees it as it was."""

    def __init__(self, spec: ModuleSpec) -> None:
        self._spec = spec
        loader: Any = spec.loader
        run = loader.exec_module

        def run_and_set_up(module: Any) -> None:
            run(module)
            set_up()

        loader.exec_module = run_and_set_up

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Return where JAX is; of anything else only that JAX must be there first."""
        if computes(fullname):
            import jax  # noqa: F401
        return self._spec if fullname == "jax" else None


def set_up_once_imported() -> None:
    """Set JAX up now if it is there, else as soon as anything imports it."""
    if "jax" in sys.modules:
        set_up()
    elif spec := importlib.util.find_spec("jax"):
        sys.meta_path.insert(0, _Finder(spec))
