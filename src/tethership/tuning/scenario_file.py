"""A scenario file with tuned gains: the packaged file, these lines replaced. Depends on: errors."""

import re
from collections.abc import Mapping

from tethership.errors import ConfigError

_HEADER = re.compile(r"^\[\[?(?P<section>[\w.]+)\]\]?")
_ENTRY = re.compile(r'^(?P<key>\w+)\s*=\s*\{\s*value\s*=\s*[^,]+,\s*unit\s*=\s*"(?P<unit>[^"]+)".*\}(?P<rest>.*)$')


def retuned_text(template: str, gains: Mapping[str, float], wind: float, words: Mapping[str, str], source: str) -> str:
    """Return a scenario file's text with other gains, wind and words.

    Parameters
    ----------
    template : str
        Text of the scenario whose other numbers stay.
    gains : mapping
        Dotted name → value [SI]; the file's own unit must be SI.
    wind : float
        [m/s].
    words : mapping
        Values of top-level keys that are words: title, description, formulation.
    source : str
        Of the gains.

    Raises
    ------
    ConfigError
        The template has no line for one of the gains.
    """
    wanted = {**gains, "wind.speed": wind}
    section, met, lines = "", set[str](), []
    for line in template.splitlines():
        header, entry = _HEADER.match(line), _ENTRY.match(line)
        if header:
            section = header["section"]
        elif section == "" and (word := line.partition("=")[0].strip()) in words:
            line = f'{word} = "{words[word]}"'
        elif entry and f"{section}.{entry['key']}" in wanted:
            name = f"{section}.{entry['key']}"
            met.add(name)
            said = "" if name == "wind.speed" else f', source = "{source}"'
            line = f'{entry["key"]} = {{ value = {wanted[name]:.6g}, unit = "{entry["unit"]}"{said} }}'
        lines.append(line)
    missing = sorted(set(wanted) - met)
    if missing:
        raise ConfigError(f"the scenario template has no line for {', '.join(missing)}; start from docking_paper")
    return "\n".join(lines) + "\n"
