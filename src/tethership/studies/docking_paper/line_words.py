"""What the quasi-static cable beside a dynamic line says, in words with the run's numbers.

Depends on: simulation.quasi_static.
"""

from typing import Any

from tethership.simulation import MEMORY, TRUSTED

WELL = 0.1
"""Largest median difference of a cable that may be trusted [-]."""


def line_words(cases: dict[str, Any]) -> list[str]:
    """Return what the comparison says; cases by name, each as `line_comparison.compare_line` gives it."""
    snapping = [case for name, case in cases.items() if case["snaps_quasi_static"]]
    of = {law: [c for c in snapping if c["title"].startswith(law)] for law in ("the paper's", "elastic")}
    words = [
        "Each cable was flown again as a line of MoorDyn whose upper end, winch and air are those of the recorded "
        "flight. The motion is prescribed, so the line shows what tension it asks for, not how the flight would have "
        "gone on."
    ]
    for law, name in (
        ("elastic", "elastic catenary"),
        ("the paper's", "paper's cable, whose joint pulls from e = 0.99 on"),
    ):
        ratios = [case["peak_ratio"] for case in of[law]]
        if ratios:
            words.append(
                f"With the {name}, the quasi-static peak is {min(ratios):.2f} to {max(ratios):.2f} times the line's in "
                "the flights that snap."
            )
    for law, name in (("elastic", "elastic catenary"), ("the paper's", "paper's cable")):
        trusted, untrusted = (
            [case[key]["median"] for case in of[law] if case[key]["median"] is not None]
            for key in ("trusted", "untrusted")
        )
        if trusted and untrusted:
            words.append(
                f"Where κ = |dT/dt|/(T ω₁) stayed below {TRUSTED:g} for {MEMORY:g} s, ω₁ being the cable's first "
                f"transverse mode, the tension of the {name} differs by {100 * min(trusted):.0f} to "
                f"{100 * max(trusted):.0f} % (median of each flight), "
                f"{max(case['worst_trusted'] for case in of[law]):.0f} N at most; elsewhere by "
                f"{100 * min(untrusted):.0f} to {100 * max(untrusted):.0f} %."
            )
            if max(trusted) < WELL:
                words.append(f"So the {name} may be trusted inside that range, and a flight that leaves it says so.")
    return words
