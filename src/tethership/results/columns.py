"""A flight as a flat table: one row an instant, one column a component, its unit in its name. Depends on: errors.

A column is called by the output, the labels of its other dimensions and its unit, `velocity_forward [m/s]`,
`load_moment_fins_starboard [N m]`, `cable_curve_nose_16_down [m]`; `time [s]` is the index.
"""

import contextlib
import importlib
import io
import itertools
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from tethership._extras import needs
from tethership.errors import ConfigError

if TYPE_CHECKING:
    import pandas as pd

LONGEST_NAME = 63
"""Characters of a name in MATLAB."""


def to_frame(data: xr.Dataset) -> "pd.DataFrame":
    """Return a flight's dataset as a pandas table: a row an instant, index `time [s]`, columns like `tension_nose [N]`.

    Every column has the unit of its output in its name; a dataset that says none counts as [1].
    """
    import pandas as pd

    columns: dict[str, np.ndarray] = {}
    for name, variable in data.data_vars.items():
        others = [dim for dim in variable.dims if dim != "time"]
        values = variable.transpose("time", *others).to_numpy()
        labels = [variable[dim].to_numpy() for dim in others]  # a dimension without labels gives numbers
        for place in itertools.product(*(range(len(of)) for of in labels)):
            parts = [str(name), *(str(of[i]) for of, i in zip(labels, place, strict=True))]
            unit = variable.attrs.get("units", "1")
            column = f"{'_'.join(parts)} [{unit}]"
            if column in columns:  # a cable called largest_x, beside tension_largest of x
                column = f"{'.'.join(parts)} [{unit}]"
            columns[column] = values[:, *place]
    return pd.DataFrame(columns, index=pd.Index(data["time"].to_numpy(), name="time [s]"))


def _csv(frame: "pd.DataFrame") -> bytes:
    """Return the table as CSV, every digit of it."""
    return frame.to_csv(lineterminator="\n").encode()


def _parquet(frame: "pd.DataFrame") -> bytes:
    """Return the table as Apache Parquet."""
    with needs("parquet"):
        importlib.import_module("pyarrow")
    return frame.to_parquet(engine="pyarrow")


def _mat(frame: "pd.DataFrame") -> bytes:
    """Return the table as variables of MATLAB, columns of numbers, their units in the struct `units`."""
    from scipy.io import savemat

    held, units = {}, {}
    for column, values in frame.reset_index().items():
        name, unit = str(column).removesuffix("]").rsplit(" [", 1)
        valid = _valid_name(name, held)
        held[valid], units[valid] = values.to_numpy(), unit
    stream = io.BytesIO()
    savemat(stream, {**held, "units": units}, long_field_names=True, oned_as="column")
    return stream.getvalue()


def _valid_name(name: str, taken: dict[str, np.ndarray]) -> str:
    """Return a name that MATLAB takes and that is not taken."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
    endings = itertools.chain([""], (f"_{i}" for i in itertools.count(2)))
    return next(n for end in endings if (n := plain[: LONGEST_NAME - len(end)] + end) not in taken)


FORMATS: dict[str, Callable[["pd.DataFrame"], bytes]] = {"csv": _csv, "parquet": _parquet, "mat": _mat}
"""What a table can be written as, by the ending of the file's name."""


def write_table(frame: "pd.DataFrame", path: Path, kind: str) -> None:
    """Write a table; the file appears whole or not at all, and none is overwritten.

    Raises
    ------
    ConfigError
        The file exists, cannot be written, or the format needs a package that is missing.
    """
    if path.exists():
        raise ConfigError(f"{path} exists already; nothing is overwritten: name another file with --out")
    content = FORMATS[kind](frame)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        os.replace(part, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        raise ConfigError(f"cannot write {path}: {error.strerror or error}; choose another place with --out") from error
