"""Claims L1–L9 of section 3 of the paper, each computed and judged: holds, or does not, with the numbers.

Depends on: studies.docking_paper, analysis. One function per claim; a claim holds only if every part of it does.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

from tethership.analysis.linear import linearize
from tethership.analysis.loci import Sweep, sweep
from tethership.analysis.trim import TrimOutcome, trim
from tethership.errors import ConfigError, suggestion
from tethership.scenario import load_scenario
from tethership.studies.docking_paper.claim import (
    Claim,
    ends,
    falls,
    find_mode,
    followed,
    growth,
    is_real,
    listed,
    pair,
    rises,
    where_met,
)
from tethership.studies.docking_paper.linear_figures import (
    ELONGATIONS,
    Changes,
    bottom_line,
    free_modes,
    heavy_cables,
    light_cables,
)

SLOW = 0.02
"""Rate below which a mode is called slow or mild [1/s]: half a minute and more to half or double."""

LITERATURE_FINS = 6.6
"""S C_Nα η_f per fin of `lotte.toml` [m²/rad]."""

FINS = (5.0, LITERATURE_FINS, 8.0, 10.0, 12.0)
"""Range of S C_Nα η_f per fin over which the claims are looked at [m²/rad]."""

LIFT_PER_EFFICIENCY = 2.88 * 5.73
"""S C_Nα of `lotte.toml` [m²/rad]."""


def fins(lift_area: float) -> dict[str, float]:
    """Return the change that gives every fin S C_Nα η_f [m²/rad], by its efficiency η_f [-]."""
    names = ("fin_starboard", "fin_bottom", "fin_port", "fin_top")
    return {f"vehicle.fins.{name}.efficiency": lift_area / LIFT_PER_EFFICIENCY for name in names}


def claim_1(changes: Changes) -> Claim:
    """L1: the untethered ship of nine states; λ [1/s] of every mode."""
    modes = free_modes(changes, nine_states=True)
    found = {mode.name: mode for mode in modes.modes}
    pitch, yaw = found.get("pitch subsidence"), found.get("yaw subsidence")
    surge, slip = found.get("surge"), found.get("side-slip")
    pendulum, roll, heading = found.get("pendulum"), found.get("roll oscillation"), found.get("heading")
    reals = sorted((abs(m.eigenvalue) for m in modes.modes if not m.oscillates), reverse=True)
    fast = [abs(m.eigenvalue) for m in (pitch, yaw) if m is not None]
    parts = {
        "pitch and yaw subsidence are the fastest real modes, stable": is_real(pitch)
        and is_real(yaw)
        and sorted(fast, reverse=True) == reals[:2]
        and growth(pitch) < 0
        and growth(yaw) < 0,
        "surge is real, stable and slow": is_real(surge) and -0.1 < growth(surge) < 0,
        "side-slip is real and mildly unstable": is_real(slip) and 0 < growth(slip) < 0.25,
        "pendulum oscillates, mildly stable or unstable": pendulum is not None
        and pendulum.oscillates
        and abs(growth(pendulum)) < 0.15,
        "roll oscillates, faster than pendulum, stable": roll is not None
        and pendulum is not None
        and roll.oscillates
        and abs(roll.eigenvalue.imag) > abs(pendulum.eigenvalue.imag)
        and growth(roll) < 0,
        "the directional mode is real, slow and not null": is_real(heading) and not heading.null if heading else False,
    }
    return Claim("L1", "untethered, nine states: the classical spectrum of an airship", parts, {"modes": listed(modes)})


def claim_2(changes: Changes) -> Claim:
    """L2: position adds two null modes and a slow vertical one; λ [1/s], the vertical one's without ∂ρ/∂h too."""
    modes = free_modes(changes)
    north, east, vertical = (find_mode(modes, name) for name in ("north", "east", "vertical"))
    scenario = load_scenario("hover", {**changes, "atmosphere": {"model": "constant", "density": _density()}})
    flat = linearize(scenario, trim(scenario)).modes()
    still = find_mode(flat, "vertical")
    parts = {
        "north and east are null": bool(north and north.null and east and east.null),
        "vertical is real, slow and mildly unstable": is_real(vertical) and 0 < growth(vertical) < SLOW,
        "it is ρ(altitude) that does it: null in air of constant density": bool(still and still.null),
    }
    numbers = {"modes": listed(modes), "vertical at constant density": pair(still.eigenvalue) if still else None}
    return Claim(
        "L2", "twelve states add null north and east and a slow, mildly unstable vertical mode", parts, numbers
    )


