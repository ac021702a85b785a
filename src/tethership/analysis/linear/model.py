"""The linear model of a ship about a point: labelled matrices, reduced models, python-control, files.

Depends on: results, numpy; python-control when asked for.
"""

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg

from tethership._extras import needs
from tethership._version import __version__
from tethership.errors import ConfigError, suggestion
from tethership.plant import LENGTH, WIND_INPUTS
from tethership.results import FORMAT, LINEAR_MODEL

if TYPE_CHECKING:
    import control
    import xarray as xr

    from tethership.analysis.modes.modes import Modes

SHAPES = {
    "A": ("state", "of_state"),
    "U": ("state", "input"),
    "comparable": ("state", "of_state"),
    "state_value": ("state",),
    "input_value": ("input",),
}
"""Numbers of a file and their dimensions."""

WORDS = ("state_unit", "input_unit")
"""Words of such a file besides the names of its dimensions."""

MEASURED_SHAPES = {"C": ("output", "of_state"), "D": ("output", "input"), "output_value": ("output",)}
"""Numbers that files of version 0.1 lack."""

MEASURED = (*MEASURED_SHAPES, "output_unit", "input_is_control")
"""All that files of version 0.1 lack."""

UNCONTROLLED = (*WIND_INPUTS, LENGTH)
"""How the names of inputs begin that nobody commands: the wind, and a cable's length unless its winch is an input."""

LONGITUDINAL = ("u", "w", "q", "theta", "north", "down")
LATERAL = ("v", "p", "r", "phi", "psi", "east")
POSITION = ("north", "east", "down")


