"""JAX's persistent compilation cache, so that a second start does not compile again. Depends on: platformdirs."""

import os

import jax
import platformdirs


def use_compilation_cache() -> None:
    """Keep compiled programs in the user's cache folder; a folder set by the user is left alone.

    `JAX_COMPILATION_CACHE_DIR` names another folder; set empty, it switches the cache off.
    """
    if "JAX_COMPILATION_CACHE_DIR" in os.environ or jax.config.values["jax_compilation_cache_dir"]:
        return
    jax.config.update("jax_compilation_cache_dir", platformdirs.user_cache_dir("tethership") + "/jax")
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.config.update("jax_persistent_cache_min_entry_size_bytes", -1)