def _density() -> dict[str, Any]:
    return {"value": 1.225, "unit": "kg/m^3"}


def _cable_sweep(changes: Changes, scenario: str, cables: str, heavy: bool) -> Sweep:
    values = heavy_cables() if heavy else light_cables()
    names = f"{cables}.diameter", f"{cables}.linear_density"
    return sweep(load_scenario(scenario, changes), dict(zip(names, values, strict=True)))


def claim_3(changes: Changes) -> Claim:
    """L3: one light cable, up to 6 g/m; λ [1/s] at both ends, where modes coalesce [m], the tension [N]."""
    found = _cable_sweep(changes, "docking", "cables.nose", heavy=False)
    surge, north, east, vertical = (followed(found, name) for name in ("surge", "north", "east", "vertical"))
    parts = {
        "surge becomes less stable (while real)": rises(surge[surge.imag == 0].real),
        "north becomes stable": north[-1].real < -1e-3,
        "surge and north stay real up to 6 g/m": where_met(found, "coalesce", "surge", "north") is None,
        "east becomes slowly unstable, real": 0 < east[-1].real < SLOW and east[-1].imag == 0,
        "vertical moves towards stability": falls(vertical.real),
    }
    numbers = {
        **ends(found, "surge", "north", "east", "heading", "vertical"),
        "surge and north coalesce at diameter [m]": where_met(found, "coalesce", "surge", "north"),
        "tension at 6 g/m [N]": float(found.tension[-1, 0]),
    }
    return Claim(
        "L3", "a light cable: surge less stable, north stable, east slowly unstable, vertical stabler", parts, numbers
    )


def claim_4(changes: Changes) -> Claim:
    """L4: one heavier cable, up to 140 g/m; λ [1/s] and damping [-] at both ends, where modes coalesce [m]."""
    light = _cable_sweep(changes, "docking", "cables.nose", heavy=False)
    found = _cable_sweep(changes, "docking", "cables.nose", heavy=True)
    surge = followed(found, "surge")
    damping = -surge.real / np.abs(surge)
    coupled = surge.imag > 0
    heading, east, vertical = (followed(found, name) for name in ("heading", "east", "vertical"))
    parts = {
        "surge and north coalesce to an oscillation": bool(coupled[-1]),
        "it is stable": bool(np.all(surge.real[coupled] < 0)),
        "its damping falls": falls(damping[coupled]),
        "the directional mode is real and ever more stable": bool(np.all(heading.imag == 0))
        and falls(heading.real)
        and heading[-1].real < 0,
        "vertical is ever more stable": falls(vertical.real) and vertical[-1].real < 0,
        "east is real and ever more unstable": bool(np.all(east.imag == 0)) and rises(east.real) and east[-1].real > 0,
    }
    where = where_met(light, "coalesce", "surge", "north") or where_met(found, "coalesce", "surge", "north")
    numbers = {
        **ends(found, "surge", "heading", "east", "vertical"),
        "heading and east with their names exchanged": bool(np.all(heading.imag == 0) and np.all(east.imag == 0))
        and falls(east.real)
        and rises(heading.real),
        "surge and north coalesce at diameter [m]": where,
        "damping of surge–north, first and last": [float(damping[coupled][0]), float(damping[coupled][-1])],
    }
    return Claim(
        "L4", "a heavier cable: surge and north coalesce; heading and vertical stabler, east less", parts, numbers
    )


