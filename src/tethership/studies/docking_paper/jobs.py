"""Parts of a study as jobs in two processes, each kept as a file and done again only when something changed.

Depends on: campaign (its pool of processes). A job is a function of a folder and settings that returns plain data; what
it needs of others it reads from their files. Its key is a digest of the package's own files, the settings and its name:
with the same key the stored result stands. A part that was made by the same files in the same formulation belongs to
the same study (`belongs`), whatever the other settings were.
"""

import hashlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tethership._kept import source_digest
from tethership.campaign import fresh_processes
from tethership.results import is_whole, sealed, write_atomically

WORKERS = 2
"""Processes at most."""


class Settings(NamedTuple):
    """What a study is of.

    Attributes
    ----------
    formulation : str
        consistent or published.
    flights : int
        Perturbed flights of each row.
    seed : int
        Of everything random.
    """

    formulation: str
    flights: int = 200
    seed: int = 1


class Job(NamedTuple):
    """One part.

    Attributes
    ----------
    function : callable
        From folder and settings to plain data; at the top level of a module, so that a process can find it.
    needs : tuple of str
        Jobs that come before.
    title : str
        For the progress bar.
    after : tuple of str
        Jobs that are done first where they are asked for too: they leave the same programs compiled.
    """

    function: Callable[[Path, Settings], dict[str, Any]]
    needs: tuple[str, ...]
    title: str
    after: tuple[str, ...] = ()


Progress = Callable[[str, float], None]
"""Called with what was finished last and the share of jobs done."""


def part_file(folder: Path, name: str) -> Path:
    """Return where a job's result is kept."""
    return folder / "parts" / f"{name}.json"


def load_part(folder: Path, name: str) -> dict[str, Any]:
    """Return a job's result."""
    return json.loads(part_file(folder, name).read_text(encoding="utf-8"))["result"]


def run_jobs(
    jobs: Mapping[str, Job], folder: Path, settings: Settings, progress: Progress | None = None, fresh: bool = False
) -> dict[str, bool]:
    """Do jobs in their order as far as their needs allow, two at a time, and return which were done anew.

    Parameters
    ----------
    jobs : mapping
        By name; a name in `needs` that is no job here is taken as done.
    folder : Path
        For results.
    settings : Settings
        The same for all.
    progress : callable, optional
        See `Progress`.
    fresh : bool
        Do all of them again.
    """
    (folder / "parts").mkdir(parents=True, exist_ok=True)
    digest = source_digest()
    keys = {name: _key(digest, settings, name) for name in jobs}
    anew: dict[str, bool] = {}
    for name in _ordered(jobs):
        remade = any(anew.get(need, False) for need in jobs[name].needs)
        anew[name] = fresh or remade or not _stands(folder, name, keys[name])
    todo = {name: job for name, job in jobs.items() if anew[name]}
    finished = len(jobs) - len(todo)
    if todo:
        for name, result in _results(todo, folder, settings):
            _keep(folder, name, keys[name], _study(digest, settings), result)
            finished += 1
            if progress is not None:
                progress(jobs[name].title, finished / len(jobs))
    return anew


def _key(digest: str, settings: Settings, name: str) -> str:
    return hashlib.sha256(json.dumps([digest, settings._asdict(), name]).encode()).hexdigest()


def _study(digest: str, settings: Settings) -> str:
    return hashlib.sha256(json.dumps([digest, settings.formulation]).encode()).hexdigest()


def belongs(folder: Path, name: str, settings: Settings) -> bool:
    """Return whether a job's result is in a folder, made by these files of the package in this formulation."""
    return _stands(folder, name, _study(source_digest(), settings), "study")


def _stands(folder: Path, name: str, key: str, of: str = "key") -> bool:
    """Return whether a stored result is whole, has this key and its files are there."""
    try:
        stored = json.loads(part_file(folder, name).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    if not isinstance(stored, dict) or stored.get(of) != key or not is_whole(stored):
        return False
    return all((folder / file).exists() for file in stored["result"].get("files", []))


def _keep(folder: Path, name: str, key: str, study: str, result: dict[str, Any]) -> None:
    """Write a result; a file half written or changed since is never taken for one."""
    text = json.dumps(sealed({"key": key, "study": study, "result": plain(result)}))
    write_atomically(part_file(folder, name), text)


def _ordered(jobs: Mapping[str, Job]) -> list[str]:
    """Return names so that needs come first."""
    order: list[str] = []
    while len(order) < len(jobs):
        ready = [n for n, job in jobs.items() if n not in order and all(m in order or m not in jobs for m in job.needs)]
        assert ready, "jobs need each other in a circle"
        order += ready
    return order


def _results(jobs: Mapping[str, Job], folder: Path, settings: Settings) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield results as they come; a job starts when all it needs has been taken by the caller."""
    waiting, done = dict(jobs), set[str]()
    running: dict[Future, str] = {}
    with fresh_processes(min(WORKERS, os.cpu_count() or 1)) as pool:
        while waiting or running:
            for name, job in list(waiting.items()):
                first = (*job.needs, *job.after)
                if all(other in done or other not in jobs for other in first) and len(running) < WORKERS:
                    running[pool.submit(job.function, folder, settings)] = name
                    del waiting[name]
            ready, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in ready:
                name = running.pop(future)
                yield name, future.result()
                done.add(name)


def plain(value: Any) -> Any:
    """Return data as JSON can hold it; a number that is not finite becomes None."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value
