"""The folder of kept programs, beside JAX's compiled ones: files that are whole or not there. Depends on: jax.

A folder that is not the user's own, a damaged file, a full disk: then there is no program, and it is made anew.
"""

import contextlib
import hashlib
import os
import secrets
from pathlib import Path

import jax

MAGIC = b"tethership program 1\n"
"""Begin of every file; the SHA-256 of all that comes after the digest follows."""

MOST = 100_000_000
"""Size of the folder [byte] beyond which the programs that were used longest ago are taken away."""


def folder() -> Path | None:
    """Return where programs are kept: in the folder of JAX's compilation cache; None where that is off or elsewhere."""
    cache = jax.config.values["jax_compilation_cache_dir"]
    if not cache or "://" in cache or not jax.config.values["jax_enable_compilation_cache"]:
        return None
    return Path(cache) / "programs"


def load(name: str) -> bytes | None:
    """Return what was kept under a name, exactly as it was, or None."""
    place = folder()
    if place is None or not _is_private(place):
        return None
    path = place / name
    try:
        content = path.read_bytes()
        digest, rest = _parts(content)
        if not content.startswith(MAGIC) or hashlib.sha256(rest).digest() != digest:
            path.unlink()
            return None
        os.utime(path)
    except OSError:
        return None
    return rest


def store(name: str, content: bytes) -> None:
    """Keep something under a name where that is possible; what is kept already is replaced in one step."""
    place = folder()
    if place is None:
        return
    part = place / f"{secrets.token_hex(8)}.part"
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_private(place):
            return
        try:
            part.write_bytes(MAGIC + hashlib.sha256(content).digest() + content)
            os.replace(part, place / name)
        finally:
            part.unlink(missing_ok=True)
        _prune(place)
    except OSError:
        return


def _parts(content: bytes) -> tuple[bytes, bytes]:
    """Return digest and rest of a file."""
    start = len(MAGIC)
    return content[start : start + 32], content[start + 32 :]


def _is_private(place: Path) -> bool:
    """Return whether a folder is the user's own, and nobody else may write into it."""
    if not hasattr(os, "geteuid"):
        return True
    try:
        seen = place.stat(follow_symlinks=False)
    except OSError:
        return False
    return seen.st_uid == os.geteuid() and not seen.st_mode & 0o022


def _prune(place: Path) -> None:
    """Take away what was used longest ago, remains of writers that were killed included."""
    files = []
    for path in place.iterdir():
        with contextlib.suppress(OSError):  # another process may prune too
            seen = path.stat()
            files.append((seen.st_mtime, seen.st_size, path))
    total = 0
    for _, size, path in sorted(files, reverse=True):
        total += size
        if total > MOST:
            with contextlib.suppress(OSError):
                path.unlink()
