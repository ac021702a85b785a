"""Claims D5–D11 of section 4 of the paper, and all of D1–D11 judged: holds, or does not, with the numbers.

Depends on: studies.docking_paper. One function per claim; a claim holds only if every part of it does. A part that
looks at a flight that did not dock does not hold, and the numbers tell the outcome.
"""

import math

import numpy as np

from tethership.simulation import Flight
from tethership.studies.docking_paper.claim import Claim
from tethership.studies.docking_paper.fit.targets import TABLES
from tethership.studies.docking_paper.flights_read import (
    KEYS,
    WINDS,
    Flights,
    Peak,
    holds,
    metric,
    name_of,
    peaks,
    read,
    tell,
    throw,
)
from tethership.studies.docking_paper.table_claims import TEAR_FORCE, Verdicts, claim_1, claim_2, claim_3, claim_4

REWIND_RATE = 0.3
"""Default rewind rate Ψ̄, Table A.2 [m/s]."""

RATE_TOLERANCE = 1e-6
"""Below Ψ̄ by more than this, the winch was slowed [m/s]: rounding only."""

SHORTEST_TIME = (20.0 - 1.5) / REWIND_RATE
"""Time to rewind 20 m of cable to 1.5 m at Ψ̄ [s]: 61.67."""

TIME_TOLERANCE = 0.005
"""Half the last digit of the printed docking times [s]."""

GROUND_CHANGES = {6.0: 0.01, 9.0: 0.01, 12.0: 0.08}
"""Largest change of the peak tension by ground effect, by wind [-], section 4.1."""

FAR = 0.5 * 16.0 * math.cos(math.pi / 4)
"""How far sideways is far [m]: 5.66, half the horizontal distance from anchor to tether point at trim.

It takes B, which hangs 7 m behind the tether point, out of the wind's plane by 18° as seen from the anchor, and by
1.4 diameters of the hull.
"""

MOST = 0.5
"""Share of the throw by the initial attitude of which heading control leaves less [-]: it takes the greater part."""

LAST = 2.0 / 3.0
"""Share of the manoeuvre after which a peak is near its end [-]."""


def claim_5(flights: Flights) -> Claim:
    """D5: where peaks of tension come from; of the others time [s], tension [N], elongation [-]."""
    found = read(flights, peaks)
    parts = {}
    for table in TABLES:
        keys = [(table, wind) for wind in WINDS]
        parts[f"{table}: the highest peak of each flight comes as e rises to 1 from a sagging cable"] = holds(
            found, keys, lambda *all_peaks: all(_highest(some).from_sagging for some in all_peaks if some)
        )
        parts[f"{table}: every peak above 144.3 N does"] = holds(
            found, keys, lambda *all_peaks: all(peak.from_sagging for some in all_peaks for peak in some)
        )
    parts["there are peaks to look at"] = any(found.values())
    counted = {key: [sum(peak.from_sagging for peak in some), len(some)] for key, some in found.items()}
    others = {key: [_told(peak) for peak in some if not peak.from_sagging] for key, some in found.items()}
    numbers = {
        "peaks from a sagging cable, of all": tell(flights, counted),
        "all together": [sum(count[i] for count in counted.values()) for i in (0, 1)],
        "others: time [s], tension [N], e, lowest e before": tell(flights, others),
    }
    return Claim("D5", "tension peaks where elongation comes up to 1 from a sagging cable", parts, numbers)


def _highest(some: list[Peak]) -> Peak:
    return max(some, key=lambda peak: peak.tension)


def _told(peak: Peak) -> list[float | None]:
    return [peak.time, peak.tension, peak.elongation, peak.lowest]


def claim_6(flights: Flights) -> Claim:
    """D6: each layer lowers the peak [N]."""
    peak = read(flights, metric("tension_max"))
    parts = {
        f"navigation < heading < rewind at {wind:g} m/s": holds(
            peak, [(table, wind) for table in TABLES], lambda rewind, heading, navigation: navigation < heading < rewind
        )
        for wind in WINDS
    }
    return Claim("D6", "each layer lowers the peak tension", parts, {"peak tension [N]": tell(flights, peak)})