def claim_5(changes: Changes) -> Claim:
    """L5: two side cables; λ [1/s] at both ends, diameters at which modes coalesce [m]."""
    one = _cable_sweep(changes, "docking", "cables.nose", heavy=False)
    light = _cable_sweep(changes, "side_cables", "cables.*", heavy=False)
    heavy = _cable_sweep(changes, "side_cables", "cables.*", heavy=True)
    single = where_met(one, "coalesce", "surge", "north")
    double = where_met(light, "coalesce", "surge", "north")
    heading, east = followed(light, "heading"), followed(light, "east")
    lateral, aside = followed(heavy, "heading"), followed(heavy, "east")
    coupled = lateral.imag > 0
    damping = -lateral.real / np.abs(lateral)
    vertical = np.concatenate([followed(light, "vertical"), followed(heavy, "vertical")])
    nose = followed(_cable_sweep(changes, "docking", "cables.nose", heavy=True), "vertical")
    parts = {
        "surge and north coalesce at a lighter cable than with one": double is not None
        and (single is None or double < single),
        "light: heading becomes unstable, real": heading[-1].real > 0 and heading[-1].imag == 0,
        "light: east becomes stable, real": east[-1].real < 0 and east[-1].imag == 0,
        "heavier: heading and east coalesce to a stable oscillation": bool(coupled[-1])
        and lateral[-1] == aside[-1]
        and lateral[-1].real < 0,
        "its damping falls": bool(coupled.sum() > 1) and falls(damping[coupled]),
        "vertical moves less than with the nose cable": float(np.ptp(vertical.real))
        < float(np.ptp(np.concatenate([followed(one, "vertical"), nose]).real)),
    }
    numbers = {
        "coalescence of surge and north at diameter [m], one and two cables": [single, double],
        "light: heading and east with their names exchanged": bool(
            heading[-1].imag == 0 and east[-1].imag == 0 and heading[-1].real < 0 < east[-1].real
        ),
        **{f"light {name}": ends for name, ends in ends(light, "heading", "east").items()},
        **{f"heavy {name}": ends for name, ends in ends(heavy, "heading", "east", "vertical").items()},
    }
    return Claim(
        "L5", "two side cables: the opposite of one in heading and east, then a second oscillation", parts, numbers
    )


def claim_6(changes: Changes) -> Claim:
    """L6: the tether point along the bottom line; λ [1/s] at both ends, where modes coalesce, ahead of B [m]."""
    scenario = load_scenario("docking", changes)
    forward, down = bottom_line(scenario)
    found = sweep(scenario, {"cables.nose.tether_point.0": forward, "cables.nose.tether_point.2": down})
    where = where_met(found, "coalesce", "heading", "east")
    heading, pendulum, vertical = (followed(found, name) for name in ("heading", "pendulum", "vertical"))
    aft = forward <= 3.77 + 1e-9
    frequency, damping = np.abs(heading[aft].imag), -heading[aft].real / np.abs(heading[aft])
    parts = {
        "heading and east are real at the nose": bool(heading[0].imag == 0),
        "they coalesce between 5.37 and 3.77 m ahead of B": where is not None and 3.77 <= where <= 5.37,
        "behind, the frequency rises and damping falls": rises(frequency) and falls(damping),
        "and stay stable": bool(np.all(heading[aft].real < 0)),
        "pendulum stays unstable": bool(np.all(pendulum.real > 0)),
        "vertical becomes unstable": bool(vertical[0].real < 0 < vertical[-1].real),
    }
    numbers = {
        **ends(found, "heading", "east", "pendulum", "vertical", "surge"),
        "heading and east coalesce at [m] ahead of B": where,
        "points trimmed": int(found.trimmed.sum()),
        "points": len(found.outcomes),
    }
    return Claim("L6", "tether point from nose to tail: heading and east merge between 5.37 and 3.77 m", parts, numbers)


def claim_7(changes: Changes) -> Claim:
    """L7: wind from 6 to 12 m/s; λ [1/s] and damping [-] at both ends, the wind at which the pendulum splits [m/s]."""
    found = sweep(load_scenario("docking", changes), {"wind.speed": np.linspace(6.0, 12.0, 13)})
    pitch, yaw, pendulum = (followed(found, name) for name in ("pitch subsidence", "yaw subsidence", "pendulum"))
    damping = -pendulum.real / np.abs(pendulum)
    other = found.track("pendulum 2")
    split = where_met(found, "split", "pendulum", "pendulum 2")
    before = found.values["wind.speed"] < (np.inf if split is None else split)
    parts = {
        "pitch subsidence becomes more stable": falls(pitch.real),
        "yaw subsidence becomes more stable": falls(yaw.real),
        "the damping of the pendulum rises": rises(damping[before]),
        "it splits into two real modes": split is not None,
        "one of them is unstable": split is not None and bool(max(pendulum[-1].real, other[-1].real) > 0),
    }
    numbers = {
        **ends(found, "pitch subsidence", "yaw subsidence", "pendulum", "vertical"),
        "damping of the pendulum, first and last": [float(damping[0]), float(damping[-1])],
        "pendulum splits at wind [m/s]": split,
    }
    return Claim("L7", "more wind: pitch and yaw stabler, the pendulum's damping rises until it splits", parts, numbers)


