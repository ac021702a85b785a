"""Laws of one's own that a scenario names, imported and made. Depends on: control, scenario.control_schema.

A file that names code runs it only when told so: a scenario from elsewhere must not.
"""

import importlib
import sys
from pathlib import Path
from typing import Any

import jax.numpy as jnp

from tethership.control import AbstractLaw
from tethership.errors import ConfigError, suggestion
from tethership.scenario.control_schema import OwnLawConfig


def make_law(config: OwnLawConfig) -> AbstractLaw:
    """Return a law of one's own with its numbers.

    Raises
    ------
    ConfigError
        Its class cannot be imported, is no law, or does not take these numbers.
    """
    kind = _kind(config)
    try:
        return kind(**{name: jnp.asarray(value) for name, value in config.numbers.items()})
    except TypeError as error:
        raise ConfigError(f"law {config.name!r}: {config.model} does not take these numbers: {error}") from error


def _kind(config: OwnLawConfig) -> Any:
    """Return the class that a law names."""
    module, _, name = config.model.partition(":")
    try:
        found = importlib.import_module(module)
    except Exception as error:
        raise ConfigError(
            f"law {config.name!r}: {module} cannot be imported ({type(error).__name__}: {error}); it must lie beside "
            "the scenario's file or on Python's path"
        ) from error
    kind = getattr(found, name, None)
    if kind is None:
        raise ConfigError(f"law {config.name!r}: {module} has no {name!r}{suggestion(name, dir(found))}")
    if not (isinstance(kind, type) and issubclass(kind, AbstractLaw)):
        raise ConfigError(
            f"law {config.name!r}: {config.model} is no law; make it a subclass of tethership.AbstractLaw"
        )
    return kind


def find_beside(file: str) -> None:
    """Let modules beside a scenario's file be imported; a packaged scenario has none."""
    folder = str(Path(file).resolve().parent)
    if file.endswith(".toml") and folder not in sys.path:
        sys.path.append(folder)
