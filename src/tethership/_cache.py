"""JAX's persistent compilation cache, so that a second start does not compile again. Depends on: platformdirs."""

import os
import sys
import warnings
from typing import Any


def use_compilation_cache() -> None:
    """Keep compiled programs in the user's cache folder; a folder set by the user is left alone.

    `JAX_COMPILATION_CACHE_DIR` names another folder; set empty, it switches the cache off.
    """
    import jax
    import platformdirs

    if "JAX_COMPILATION_CACHE_DIR" in os.environ or jax.config.values["jax_compilation_cache_dir"]:
        return
    jax.config.update("jax_compilation_cache_dir", platformdirs.user_cache_dir("tethership") + "/jax")
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)


def checks_without_callbacks() -> None:
    """Have Equinox's run-time checks give NaN; what the user has set in `EQX_ON_ERROR` is left alone.

    Notes
    -----
    Equinox reads the variable once, when it is imported. Where that has happened already (by diffrax, say) its own
    copy is changed; where a later version has none, a warning says what to do.
    """
    if "EQX_ON_ERROR" in os.environ:
        return
    os.environ["EQX_ON_ERROR"] = "nan"
    if "equinox" not in sys.modules:
        return
    errors: Any = sys.modules.get("equinox._errors")
    if hasattr(errors, "EQX_ON_ERROR"):
        errors.EQX_ON_ERROR = "nan"
    else:
        warnings.warn(
            "equinox was imported before tethership, so that every start will compile anew, some three times as slow: "
            "import tethership first, or set EQX_ON_ERROR=nan",
            stacklevel=3,
        )
