"""One cable as a dynamic line of MoorDyn 2, in air, with a driven end and a winch.

Depends on: spatial, errors, MoorDyn.

MoorDyn (NREL, C++; optional) lumps the mass of a line at the nodes between its segments, each a spring and a damper
that cannot push. Nothing of it is shared with `physics.cable`. What its input asks for, and how it is met:

- *axes* x north, y west, z up: ground axes turned by half a turn about north.
- *water* is air of density ρ. The anchor lies `DEPTH` below its surface and as far above its bottom, so that nothing
  emerges and nothing touches ground, as for the paper's cable. The density is `WtrDnsty`; `rhoW` is read over.
- *buoyancy* of the rope, ρA, is absent from `CableLoad`. It is added to the mass per length, so that the weight is
  g ρ_t; the inertia then holds the mass of displaced air once (an added-mass coefficient of 1 in every direction,
  0.12 % for the paper's rope), and MoorDyn's own added mass is off.
- *drag* of MoorDyn: ½ρd C_n |v_n| v_n + ½ρπd C_t |v_t| v_t, along the rope on the wetted perimeter πd. Ours:
  ½ρD (C_dc |v_n| v_n + C_dl |v| v). Equal for flow across and along with C_n = C_dc + C_dl, C_t = C_dl/π; between them
  they differ by a fraction of C_dl, 2 % of C_dc.
- *damping* within the rope, BA [N s]: see `rope_damping`.
"""

import contextlib
import ctypes
import math
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from tethership._extras import needs
from tethership.errors import SolveError
from tethership.spatial import STANDARD_GRAVITY

Vector = NDArray[np.float64]

DEPTH = 1000.0
"""Distance from the anchor to the surface and to the bottom of MoorDyn's fluid [m]."""

TURN = np.array([1.0, -1.0, -1.0])
"""Ground axes to MoorDyn's and back [-]."""

STABLE = 2.6
"""|λ| Δt up to which the classical Runge–Kutta step is stable for every damped oscillation [-] (2.78 on the real
axis, 2.83 on the imaginary one, 2.6 between)."""

_INPUT = """--- one cable of a tethered airship ---
written by tethership
--- LINE TYPES ---
TypeName Diam Mass/m EA BA EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
rope {diameter!r} {mass!r} {stiffness!r} {damping!r} 0 {normal_drag!r} 0 {axial_drag!r} 0
--- POINTS ---
Node Type X Y Z M V CdA CA
(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 {anchor!r} 0 0 0 0
2 Coupled {x!r} {y!r} {z!r} 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(-) (-) (-) (-) (m) (-) (-)
1 rope 1 2 {length!r} {segments} -
--- OPTIONS ---
{time_step!r} dtM
rk4 tScheme
{gravity!r} g
{density!r} WtrDnsty
{bottom!r} WtrDpth
1 WaveKin
0.1 dtIC
10 TmaxIC
1 disableOutTime
1 disableOutput
--- END ---
"""


class LineProperties(NamedTuple):
    """A line as MoorDyn takes it.

    Attributes
    ----------
    diameter : float
        d [m].
    mass : float
        Mass per unstretched length, that of the displaced air included, ρ_t + ρA [kg/m].
    stiffness : float
        EA [N].
    damping : float
        BA, force per strain rate [N s].
    normal_drag, axial_drag : float
        C_n on the diameter, C_t on the perimeter [-].
    density : float
        ρ of the air [kg/m³].
    """

    diameter: float
    mass: float
    stiffness: float
    damping: float
    normal_drag: float
    axial_drag: float
    density: float

    @property
    def wave_speed(self) -> float:
        """Speed of axial waves c = √(EA/m) [m/s]."""
        return math.sqrt(self.stiffness / self.mass)

    def stable_time_step(self, segment: float) -> float:
        """Return the longest stable time step [s] for segments of unstretched length l [m].

        Notes
        -----
        The fastest mode of the chain has ω = 2c/l and the damping ratio ζ = BA c/(EA l): its larger eigenvalue is
        ω for ζ < 1, else ω (ζ + √(ζ² − 1)). Both grow as the winch shortens the segments.
        """
        frequency = 2.0 * self.wave_speed / segment
        ratio = self.damping * self.wave_speed / (self.stiffness * segment)
        growth = ratio + math.sqrt(ratio**2 - 1.0) if ratio > 1.0 else 1.0
        return STABLE / (frequency * growth)


def load_moordyn() -> ModuleType:
    """Return the module `moordyn`; raises ConfigError with the cure where it is not installed."""
    with needs("reproduce"):
        import moordyn
    return moordyn