@dataclasses.dataclass(frozen=True, eq=False)
class LinearModel:
    """Δṡ = A Δs + U Δδ, Δy = C Δs + D Δδ about a point; with a sampled law Δs⁺ = A Δs + U Δδ over its period.

    Attributes
    ----------
    A : ndarray
        State matrix [state unit per second per state unit], shape (n, n); of a discrete model [state unit per state
        unit].
    U : ndarray
        Input matrix [state unit per second per input unit], shape (n, inputs); of a discrete model [state unit per
        input unit].
    states, inputs : tuple of str
        Names in the order of the matrices.
    state_units, input_units : tuple of str
        Their SI units, as text; "1" for a throttle.
    state_values, input_values : ndarray
        Where the model holds, in these units, shapes (n,) and (inputs,).
    comparable : ndarray
        Matrix to comparable coordinates, shape (n, n): velocity relative to the air, rates and angles times half the
        hull's length [m], so that every entry is in m/s or m at the hull's end.
    attributes : dict
        Formulation, outcome of the trim, the scenario as read.
    controls : tuple of str
        Those inputs that a law commands: throttles, deflections, rewind rates. The others are `disturbances`.
    outputs, output_units : tuple of str
        Names and SI units of what is measured besides the states: `tension_…` of each cable at the ship, `airspeed`,
        `angle_of_attack`, `sideslip` (these three only with airspeed), `rate_of_climb`, `clearance`.
    output_values : ndarray
        y₀, in the outputs' units, shape (outputs,).
    C, D : ndarray
        Output matrices [output unit per state unit] and [output unit per input unit], shapes (outputs, n) and (outputs,
        inputs).
    """

    A: np.ndarray
    U: np.ndarray
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    state_values: np.ndarray
    input_values: np.ndarray
    comparable: np.ndarray
    attributes: dict[str, Any]
    controls: tuple[str, ...] = ()
    outputs: tuple[str, ...] = ()
    output_units: tuple[str, ...] = ()
    output_values: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    C: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((0, 0)))
    D: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((0, 0)))

    def __post_init__(self) -> None:
        if not self.outputs:  # so that a model made by hand needs no empty matrices
            object.__setattr__(self, "C", np.zeros((0, len(self.states))))
            object.__setattr__(self, "D", np.zeros((0, len(self.inputs))))

    @property
    def disturbances(self) -> tuple[str, ...]:
        """Inputs that nobody commands: the wind's change [m/s] and rate [m/s²], lengths [m] of cables without winch."""
        return tuple(name for name in self.inputs if name not in self.controls)

    def modes(self) -> "Modes":
        """Return the modes: eigenvalues [1/s], names, participation [-] (see `modes.find_modes`)."""
        from tethership.analysis.modes.modes import find_modes

        return find_modes(self)

    def select(self, states: Sequence[str] | None = None, inputs: Sequence[str] | None = None) -> "LinearModel":
        """Return the model of some states and inputs, the others being held where they are.

        Raises
        ------
        ConfigError
            A name is not in the model.
        """
        rows = _places(self.states if states is None else states, self.states, "state")
        columns = _places(self.inputs if inputs is None else inputs, self.inputs, "input")
        return LinearModel(
            self.A[np.ix_(rows, rows)],
            self.U[np.ix_(rows, columns)],
            tuple(self.states[i] for i in rows),
            tuple(self.inputs[i] for i in columns),
            tuple(self.state_units[i] for i in rows),
            tuple(self.input_units[i] for i in columns),
            self.state_values[rows],
            self.input_values[columns],
            self.comparable[np.ix_(rows, rows)],
            self.attributes,
            tuple(self.inputs[i] for i in columns if self.inputs[i] in self.controls),
            self.outputs,
            self.output_units,
            self.output_values,
            self.C[:, rows],
            self.D[:, columns],
        )

    def without_position(self) -> "LinearModel":
        """Return the model of nine states usual for free airships: north, east and down [m] are held."""
        return self.select([name for name in self.states if name not in POSITION])

    def longitudinal(self) -> "LinearModel":
        """Return the model of u, w [m/s], q [rad/s], θ [rad], north, down and cable lengths [m], those that are there.

        Raises
        ------
        ConfigError
            They are coupled with the lateral states (`coupling` above 1e-6), so that this would be another ship.
        """
        return self._part((*LONGITUDINAL, *(name for name in self.states if name.startswith(LENGTH))))

    def lateral(self) -> "LinearModel":
        """Return the model of v [m/s], p, r [rad/s], φ, ψ [rad], east [m], those there are; raises likewise."""
        return self._part(LATERAL)

    def coupling(self, states: Sequence[str]) -> float:
        """Return how strongly some states are coupled with the others [-].

        Notes
        -----
        The largest entry of A between them over its largest at all, in comparable coordinates.
        """
        inside = np.isin(self.states, list(states))
        matrix = self.comparable_matrix()
        between = max(
            np.abs(matrix[inside][:, ~inside]).max(initial=0.0), np.abs(matrix[~inside][:, inside]).max(initial=0.0)
        )
        return float(between / max(np.abs(matrix).max(), 1e-300))

    @property
    def sample_time(self) -> float:
        """Period of a discrete model [s]; 0 for a continuous one."""
        return float(self.attributes.get("sample_time", 0.0))

    def comparable_matrix(self) -> np.ndarray:
        """Return A in comparable coordinates [1/s]; of a discrete model the continuous one that agrees at its ticks."""
        matrix = equivalent(self.A, self.sample_time) if self.sample_time else self.A
        return self.comparable @ matrix @ np.linalg.inv(self.comparable)

    def _part(self, names: Sequence[str]) -> "LinearModel":
        """Return the model of the named states that are there.

        Raises
        ------
        ConfigError
            They are coupled with the others, so that this would be another ship.
        """
        kept = [name for name in self.states if name in names]
        strength = self.coupling(kept)
        if strength > 1e-6:
            raise ConfigError(
                f"the point is not symmetric: {', '.join(kept)} are coupled with the other states ({strength:.1e} of "
                "the largest entry of A); use the whole model, or select() if the coupling may be neglected"
            )
        return self.select(kept)

    def to_control(
        self, inputs: Sequence[str] | None = None, outputs: Sequence[str] | None = None
    ) -> "control.StateSpace":
        """Return a python-control StateSpace with named states, inputs and outputs.

        Parameters
        ----------
        inputs : sequence of str, optional
            The `controls` if left out, so that control.lqr(plant, Q, R) is a law; or `disturbances`.
        outputs : sequence of str, optional
            Names of states and of `outputs`; all states if left out.

        Raises
        ------
        ConfigError
            A name is not in the model, there is no input, or python-control is not installed.

        Notes
        -----
        Every signal keeps its SI unit, throttles theirs [-]; a discrete model's `dt` is its `sample_time` [s].
        """
        with needs("control"):
            import control

        chosen = self.select(inputs=self.controls if inputs is None else inputs)
        if not chosen.inputs:
            raise ConfigError(
                f"to_control: there is no input to choose; name some of {', '.join(self.inputs) or 'none'}"
            )
        known = (*self.states, *self.outputs)
        rows = _places(self.states if outputs is None else outputs, known, "output")
        return control.StateSpace(
            chosen.A,
            chosen.U,
            np.vstack([np.eye(len(self.states)), chosen.C])[rows],
            np.vstack([np.zeros(chosen.U.shape), chosen.D])[rows],
            states=list(chosen.states),
            inputs=list(chosen.inputs),
            outputs=[known[i] for i in rows],
            name="airship",
            **({"dt": self.sample_time} if self.sample_time else {}),
        )

    def to_dataset(self) -> "xr.Dataset":
        """Return the model as a labelled dataset."""
        import xarray as xr

        other = list(self.states)
        variables = {
            "A": (("state", "of_state"), self.A, {"long_name": "state matrix"}),
            "U": (("state", "input"), self.U, {"long_name": "input matrix"}),
            "comparable": (("state", "of_state"), self.comparable, {"long_name": "to comparable coordinates"}),
            "state_value": (("state",), self.state_values, {"long_name": "state at the point"}),
            "input_value": (("input",), self.input_values, {"long_name": "input at the point"}),
            "input_is_control": (
                ("input",),
                np.isin(self.inputs, self.controls).astype("int8"),
                {"long_name": "commanded"},
            ),
            "C": (("output", "of_state"), self.C, {"long_name": "output matrix"}),
            "D": (("output", "input"), self.D, {"long_name": "direct matrix"}),
            "output_value": (("output",), self.output_values, {"long_name": "output at the point"}),
        }
        coordinates = {
            "state": other,
            "of_state": other,
            "input": list(self.inputs),
            "output": list(self.outputs),
            "output_unit": ("output", list(self.output_units)),
            "state_unit": ("state", list(self.state_units)),
            "input_unit": ("input", list(self.input_units)),
        }
        header = {"kind": LINEAR_MODEL.name, "format": FORMAT, "tethership_version": __version__}
        return xr.Dataset(variables, coordinates, header | {"attributes": json.dumps(self.attributes, sort_keys=True)})

    @property
    def run(self) -> str:
        """Id of this model in its file and pictures: a digest of its numbers and input."""
        from tethership.results import run_id

        return run_id(self.to_dataset(), LINEAR_MODEL.own)

    def content(self) -> bytes:
        """Return the bytes of the model's netCDF file."""
        from tethership.results import netcdf

        return netcdf.content(self.to_dataset(), LINEAR_MODEL)

    def save(self, path: str | Path) -> None:
        """Write the model to netCDF; raises ConfigError where that cannot be."""
        from tethership.results import netcdf

        netcdf.write(self.to_dataset(), Path(path), LINEAR_MODEL)

    @classmethod
    def load(cls, path: str | Path) -> "LinearModel":
        """Return the model of a file; raises ConfigError where it is none."""
        from tethership.results import netcdf

        data = netcdf.read(Path(path), LINEAR_MODEL)
        old = not set(map(str, data.variables)) & set(MEASURED)
        attributes = _checked(data, str(path), SHAPES if old else SHAPES | MEASURED_SHAPES)
        inputs = tuple(map(str, data["input"].values))
        measured: tuple[Any, ...]
        if old:
            measured = (tuple(name for name in inputs if not name.startswith(UNCONTROLLED)),)
        else:
            measured = (
                tuple(name for name, is_so in zip(inputs, data["input_is_control"].values, strict=True) if is_so),
                tuple(map(str, data["output"].values)),
                tuple(map(str, data["output_unit"].values)),
                data["output_value"].values,
                data["C"].values,
                data["D"].values,
            )
        return cls(
            data["A"].values,
            data["U"].values,
            tuple(map(str, data["state"].values)),
            inputs,
            tuple(map(str, data["state_unit"].values)),
            tuple(map(str, data["input_unit"].values)),
            data["state_value"].values,
            data["input_value"].values,
            data["comparable"].values,
            attributes,
            *measured,
        )


