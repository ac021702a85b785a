"""Packages that only some parts need: where one is missing, what it is for and what to install. Depends on: errors."""

from collections.abc import Iterator
from contextlib import contextmanager

from tethership.errors import ConfigError

EXTRAS = {
    "campaign": "a campaign",
    "cluster": "--scheduler",
    "control": "a model for python-control",
    "explore": "the explorer",
    "parquet": "parquet",
    "plots": "a plot to be explored",
    "reproduce": "a dynamic cable",
}
"""Optional dependencies of this package by name, and what needs them."""


@contextmanager
def needs(extra: str) -> Iterator[None]:
    """Import what an extra brings: ``with needs("campaign"): import zarr``.

    Raises
    ------
    ConfigError
        It is not installed.
    """
    try:
        yield
    except ImportError as error:
        missing = (error.name or extra).partition(".")[0]
        if missing == "tethership":  # our own mistake, which nothing installs away
            raise
        said = f"{EXTRAS[extra]} needs {missing}, which is not installed: pip install 'tethership[{extra}]'"
        raise ConfigError(said) from error