@contextlib.contextmanager
def _quiet(log: Path) -> Iterator[None]:
    """Send what MoorDyn prints, past Python, to a file: standard output belongs to the commands."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = os.dup(1), os.dup(2)
    with log.open("ab") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            for saved, number in zip(kept, (1, 2), strict=True):
                os.dup2(saved, number)
                os.close(saved)


def _keep_none() -> None:
    """Give back the reference to None that each setter of MoorDyn's Python module takes.

    Notes
    -----
    Up to Python 3.11 they run out after some thousand calls and the interpreter aborts (MoorDyn 2.7.2); one too many
    does no harm, and from 3.12 on None is not counted.
    """
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(None))


class MoorDynLine:
    """A line from the origin to a driven end; use it in a `with`, which frees it.

    Parameters
    ----------
    properties : LineProperties
        The rope.
    end : Float[Array, "3"]
        Driven end from the anchor, ground axes [m].
    length : float
        Unstretched length [m].
    segments : int
        Number of equal segments.
    time_step : float
        Of MoorDyn's integration [s].

    Raises
    ------
    ConfigError
        MoorDyn is not installed.
    SolveError
        MoorDyn refuses the line or does not know an option.
    """

    def __init__(self, properties: LineProperties, end: Vector, length: float, segments: int, time_step: float) -> None:
        self._moordyn = load_moordyn()
        self._folder = tempfile.TemporaryDirectory(prefix="tethership-moordyn-")
        self._log = Path(self._folder.name) / "printed.txt"
        self.time = 0.0
        self._begin(properties, end, length, segments, time_step)
        self._line = self._moordyn.GetLine(self._system, 1)
        self._nodes = len(self._moordyn.ExternalWaveKinGetCoordinates(self._system))
        self._segments = segments
        self.wind(np.zeros(3))

    def _begin(self, properties: LineProperties, end: Vector, length: float, segments: int, time_step: float) -> None:
        """Write the input, read it in and let the line hang in still air."""
        x, y, z = (float(value) for value in self._point(end))
        given = {"x": x, "y": y, "z": z, "length": length, "time_step": time_step, "anchor": -DEPTH}
        numbers = {name: float(value) for name, value in given.items()}  # a numpy number is written as np.float64(…)
        constants = {"segments": segments, "gravity": STANDARD_GRAVITY, "bottom": 2.0 * DEPTH}
        path = Path(self._folder.name) / "line.txt"
        path.write_text(_INPUT.format(**numbers, **constants, **properties._asdict()), encoding="utf-8")
        try:
            with _quiet(self._log):
                self._system = self._moordyn.Create(str(path))
                self._moordyn.SetVerbosity(self._system, self._moordyn.LEVEL_NONE)
                self._moordyn.Init(self._system, [x, y, z], [0.0, 0.0, 0.0])
                self._moordyn.ExternalWaveKinInit(self._system)
        except RuntimeError as error:
            raise SolveError(f"MoorDyn refuses the line: {error}") from error
        if "Unrecognized option" in self._log.read_text(errors="replace"):
            raise SolveError("MoorDyn does not know an option of its input and would take its own value instead")

    def __enter__(self) -> Self:
        """Return the line."""
        return self

    def __exit__(self, *error: object) -> None:
        """Free the line and remove its files."""
        self._moordyn.Close(self._system)
        self._folder.cleanup()

    @staticmethod
    def _point(end: Vector) -> Vector:
        return end * TURN + np.array([0.0, 0.0, -DEPTH])

    def wind(self, velocity: Vector) -> None:
        """Set the velocity of the air everywhere [m/s], ground axes."""
        value = (velocity * TURN).tolist()
        still = [0.0, 0.0, 0.0]
        self._moordyn.ExternalWaveKinSet(self._system, [value] * self._nodes, [still] * self._nodes, self.time)

    def rewind(self, rate: float) -> None:
        """Set the rate at which the unstretched length shrinks Ψ [m/s], evenly over the segments."""
        self._moordyn.SetLineUnstretchedLengthVel(self._line, -rate)
        _keep_none()

    def time_step(self, value: float) -> None:
        """Set the time step of MoorDyn's integration [s]."""
        self._moordyn.SetDt(self._system, value)
        _keep_none()

    def step(self, start: Vector, end: Vector, duration: float) -> Vector:
        """Move the end along a straight line; return the force of the line on the ship [N], ground axes.

        Parameters
        ----------
        start, end : Float[Array, "3"]
            Of the driven end, from the anchor, ground axes [m].
        duration : float
            [s].

        Raises
        ------
        SolveError
            MoorDyn could not integrate: it met a number that is not finite.
        """
        velocity = ((end - start) / duration * TURN).tolist()
        try:
            force = self._moordyn.Step(self._system, self._point(start).tolist(), velocity, self.time, duration)
        except RuntimeError as error:
            raise SolveError(f"MoorDyn stopped at {self.time:.3f} s of the line's time: {error}") from error
        self.time += duration
        return np.asarray(force) * TURN

    @property
    def length(self) -> float:
        """Unstretched length [m], as MoorDyn has it."""
        return float(self._moordyn.GetLineUnstretchedLength(self._line))

    @property
    def weight(self) -> float:
        """Weight of all nodes less the buoyancy [N], as MoorDyn has it."""
        nodes = range(self._segments + 1)
        return -sum(self._moordyn.GetLineNodeWeight(self._line, node)[2] for node in nodes)

    @property
    def anchor_force(self) -> Vector:
        """Force of the line on the anchor [N], ground axes."""
        return np.asarray(self._moordyn.GetLineNodeForce(self._line, 0)) * TURN

    def nodes(self) -> Vector:
        """Return the nodes from the anchor, ground axes [m], shape (segments + 1, 3)."""
        places = [self._moordyn.GetLineNodePos(self._line, node) for node in range(self._segments + 1)]
        return (np.asarray(places) - np.array([0.0, 0.0, -DEPTH])) * TURN