def claim_8(changes: Changes) -> Claim:
    """L8: elongation from 0.5 to 0.95 [-]; λ [1/s], damping [-] and |dλ/de₀| [1/s]."""
    found = sweep(load_scenario("docking", changes), {"trim.elongation": ELONGATIONS})
    value = found.values["trim.elongation"]
    parts: dict[str, bool] = {}
    numbers: dict[str, Any] = dict(ends(found, "pendulum", "surge"))
    for name, label in (("pendulum", "pendulum"), ("surge", "surge–north")):
        track = followed(found, name)
        frequency, damping = np.abs(track.imag), -track.real / np.abs(track)
        slope = np.abs(np.diff(track) / np.diff(value))
        low, high = float(slope[value[1:] <= 0.9].mean()), float(slope[value[1:] > 0.9].mean())
        parts[f"the frequency of {label} rises"] = rises(frequency)
        parts[f"the damping of {label} falls"] = falls(damping)
        parts[f"{label} is more than three times as sensitive above 0.9"] = high > 3.0 * low
        numbers[f"sensitivity of {label} below and above 0.9 [1/s]"] = [low, high]
        numbers[f"damping of {label}, first and last"] = [float(damping[0]), float(damping[-1])]
    return Claim(
        "L8", "more elongation: pendulum and surge–north faster, less damped; sensitive above 0.9", parts, numbers
    )


def claim_9(changes: Changes) -> Claim:
    """L9: no trim beyond an elongation of 0.95 [-]; the largest |throttle| that each asks for [-]."""
    values = (0.95, 0.96, 0.97, 0.98, 0.99, 0.995, 1.0, 1.01, 1.02)
    found = sweep(load_scenario("docking", changes), {"trim.elongation": values})
    largest = np.abs(found.throttle).max(axis=1)
    lacking = [outcome is not TrimOutcome.converged for outcome in found.outcomes]
    first = next((value for value, lack in zip(values, lacking, strict=True) if lack), None)
    parts = {
        "the throttle needed rises": rises(largest),
        "beyond some elongation up to 1 it passes nominal": first is not None and first <= 1.0,
    }
    numbers = {
        "elongation": list(values),
        "largest |throttle|": [float(value) for value in largest],
        "outcome": [outcome.name for outcome in found.outcomes],
        "first elongation without trim": first,
    }
    return Claim("L9", "above e₀ = 0.95 the thrust needed nears or passes nominal: no trim", parts, numbers)


CLAIMS: dict[str, Callable[[Changes], Claim]] = {
    "L1": claim_1,
    "L2": claim_2,
    "L3": claim_3,
    "L4": claim_4,
    "L5": claim_5,
    "L6": claim_6,
    "L7": claim_7,
    "L8": claim_8,
    "L9": claim_9,
}
"""Claims of section 3 by name; each takes changes of the scenario."""


def check_claims(
    formulation: str = "consistent", lift_area: float = LITERATURE_FINS, names: Iterable[str] | None = None
) -> dict[str, Claim]:
    """Return claims L1–L9 for a formulation and fins.

    Parameters
    ----------
    formulation : str
        consistent or published.
    lift_area : float
        S C_Nα η_f of each fin [m²/rad].
    names : iterable of str, optional
        Only these.
    """
    chosen = list(CLAIMS if names is None else names)
    for name in chosen:
        if name not in CLAIMS:
            raise ConfigError(f"there is no claim {name!r}{suggestion(name, CLAIMS)} There are: {', '.join(CLAIMS)}")
    changes: Mapping[str, Any] = {"formulation": formulation, **fins(lift_area)}
    return {name: CLAIMS[name](changes) for name in chosen}
