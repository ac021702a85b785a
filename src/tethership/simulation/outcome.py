"""How a flight ended, as data. Depends on nothing."""

import enum


class Outcome(enum.Enum):
    """Why a flight ended; the value is a sentence with the cure where one is needed."""

    docked = "The cable is rewound to the docking length."
    cable_broken = "A cable's tension reached its breaking force; fly slower, in less wind, or slow the winch earlier."
    ground_contact = "The hull touched the ground; raise the mast (ground.anchor_height) or fly higher."
    attitude_singular = (
        "Pitch passed its limit near ±90°, where Euler angles fail; see stop.largest_pitch and the control gains."
    )
    diverged = "A number stopped being finite; use smaller steps (--solver tight) or look at the last sample kept."
    step_limit = "The budget of steps is used up; raise most_steps in the solver file or loosen its tolerances."
    time_limit = "The time limit passed; raise stop.time_limit if the flight should go on."
    interrupted = "The flight was cut off by a signal; what was flown so far is kept."

    @property
    def is_answer(self) -> bool:
        """Whether the flight ended by physics or by its set time, not for want of computation."""
        return self not in (Outcome.diverged, Outcome.step_limit, Outcome.interrupted)
