"""Numbers that were measured, those that were not, and gaps between them. Depends on: errors."""

from pathlib import Path

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import MOST_SAMPLES, Column
from tethership.scenario.wind_record.names import factor_to_si

FASTEST = 90.0
"""Largest speed that is believed [m/s]: no airship meets 324 km/h."""

BOUNDS = {"speed": (0.0, FASTEST), "direction": (-2.0 * np.pi, 4.0 * np.pi), "toward": (-2.0 * np.pi, 4.0 * np.pi)}
"""Least and largest value that can be [m/s, rad]; those of components are ± the largest speed."""

MISSING = {"", "na", "n/a", "nan", "null", "none", "m", "vrb", "\\n", "-", "--", "---", "/", "//", "///", "*", "***"}
"""What stands in a cell that holds no number."""

LONGEST_GAP, LONGEST_STEPS = 5.0, 10.0
"""A gap up to so many seconds, or usual steps, is bridged: beyond, gusts that were there would be left out."""

LEAST_SAMPLES = 4
"""As many as the record's schema asks for."""

GUSTLESS = 60.0
"""Usual step beyond which a record holds no gust of a docking [s]."""


def read_numbers(column: Column, role: str, path: Path) -> np.ndarray:
    """Return a column of speeds [m/s] or directions [rad], shape (n,), NaN where nothing was measured.

    Parameters
    ----------
    column : Column
        In its own unit.
    role : str
        Its quantity, a key of `names.NAMES`.
    path : Path
        For messages.

    Notes
    -----
    A number that cannot be and is all nines (−999, 99.99, 9999) or a fill value of netCDF or of 16 bits stands for a
    missing one; another number that cannot be is refused, because it may tell of a wrong unit.

    Raises
    ------
    ConfigError
        A cell is no number, a number cannot be, or the unit is none.
    """
    raw = as_numbers(column, path)
    values = raw * factor_to_si(column, role, path)
    low, high = BOUNDS.get(role, (-FASTEST, FASTEST))
    for at in np.flatnonzero(~((values >= low) & (values <= high)) & ~np.isnan(values)):
        if not _stands_for_missing(float(raw[at])):
            unit = "rad" if role in ("direction", "toward") else "m/s"
            raise ConfigError(
                f"{path}: {column.name} of sample {at + 1} is {raw[at]:g}, which is {values[at]:.4g} {unit} and cannot "
                f"be ({low:.4g} to {high:.4g} {unit}); leave it empty if it was not measured, or mend the unit"
            )
        values[at] = np.nan
    return values


def as_numbers(column: Column, path: Path) -> np.ndarray:
    """Return a column as numbers in its own unit, NaN where a cell holds none; ConfigError where it holds text."""
    if column.values.dtype.kind not in "OSU":
        return np.asarray(column.values, float)
    numbers = np.full(len(column.values), np.nan)
    for at, text in enumerate(column.values):
        if str(text).strip().lower() in MISSING:
            continue
        try:
            numbers[at] = float(str(text).replace(",", "."))  # a decimal comma
        except ValueError as error:
            raise ConfigError(
                f"{path}: {column.name} of sample {at + 1} is {str(text)[:40]!r}, not a number; leave it empty if it "
                "was not measured"
            ) from error
    return numbers


def _stands_for_missing(number: float) -> bool:
    """Return whether a number that cannot be is one that loggers and models write for none."""
    nines = set(f"{abs(number):g}".replace(".", "")) == {"9"}
    return (nines and abs(number) >= 99.0) or abs(number) > 1e15 or number in (-32768.0, -32767.0, 32767.0)


def without_gaps(times: np.ndarray, velocities: np.ndarray, path: Path) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Return the samples that were measured, their times from the first one on, and what is to be said of the others.

    Parameters
    ----------
    times : np.ndarray
        Rising [s], shape (n,).
    velocities : np.ndarray
        NaN where nothing was measured [m/s], shape (n, 3).
    path : Path
        For messages.

    Raises
    ------
    ConfigError
        Too few or too many samples, or a gap too long to be bridged.
    """
    kept = np.all(np.isfinite(velocities), axis=1)
    count, lost = int(np.sum(kept)), int(np.sum(~kept))
    if not LEAST_SAMPLES <= count <= MOST_SAMPLES:
        raise ConfigError(
            f"{path} has {count} samples{f' beside {lost} that are missing' if lost else ''}; a record has at least "
            f"{LEAST_SAMPLES} and at most {MOST_SAMPLES}: give the time to be flown"
        )
    usual, steps = float(np.median(np.diff(times))), np.diff(times[kept])
    longest = max(LONGEST_GAP, LONGEST_STEPS * usual)
    at, numbers = int(np.argmax(steps)), np.flatnonzero(kept) + 1
    if steps[at] > longest:
        raise ConfigError(
            f"{path}: nothing was measured for {steps[at]:g} s after sample {numbers[at]} ({times[kept][at]:g} s from "
            f"the first); where a step is {usual:g} s up to {longest:g} s are bridged: cut the record there, or fill it"
        )
    remarks = []
    if lost:
        remarks.append(
            f"{np.sum(~kept)} of {len(kept)} samples are missing, sample {int(np.argmin(kept)) + 1} the first"
        )
    if steps[at] > 1.5 * usual:
        gaps = int(np.sum(steps > 1.5 * usual))
        many = "" if gaps == 1 else "s"
        remarks.append(f"{gaps} gap{many} of up to {steps[at]:g} s bridged; a usual step is {usual:g} s")
    if usual > GUSTLESS:
        remarks.append(f"a sample every {usual:g} s holds no gusts; add turbulence or gusts to fly in them")
    return times[kept] - times[kept][0], velocities[kept], remarks
