"""A request for a view, and how it stands. Depends on: explorer.choice, explorer.recipe."""

import hashlib
from typing import Any, NamedTuple

from tethership.explorer.choice import Choice
from tethership.explorer.recipe import Span


class Request(NamedTuple):
    """What a view is to show.

    Attributes
    ----------
    view : str
        trim, locus or flight.
    path : str
        Scenario, as `load_scenario` takes it.
    choice : Choice
        What was changed.
    span : Span, optional
        Of a locus.
    """

    view: str
    path: str
    choice: Choice
    span: Span | None = None

    @property
    def key(self) -> str:
        """A short name of it."""
        return hashlib.sha256(repr(self).encode()).hexdigest()[:16]

    @property
    def words(self) -> str:
        """What it asks for, in words: the scenario and what was changed."""
        return f"{self.choice.scenario} · {'; '.join(self.choice.words) or 'unchanged'}"

    def job(self) -> tuple[Any, ...]:
        """Return the arguments of `tasks.compute`."""
        options = {}
        if self.span is not None:
            options = self.span._asdict() | {"unit": self.span.si_unit}
        return self.view, self.path, self.choice.values, options


class Standing(NamedTuple):
    """How a request stands.

    Attributes
    ----------
    request : Request
    status : str
        waiting, running, done, failed, cancelled.
    text : str
        What is being done, or why it failed.
    share : float, optional
        Part that is done, 0 … 1 [-], where known.
    begun : float
        When it was asked for, or begun [s, monotonic].
    seconds : float
        How long it took [s]; only of what has ended.
    result : Any
        Of what is done.
    asking : int
        Which asking it answers: a run that was dropped may end after the same request was asked for anew, and its
        end says nothing about the new one.
    asked : float
        When it was asked for [s, monotonic].
    """

    request: Request
    status: str
    text: str = ""
    share: float | None = None
    begun: float = 0.0
    seconds: float = 0.0
    result: Any = None
    asking: int = 0
    asked: float = 0.0

    @property
    def busy(self) -> bool:
        """Whether it has not ended."""
        return self.status in ("waiting", "running")
