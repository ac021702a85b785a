"""Times of samples from numbers or ISO 8601 stamps. Depends on: errors."""

import datetime
import re
from pathlib import Path

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import Column
from tethership.scenario.wind_record.names import factor_to_si, has_unit

EPOCHS = {1e-3: "ms", 1e-6: "µs", 1e-9: "ns"}
"""Units in which the time since 1970 is counted."""

SINCE_2000, TO_2100 = 9.4e8, 4.1e9
"""Seconds from 1970 to the years between which a number without a unit may be a date."""

SHORTEST_STEP = 1e-3
"""Usual step below which the times cannot be seconds [s]: no anemometer samples as fast."""


def read_times(column: Column, dates: Column | None, path: Path) -> tuple[np.ndarray, list[str]]:
    """Return the times from the first sample on [s], and what had to be guessed.

    Parameters
    ----------
    column : Column
        Numbers, in the column's unit or seconds, or texts: numbers, or stamps `2021-03-04T12:00:00Z`.
    dates : Column, optional
        Days, where the column holds times of day.
    path : Path
        For messages.

    Raises
    ------
    ConfigError
        A time is missing or none, its unit is none, or the times do not rise.
    """
    values, remarks = column.values, []
    if values.dtype.kind in "OSU":
        texts = [(t.decode("utf-8", "replace") if isinstance(t, bytes) else str(t)).strip() for t in values]
        numbers = _numbers(texts)
        values = _from_stamps(texts, dates, column.name, path) if numbers is None else numbers
        if numbers is None:
            column = column._replace(unit="s")
    if not np.all(np.isfinite(values)):
        raise ConfigError(f"{path}: sample {int(np.argmin(np.isfinite(values))) + 1} has no {column.name}; give it one")
    largest = float(np.max(np.abs(values)))
    factor = factor_to_si(column, "time", path)
    if largest > TO_2100 and not has_unit(column):
        factor, remarks = _epoch(column.name, largest, path)
    times = (values - values[0]).astype(float) * factor
    _check_rising(times, column.name, path)
    return times, remarks


def _numbers(texts: list[str]) -> np.ndarray | None:
    """Return texts as numbers, None if they are none."""
    try:
        return np.array([float(text.replace(",", ".")) if text else np.nan for text in texts])
    except ValueError:
        return None


def _epoch(name: str, largest: float, path: Path) -> tuple[float, list[str]]:
    """Return the unit [s] of a time since 1970 that is too large for seconds, and the remark that says so."""
    for factor, unit in EPOCHS.items():
        if SINCE_2000 <= largest * factor <= TO_2100:
            return factor, [f"{name} is read as {unit} since 1970: in seconds it would be beyond the year 2100"]
    raise ConfigError(
        f"{path}: {name} is {largest:.10g}, neither seconds nor a time since 1970; write 2021-03-04T12:00:00Z, or the "
        "unit in the head: time [ms]"
    )


def _from_stamps(texts: list[str], dates: Column | None, name: str, path: Path) -> np.ndarray:
    """Return the time of each stamp from the first one on [s]."""
    if re.match(r"\d\d?:\d\d", texts[0]):  # a time of day
        days = ["2000-01-01"] * len(texts) if dates is None else [str(day) for day in dates.values]
        texts = [f"{day}T{text.zfill(8) if text[1:2] == ':' else text}" for day, text in zip(days, texts, strict=True)]
    first, seconds = None, []
    for number, text in enumerate(texts, 1):
        try:
            stamp = datetime.datetime.fromisoformat(
                re.sub(r"^(\d{4})/(\d\d)/(\d\d)", r"\1-\2-\3", text.removesuffix(" UTC"))
            )
            first = first or stamp
            seconds.append((stamp - first).total_seconds())
        except (ValueError, TypeError) as error:  # TypeError: one stamp with a zone, the other without
            raise ConfigError(
                f"{path}: {name} of sample {number} is {text[:40]!r}, which is no number and no ISO 8601 time; write "
                "2021-03-04T12:00:00Z, all with a zone or all without"
            ) from error
    return np.array(seconds)


def _check_rising(times: np.ndarray, name: str, path: Path) -> None:
    steps = np.diff(times)
    if np.any(steps <= 0.0):
        at = int(np.argmax(steps <= 0.0)) + 1
        how = "is that of the sample before" if steps[at - 1] == 0.0 else f"is {-steps[at - 1]:g} s before the last"
        raise ConfigError(f"{path}: times must rise; {name} of sample {at + 1} {how}: sort them, one sample a time")
    if len(steps) and np.median(steps) < SHORTEST_STEP:
        raise ConfigError(
            f"{path}: {name} has steps of {np.median(steps):.3g} s, which no anemometer has; write its unit in the "
            "head: time [h]"
        )