def claim_7(flights: Flights, grounded: Flights) -> Claim:
    """D7: ground effect; the paper speaks of it for rewind control (section 4.1), so that is what is judged.

    Numbers are the change of the peak [-], the peaks without and with it [N] and the largest vertical wind [m/s].
    """
    without, felt = read(flights, metric("tension_max")), read(grounded, metric("tension_max"))
    change = {key: felt[key] / without[key] - 1.0 for key in KEYS if key in felt and key in without}
    lift = read(grounded, _vertical_wind)
    parts = {}
    for wind, largest in GROUND_CHANGES.items():
        key = ("rewind", wind)
        parts[f"there is a ground effect at {wind:g} m/s"] = holds(lift, [key], lambda speed: speed > 0)
        parts[f"it changes the peak tension with rewind control by less than {largest:.0%} at {wind:g} m/s"] = holds(
            change, [key], lambda value, largest=largest: abs(value) < largest
        )
    numbers = {
        "change of peak tension": {name_of(key): change.get(key) for key in KEYS},
        "peak tension without [N]": tell(flights, without),
        "peak tension with [N]": tell(grounded, felt),
        "largest vertical wind [m/s]": tell(grounded, lift),
    }
    return Claim("D7", "ground effect moves the peak by less than 1 % at 6 and 9 m/s, 8 % at 12 m/s", parts, numbers)


def _vertical_wind(flight: Flight) -> float:
    """Return the largest vertical wind of a flight [m/s]; section 4 has none but ground effect."""
    return float(np.abs(flight.data["wind"].sel(ground_axis="down").to_numpy()).max())


def claim_8(flights: Flights) -> Claim:
    """D8: no throttle saturates; for how long one is clipped [s]."""
    seconds = read(flights, metric("saturated_seconds"))
    parts = {
        f"no throttle saturates with {table} at {wind:g} m/s": holds(
            seconds, [(table, wind)], lambda value: value == 0.0
        )
        for table, wind in KEYS
    }
    return Claim("D8", "no throttle saturates", parts, {"seconds with a throttle clipped [s]": tell(flights, seconds)})


def _slowest(flight: Flight) -> float:
    return float(flight.metrics["rewind_rate_min"])


def _never_slowed(rate: float) -> bool:
    return rate >= REWIND_RATE - RATE_TOLERANCE


def claim_9(flights: Flights) -> Claim:
    """D9: what navigation reaches: slowest rewind rate Ψ [m/s], peak tension [N]."""
    keys = [("navigation", wind) for wind in WINDS]
    slowest, peak = read(flights, _slowest, keys), read(flights, metric("tension_max"), keys)
    parts = {f"Ψ is never reduced at {key[1]:g} m/s": holds(slowest, [key], _never_slowed) for key in keys[:2]}
    parts["tension stays below the tear force at 12 m/s"] = holds(peak, keys[2:], lambda force: force < TEAR_FORCE)
    numbers = {
        "slowest rewind rate [m/s]": tell(flights, slowest, keys),
        "peak tension [N]": tell(flights, peak, keys),
    }
    return Claim("D9", "navigation: the winch is not slowed at 6 and 9 m/s, no tear at 12 m/s", parts, numbers)


