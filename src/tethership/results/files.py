"""Every file that this package writes appears whole or not at all, alone or with those that belong to it.

Depends on: errors. A file is written under a name of its own beside its place, forced to the disk and then renamed: a
full disk or a kill leaves what stood before, and a link in its place is replaced, never written through.
"""

import contextlib
import os
import secrets
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from tethership.errors import ConfigError

Content = bytes | str

ELSEWHERE = "choose another folder with --out"
"""What to do where a file cannot be written."""


def write_atomically(path: str | Path, content: Content, cure: str = ELSEWHERE, new: bool = False) -> Path:
    """Write a file and return where; its folder is made.

    Parameters
    ----------
    path : str or Path
        Where.
    content : bytes or str
        All of it; text is written as UTF-8.
    cure : str
        What the user should do where it cannot be written.
    new : bool
        Refuse a name that is taken.

    Raises
    ------
    ConfigError
        It cannot be written: what stood there stands.
    """
    path = Path(path)
    with _said(path, cure):
        part = _written_beside(path, content)
        try:
            if new:
                _reserve(path)
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)
        _force(path.parent)
    return path


def write_together(files: Mapping[Path, Content | None], cure: str = ELSEWHERE) -> list[Path]:
    """Write files that belong together, and return those that are there.

    Parameters
    ----------
    files : mapping
        Content by place, the chief file first; with None a file of an earlier run is taken away.
    cure : str
        As in `write_atomically`.

    Raises
    ------
    ConfigError
        One of them cannot be written: all that stood there stands.

    Notes
    -----
    All are on the disk before the first is put in its place. The old ones are taken away from the last to the second,
    the new chief file is put in its place and the others follow: cut off in between, files are missing, but none of an
    earlier run lies beside the chief file of this one.
    """
    parts: dict[Path, Path] = {}
    chief = next(iter(files))
    with _said(chief.parent, cure):
        try:
            for path, content in files.items():
                if content is not None:
                    parts[path] = _written_beside(path, content)
            for path in reversed([path for path in files if path != chief]):
                path.unlink(missing_ok=True)
            for path, part in parts.items():
                os.replace(part, path)
        finally:
            for part in parts.values():
                part.unlink(missing_ok=True)
        for folder in {path.parent for path in parts}:
            _force(folder)
    return list(parts)


def check_writable(folder: Path) -> None:
    """Raise OSError where nothing could be written into a folder, or the folder could not be made.

    Notes
    -----
    Nothing is made: a file without a name is opened in the nearest folder that is there.
    """
    folder = Path(folder)
    nearest = next(place for place in (folder, *folder.absolute().parents) if os.path.lexists(place))
    with tempfile.TemporaryFile(dir=nearest):
        pass


@contextlib.contextmanager
def _said(place: Path, cure: str) -> Iterator[None]:
    """Say in one line, with its cure, what the disk refuses."""
    try:
        yield
    except OSError as error:
        raise ConfigError(f"cannot write {place}: {error.strerror or error}; {cure}") from error


def _written_beside(path: Path, content: Content) -> Path:
    """Write a new file in the folder of `path`, force it to the disk and return where it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(0, "a folder of that name is there")
    part = path.parent / f".tethership-{secrets.token_hex(6)}.part"
    try:
        with part.open("xb") as file:  # a name of its own: nothing is followed, nothing overwritten
            file.write(content.encode() if isinstance(content, str) else content)
            file.flush()
            os.fsync(file.fileno())
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    return part


def _reserve(path: Path) -> None:
    """Take a name that is free, or raise ConfigError; of two at once only one gets it."""
    try:
        path.touch(exist_ok=False)
    except FileExistsError:
        raise ConfigError(f"{path} exists already; nothing is overwritten: choose another name or folder") from None


def _force(folder: Path) -> None:
    """Force the names of a folder to the disk, where the system can do that."""
    if os.name == "posix":
        with contextlib.suppress(OSError):  # the file is there; some network disks cannot promise more
            number = os.open(folder, os.O_RDONLY)
            try:
                os.fsync(number)
            finally:
                os.close(number)