def _checked(data: "xr.Dataset", origin: str, shapes: dict[str, tuple[str, ...]]) -> dict[str, Any]:
    """Return the attributes of a file's dataset, or raise ConfigError where it is no linear model of these shapes."""
    wanted = {*shapes, *WORDS, *(MEASURED if "C" in shapes else ())}
    missing = wanted - set(map(str, data.variables))
    if missing:
        raise ConfigError(f"{origin} is no whole linear model: {', '.join(sorted(missing))} is missing")
    for name, dims in shapes.items():
        variable = data.variables[name]
        if variable.dims != dims or variable.dtype.kind != "f" or not np.isfinite(variable.values).all():
            raise ConfigError(f"{origin} is no linear model: {name} is not finite numbers over {', '.join(dims)}")
    if list(data["state"].values) != list(data["of_state"].values):
        raise ConfigError(f"{origin} is no linear model: rows and columns of A have not the same states")
    try:
        attributes = json.loads(str(data.attrs["attributes"]))
    except (KeyError, ValueError, RecursionError) as error:
        raise ConfigError(f"{origin} is no linear model: its attributes are not readable") from error
    if not isinstance(attributes, dict):
        raise ConfigError(f"{origin} is no linear model: its attributes are no table")
    return attributes


def _places(chosen: Sequence[str], known: Sequence[str], what: str) -> list[int]:
    """Return the places of names, or raise ConfigError that offers the nearest, or for none or the same twice."""
    if what == "state" and not chosen:
        raise ConfigError("select: no state is left; name at least one")
    if len(set(chosen)) != len(chosen):
        raise ConfigError(f"select: a {what} is named twice in {', '.join(chosen)}; name each once")
    for name in chosen:
        if name not in known:
            raise ConfigError(f"the model has no {what} {name!r}{suggestion(name, known)} It has: {', '.join(known)}")
    return [list(known).index(name) for name in chosen]


def equivalent(matrix: np.ndarray, period: float) -> np.ndarray:
    """Return ln(Φ)/T of a discrete matrix [1/s]: its eigenvalues are those of the modes.

    Notes
    -----
    An eigenvalue z that is negative and real alternates at every tick; the rate of its decay is kept, ln|z|/T. One that
    is zero (gone within a period) is taken as 1e-12.
    """
    found: Any = np.linalg.eig(matrix)
    values: Any = np.asarray(found[0], dtype=complex)
    vectors: Any = np.asarray(found[1], dtype=complex)
    alternating = (np.abs(values.imag) < 1e-12 * np.abs(values)) & (values.real < 0)
    if not alternating.any() and np.abs(values).min(initial=1.0) > 1e-12:
        return np.real(np.asarray(scipy.linalg.logm(matrix))) / period
    plain = np.where(np.abs(values) > 1e-12, np.where(alternating, np.abs(values), values), 1e-12)
    return np.real(vectors @ np.diag(np.log(plain)) @ np.linalg.inv(vectors)) / period
