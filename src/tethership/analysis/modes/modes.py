"""Modes of a linear model: named, with frequency, damping, shape and participation.

Depends on: analysis.modes.spectrum, analysis.modes.names, analysis.linear.model.
"""

from typing import NamedTuple

import numpy as np

from tethership.analysis.linear.model import LinearModel
from tethership.analysis.loci.tracking import partners_of
from tethership.analysis.modes.names import assign, mode_name, slots_of, unique
from tethership.analysis.modes.spectrum import NULL, Complex, Spectrum, analyse
from tethership.errors import ConfigError, suggestion


class Mode(NamedTuple):
    """A real eigenvalue or a pair of conjugates.

    Attributes
    ----------
    name : str
        From what takes part in it; e.g. pendulum, or surge–north for two coalesced.
    eigenvalue : complex
        λ [1/s]; of a pair the one with positive imaginary part.
    frequency : float
        Undamped natural frequency |λ| [rad/s].
    damping : float
        −Re λ / |λ| [-]: 1 a real stable mode, −1 a real unstable one, 0 a null mode.
    half_or_double_time : float or None
        ln 2 / |Re λ| [s]; None where the amplitude stays.
    period : float or None
        2π / Im λ [s]; None for a real mode.
    shape : dict[str, complex]
        Eigenvector, comparable units (velocity relative to the air [m/s], rates and angles times half the hull's length
        [m/s, m], position [m]), largest entry 1.
    participation : dict[str, float]
        |share| of each state [-].
    null : bool
        λ is zero to rounding.
    multiplicity : int
        How often λ is an eigenvalue.
    defective : bool
        There are fewer eigenvectors than that: a perturbation grows like t (t², …) besides e^λt.
    places : tuple of int
        Its places among the eigenvalues.
    """

    name: str
    eigenvalue: complex
    frequency: float
    damping: float
    half_or_double_time: float | None
    period: float | None
    shape: dict[str, complex]
    participation: dict[str, float]
    null: bool
    multiplicity: int
    defective: bool
    places: tuple[int, ...]

    @property
    def stable(self) -> bool:
        """Whether its amplitude falls: Re λ < 0 [1/s] beyond rounding. An undamped mode's does not."""
        return self.half_or_double_time is not None and self.eigenvalue.real < 0

    @property
    def oscillates(self) -> bool:
        """Whether it is a pair of conjugates: Im λ [rad/s] is not zero."""
        return self.eigenvalue.imag != 0


class Modes(NamedTuple):
    """All modes of a model, fastest first.

    Attributes
    ----------
    modes : tuple of Mode
        One per real eigenvalue or pair.
    spectrum : Spectrum
        All eigenvalues [1/s], groups and projectors, in comparable coordinates.
    """

    modes: tuple[Mode, ...]
    spectrum: Spectrum

    @property
    def eigenvalues(self) -> Complex:
        """All eigenvalues [1/s], complex."""
        return self.spectrum.eigenvalues

    @property
    def names(self) -> list[str]:
        """Names of the modes."""
        return [mode.name for mode in self.modes]

    def __repr__(self) -> str:
        """Return a line for each mode: its name, eigenvalue and damping."""
        lines = (f"  {mode.name:<22} λ = {mode.eigenvalue:.5f} 1/s, ζ = {mode.damping:+.3f}" for mode in self.modes)
        return "Modes, fastest first:\n" + "\n".join(lines)

    def find(self, name: str) -> Mode:
        """Return the mode of a name, or the coalesced mode that it is part of.

        Raises
        ------
        ConfigError
            There is none; the nearest name is offered.
        """
        plain = name.replace("–", "-")
        exact = [mode for mode in self.modes if mode.name.replace("–", "-") == plain]
        part = [mode for mode in self.modes if plain.removesuffix(" subsidence") in mode.name.split("–")]
        chosen = exact or part
        if not chosen:
            raise ConfigError(
                f"there is no mode {name!r} here{suggestion(name, self.names)} There are: {', '.join(self.names)}"
            )
        return chosen[0]


def find_modes(model: LinearModel) -> Modes:
    """Return the modes of a model.

    Parameters
    ----------
    model : LinearModel
        Whole or reduced, of an open or closed loop.

    Returns
    -------
    Modes
        The fastest first: λ [1/s], |λ| [rad/s], damping [-], times [s], shape and participation [-] of each.

    Notes
    -----
    Eigenvalues that rounding cannot tell apart are one group: they are reported with the group's mean, its
    participation is the diagonal of its spectral projector, and `defective` says whether eigenvectors are missing.
    """
    spectrum = analyse(model.comparable_matrix())
    values, states = spectrum.eigenvalues, model.states
    partner = partners_of(values)
    slots, chosen = slots_of(states), assign(spectrum.participation, states, partner)
    group_of = {place: index for index, group in enumerate(spectrum.groups) for place in group}
    size = max(float(np.abs(values).max(initial=0.0)), 1e-300)
    found: list[Mode] = []
    for place, value in enumerate(values):
        if value.imag < 0:
            continue
        places = (place,) if value.imag == 0 else (place, int(partner[place]))
        share = dict(zip(states, spectrum.participation[:, place].tolist(), strict=True))
        ordered = sorted(chosen[list(places)])
        name = mode_name(slots[ordered[0]], slots[ordered[1]] if len(places) > 1 else None, share)
        group = spectrum.groups[group_of[place]]
        shape = dict(zip(states, spectrum.vectors[:, place].tolist(), strict=True))
        found.append(
            _mode(name, complex(value), places, share, shape, size)._replace(
                multiplicity=len(group), defective=spectrum.blocks[group_of[place]] < len(group)
            )
        )
    names = unique(_split_names(found))
    return Modes(tuple(mode._replace(name=name) for mode, name in zip(found, names, strict=True)), spectrum)


def _mode(
    name: str,
    value: complex,
    places: tuple[int, ...],
    share: dict[str, float],
    shape: dict[str, complex],
    size: float,
) -> Mode:
    """Return a simple mode with the numbers that follow from its eigenvalue [1/s]."""
    null = abs(value) < NULL * size
    steady = null or abs(value.real) < NULL * size
    return Mode(
        name=name,
        eigenvalue=value,
        frequency=abs(value),
        damping=0.0 if null else -value.real / abs(value),
        half_or_double_time=None if steady else float(np.log(2.0) / abs(value.real)),
        period=None if value.imag == 0 else float(2.0 * np.pi / value.imag),
        shape=shape,
        participation=share,
        null=null,
        multiplicity=1,
        defective=False,
        places=places,
    )


def _split_names(modes: list[Mode]) -> list[str]:
    """Return the names; an oscillation broken into two real modes gives '… (fast)' and '… (slow)'."""
    names = [mode.name for mode in modes]
    words = {"pendulum": "pendulum", "roll oscillation": "roll"}
    result = []
    for mode in modes:
        rivals = [other for other in modes if other.name == mode.name and not other.oscillates]
        if mode.oscillates or mode.name not in words:
            result.append(mode.name)
        elif names.count(mode.name) == 1:
            result.append(words[mode.name])
        else:
            fastest = max(rivals, key=lambda other: abs(other.eigenvalue))
            result.append(f"{words[mode.name]} ({'fast' if mode is fastest else 'slow'})")
    return result
