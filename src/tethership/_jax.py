"""JAX as this package needs it: set up when it is first imported, by whatever imports it. Depends on: nothing.

Importing this package must not import JAX, which takes half a second that `tethership --version` does not have. So
the one place through which every import of JAX goes, Python's own, is told what to do once it is there.
"""

import importlib.util
import sys
from importlib.machinery import ModuleSpec
from typing import Any

from tethership._cache import use_compilation_cache


def set_up() -> None:
    """Switch JAX to double precision and keep what it compiles."""
    import jax

    jax.config.update("jax_enable_x64", True)
    use_compilation_cache()


class _OnceImported:
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
        """Return where JAX is; of anything else nothing is known here."""
        return self._spec if fullname == "jax" else None


def set_up_once_imported() -> None:
    """Set JAX up now if it is there, else as soon as anything imports it."""
    if "jax" in sys.modules:
        set_up()
    elif spec := importlib.util.find_spec("jax"):
        sys.meta_path.insert(0, _OnceImported(spec))