def claim_10(flights: Flights) -> Claim:
    """D10: thrown sideways [m]; the paper speaks of Figs. 12 and 13, at 12 m/s.

    Numbers are ways sideways [m], and when peaks come as shares of the manoeuvre [-].
    """
    thrown = read(flights, throw)
    share = read(flights, _peak_shares)
    rewind, heading = ("rewind", 12.0), ("heading", 12.0)
    parts = {
        "rewind: thrown far sideways": holds(thrown, [rewind], lambda mine: mine.by_attitude > FAR),
        "rewind: more by the initial attitude than by the gust": holds(
            thrown, [rewind], lambda mine: mine.by_attitude > mine.by_gust
        ),
        "heading takes most of that away": holds(
            thrown, [heading, rewind], lambda mine, other: mine.by_attitude < MOST * other.by_attitude
        ),
        "heading: its highest peak comes in the last third": holds(
            share, [heading], lambda shares: bool(shares) and shares[0] > LAST
        ),
        "heading: more peaks in the last third than in either third before": holds(
            share, [heading], lambda shares: _in_thirds(shares)[2] > max(_in_thirds(shares)[:2])
        ),
    }
    counts = {key: _in_thirds(shares) for key, shares in share.items()}
    numbers = {
        "largest |east| before the gust, drift with it, largest |east| [m]": tell(
            flights, {key: list(value) for key, value in thrown.items()}
        ),
        "highest peak at share of the manoeuvre": tell(
            flights, {key: shares[0] if shares else None for key, shares in share.items()}
        ),
        "peaks above 144.3 N in each third": tell(flights, counts),
    }
    return Claim(
        "D10", "rewind alone: thrown sideways by the initial attitude; heading: peaks near the end", parts, numbers
    )


def _peak_shares(flight: Flight) -> list[float]:
    """Return when peaks come as shares of the manoeuvre [-], the highest peak first."""
    ranked = sorted(peaks(flight), key=lambda peak: -peak.tension)
    return [peak.time / float(flight.data["time"][-1]) for peak in ranked]


def _in_thirds(shares: list[float]) -> list[int]:
    """Return how many peaks come in each third."""
    return [int(count) for count in np.histogram(shares, bins=[0.0, 1.0 / 3.0, LAST, 1.0])[0]]


def claim_11(flights: Flights) -> Claim:
    """D11: the shortest time [s], and who docks in it: those whose winch, Ψ [m/s], was never slowed."""
    time = read(flights, lambda flight: float(flight.data["time"][-1]))
    slowest = read(flights, _slowest)
    steady = [key for key, rate in slowest.items() if _never_slowed(rate)]
    parts = {
        "no flight docks sooner than 18.5 m / 0.3 m/s": holds(
            time, KEYS, lambda *times: min(times) >= SHORTEST_TIME - TIME_TOLERANCE
        ),
        "those with Ψ never reduced, and there are some, dock exactly then": len(time) == len(KEYS)
        and holds(time, steady, lambda *times: all(abs(value - SHORTEST_TIME) <= TIME_TOLERANCE for value in times)),
    }
    numbers = {
        "shortest time [s]": SHORTEST_TIME,
        "docking time [s]": tell(flights, time),
        "slowest rewind rate [m/s]": tell(flights, slowest),
    }
    return Claim("D11", "docking takes at least 18.5 m / 0.3 m/s = 61.67 s", parts, numbers)


def check_docking_claims(flights: Flights, grounded: Flights, verdicts: Verdicts) -> list[Claim]:
    """Return claims D1–D11, in order.

    Parameters
    ----------
    flights : mapping
        Flights by table (`rewind`, `heading`, `navigation`) and wind [m/s]: nine, at 6, 9 and 12 m/s.
    grounded : mapping
        The same with ground effect.
    verdicts : mapping
        Table to rows of wind [m/s], metric, published, computed, ratio [-], verdict (agrees, near, differs); the
        metrics of Table 6 stand in the rows of the table whose flights they are of.
    """
    tables = [claim(flights, verdicts) for claim in (claim_1, claim_2, claim_3, claim_4)]
    before, after = (claim_5, claim_6), (claim_8, claim_9, claim_10, claim_11)
    return [
        *tables,
        *(claim(flights) for claim in before),
        claim_7(flights, grounded),
        *(claim(flights) for claim in after),
    ]
