"""From what the page says to requests that can be computed. Depends on: explorer.choice, folder, recipe.

What comes from the page is never trusted: scenarios are located in the folder, numbers and names are checked against
the scenario each time.
"""

import functools
import json
import math
import shlex
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from tethership.errors import ConfigError
from tethership.explorer.choice import Choice, Form, choose
from tethership.explorer.fields import in_si, known_parameters, shown, shown_unit, typed
from tethership.explorer.folder import Folder
from tethership.explorer.recipe import Span, command, file_text
from tethership.explorer.standing import Request
from tethership.scenario import Parameter, Scenario, find_parameter, packaged_text, read_text

MOST_POINTS = 400
"""Points of a root locus at most."""

VERBS = {"trim": ("trim",), "locus": ("sweep", "modes"), "flight": ("dock",)}
"""Commands that give a view's numbers."""

USUAL = {"wind.speed": (6.0, 12.0, 13), "trim.elongation": (0.6, 1.0, 21)}
"""Ends in SI and points of a locus over some parameters; of others half to one and a half of their own value."""

FIRST_OVER = ("wind.speed", "trim.elongation", "vehicle.body.mass")
"""What a locus runs over at first: the first of these that the scenario has."""


class Understanding:
    """Knows the scenarios of a folder and turns what the page says into requests.

    Parameters
    ----------
    folder : Folder
        Where scenarios are.
    """

    def __init__(self, folder: Folder) -> None:
        self.folder = folder
        self._load = functools.lru_cache(maxsize=16)(lambda name, stamp: folder.load(name))

    def base(self, name: str) -> Scenario:
        """Return a scenario without changes, read again where its file was edited; errors as `Folder.load`."""
        self.folder.located(name)
        return self._load(name, self.folder.stamp(name))

    def request(self, view: str, form: Form, span: tuple[str, str, str, str]) -> Request:
        """Return what a view is to show.

        Parameters
        ----------
        view : str
            trim, locus or flight.
        form : Form
            What the page says.
        span : tuple of str
            Parameter, ends and points of a locus, as typed.

        Raises
        ------
        ConfigError
            Something cannot be.
        """
        if view not in VERBS:
            raise ConfigError(f"no view {view!r}; there are {', '.join(VERBS)}")
        base = self.base(form.scenario)
        choice = choose(base, form, self.folder.stamp(form.scenario))
        over = self._span(base, *span) if view == "locus" else None
        return Request(view, self.folder.located(form.scenario), choice, over)

    def at_start(self, scenario: str) -> Iterator[Request]:
        """Yield what a page of a scenario asks for first, without changes; the trim before the scenario is read here.

        Raises
        ------
        ConfigError
            As `base`.
        """
        path = self.folder.admitted(scenario)
        unchanged = Choice(scenario, self.folder.stamp(scenario), json.dumps({}), ())
        yield Request("trim", path, unchanged)
        base = self.base(scenario)
        over = first_over(sorted(known_parameters(base.config)))
        yield Request("locus", path, unchanged, self._span(base, over, *self.usual_span(over, scenario)[:3]))
        yield Request("flight", path, unchanged)

    def _span(self, base: Scenario, name: str, low: str, high: str, points: str) -> Span:
        """Return what a locus runs over."""
        parameter = find_parameter(known_parameters(base.config), name, base.name)
        ends = typed(parameter, low, "from"), typed(parameter, high, "to")
        try:
            count = int(points)
        except ValueError as error:
            raise ConfigError(f"points: {points!r} is no whole number; write e.g. 13") from error
        if not 2 <= count <= MOST_POINTS:
            raise ConfigError(f"points: {count} is not between 2 and {MOST_POINTS}; for more use tethership sweep")
        first, last = (in_si(parameter, end) for end in ends)
        if not first < last:
            raise ConfigError("from must be below to; swap the ends of the root locus")
        return Span(parameter.name, *ends, count, parameter.unit)

    def usual_span(self, name: str, scenario: str) -> tuple[str, str, str, str]:
        """Return the ends, points and unit that a locus over a parameter starts with; errors as `base`.

        Ends are in the shown unit: of an angle, 30° to both sides of its own value [deg]; of most others, from half of
        it to one and a half.
        """
        base = self.base(scenario)
        parameter = find_parameter(known_parameters(base.config), name, scenario)
        low, high, points = USUAL.get(name) or (*_around(parameter), 13)
        return shown(parameter, low), shown(parameter, high), str(points), shown_unit(parameter)

    def commands(self, request: Request) -> list[str]:
        """Return the commands that give a request's numbers."""
        name = self._as_typed(request)
        found = []
        for verb in VERBS[request.view]:
            found.append(command(verb, name, request.choice, request.span if verb == "sweep" else None))
        return found

    def commands_on_file(self, request: Request, name: str) -> list[str]:
        """Return the same commands on the file that `file_text` gives, saved under a name."""
        over = "" if request.span is None else f" --over {shlex.quote(request.span.text)}"
        verbs = VERBS[request.view]
        return [f"tethership {verb} {shlex.quote(name)}{over if verb == 'sweep' else ''}" for verb in verbs]

    def file_text(self, request: Request) -> str:
        """Return the scenario file that gives a request's numbers; errors as `recipe.file_text`."""
        name = request.choice.scenario
        packaged = not name.endswith(".toml")
        text = packaged_text("scenarios", name) if packaged else read_text(Path(request.path))
        return file_text(self.base(name), text, request.choice)

    def _as_typed(self, request: Request) -> str:
        """Return the scenario as a command takes it, from the folder in which the explorer was started."""
        if not request.choice.scenario.endswith(".toml"):
            return request.choice.scenario
        path = Path(request.path)
        return str(path.relative_to(Path.cwd())) if path.is_relative_to(Path.cwd()) else str(path)


def first_over(names: Collection[str], wanted: str | None = None) -> str:
    """Return what a locus runs over at first: what is wanted, else the first of `FIRST_OVER` that there is."""
    return next(name for name in (wanted, *FIRST_OVER, *names) if name is not None and name in names)


def _around(parameter: Parameter) -> tuple[float, float]:
    """Return ends around a parameter's own value [SI]."""
    value = parameter.value
    if parameter.unit == "rad":
        return value - math.radians(30.0), value + math.radians(30.0)
    if value == 0.0:
        return -1.0, 1.0
    return tuple(sorted((0.5 * value, 1.5 * value)))  # pyright: ignore[reportReturnType]


def form_of(scenario: str, names: list[Any], texts: list[Any], layers: Any, sas: Any, formulation: Any) -> Form:
    """Return what the page says as a form; nothing that was typed stands for the scenario's own.

    Raises
    ------
    ConfigError
        There are texts without a name, or names without a text.
    """
    if len(names) != len(texts):
        raise ConfigError("the page lacks some of its fields; reload the page")
    typed_texts = {
        str(name["name"]): str(text) for name, text in zip(names, texts, strict=True) if str(text or "").strip()
    }
    return Form(
        str(scenario),
        typed_texts,
        None if layers is None else [str(layer) for layer in layers],
        None if sas is None else bool(sas),
        formulation,
    )
