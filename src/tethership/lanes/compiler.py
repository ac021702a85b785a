"""The C++ compiler of this machine, and the libraries it has made, kept in the user's own folder. Depends on: errors.

A library is known by its source, the compiler, its options and the processor, and by a digest of its own bytes, so that
neither another machine's nor a damaged one is ever loaded. A folder that others may write to is not used.
"""

import contextlib
import ctypes
import functools
import hashlib
import importlib.util
import os
import platform
import shutil
import stat
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from tethership.lanes.not_compiled import NotCompiled

OPTIONS = (
    *("-std=c++17", "-O2", "-shared", "-fPIC", "-fvisibility=hidden", "-w", "-ffp-contract=fast", "-fno-math-errno"),
    *("-fno-trapping-math", "-fassociative-math", "-fno-signed-zeros", "-freciprocal-math"),
)
"""Sums may be reordered and multiply-add fused; NaN and infinity are kept as they are."""

PATIENCE = 600.0
"""How long a compiler may take [s]."""

MOST_KEPT = 64
"""Libraries that are kept; the one that was used longest ago goes first."""


class Compiler(NamedTuple):
    """A C++ compiler.

    Attributes
    ----------
    command : tuple of str
        How it is called.
    version : str
        What it says of itself.
    """

    command: tuple[str, ...]
    version: str


@functools.lru_cache(maxsize=8)
def find_compiler(asked: str | None) -> Compiler:
    """Return the compiler to use: the one asked for, else the system's, else that of the `ziglang` package.

    Raises
    ------
    NotCompiled
        There is none, or it does not run.
    """
    if asked is not None:
        found = [asked.split()]
    else:
        found = [[path] for name in ("c++", "g++", "clang++") if (path := shutil.which(name))]
        if importlib.util.find_spec("ziglang"):
            found.append([sys.executable, "-m", "ziglang", "c++"])
    for command in found:
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            done = subprocess.run([*command, "--version"], capture_output=True, text=True, timeout=60, check=True)
            return Compiler(tuple(command), done.stdout.partition("\n")[0])
    if asked is not None:
        raise NotCompiled(f"the compiler {asked!r} does not run")
    raise NotCompiled("no C++ compiler is found; install one, or `pip install 'tethership[fast]'`")


@functools.cache
def processor() -> str:
    """Return what tells this processor from others: its name and what it can do."""
    with contextlib.suppress(OSError):
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
        wanted = {line.partition(":")[0].strip(): line for line in lines}
        return "\n".join(wanted[name] for name in ("model name", "flags", "Features") if name in wanted)
    return f"{platform.machine()} {platform.processor()}"


@functools.cache
def widest() -> int:
    """Return how many flights a vector of this processor holds: 8 with AVX-512, else 4."""
    return 8 if "avx512f" in processor() and "avx512dq" in processor() else 4


def options(width: int) -> list[str]:
    """Return the compiler's options for vectors of so many flights."""
    native = "-march=native" if width == widest() else "-march=x86-64-v3"
    machine = [native] if platform.machine() in ("x86_64", "AMD64") else []
    library, version = platform.libc_ver()
    vectorised = library == "glibc" and platform.machine() == "x86_64" and bool(machine)
    if not vectorised or "avx2" not in processor():
        return [*OPTIONS, *machine]
    major, minor = (int(part) for part in version.split(".")[:2])
    return [*OPTIONS, *machine, f"-DLIBMVEC={100 * major + minor}"]


def identity(width: int | None = None, compiler: str | None = None) -> str:
    """Return what tells the numbers of one machine's lanes from another's: width, compiler and processor.

    Raises
    ------
    NotCompiled
        There is no compiler.
    """
    found, width = find_compiler(compiler or os.environ.get("CXX") or None), width or widest()
    told = [*found.command, found.version, *options(width), processor()]
    return f"lanes of {width}, {hashlib.sha256(chr(0).join(told).encode()).hexdigest()[:12]}"


def library(source: str, width: int, folder: Path | None, compiler: str | None = None) -> ctypes.CDLL:
    """Return a program's library, made now or kept from before.

    Parameters
    ----------
    source : str
        C++.
    width : int
        Flights in a vector.
    folder : Path or None
        Where libraries are kept; None keeps none.
    compiler : str, optional
        Command of the compiler; `CXX` of the environment where it is set, else what is found.

    Raises
    ------
    NotCompiled
        There is no compiler, or it fails.
    """
    found = find_compiler(compiler or os.environ.get("CXX") or None)
    told = [*found.command, found.version, *options(width), processor(), source]
    key = hashlib.sha256("\0".join(told).encode()).hexdigest()[:32]
    kept = _own_folder(folder)
    if kept is not None and (whole := _whole(kept / f"{key}.so")) is not None:
        return whole
    with tempfile.TemporaryDirectory(prefix="tethership-lanes-") as temporary:
        made = _made(found, source, width, Path(temporary))
        loaded = ctypes.CDLL(str(made))
        if kept is not None:
            with contextlib.suppress(OSError):  # a full disk: the next start compiles again
                _keep(made, kept / f"{key}.so")
        return loaded


def _made(compiler: Compiler, source: str, width: int, folder: Path) -> Path:
    """Return the library that the compiler makes of a source."""
    text, made = folder / "lanes.cc", folder / "lanes.so"
    text.write_text(source, encoding="utf-8")
    command = [*compiler.command, *options(width), str(text), "-o", str(made)]
    linked = ["-lmvec", "-lm"] if any(option.startswith("-DLIBMVEC") for option in command) else ["-lm"]
    try:
        done = subprocess.run([*command, *linked], capture_output=True, text=True, timeout=PATIENCE, check=False)
    except (OSError, subprocess.SubprocessError) as error:
        raise NotCompiled(f"the compiler {compiler.command[0]} failed ({type(error).__name__})") from error
    if done.returncode or not made.exists():
        said = next((line for line in done.stderr.splitlines() if "error" in line.lower()), done.stderr[:200])
        raise NotCompiled(f"the compiler {compiler.command[0]} failed: {said.strip()}")
    return made


def _own_folder(folder: Path | None) -> Path | None:
    """Return a folder that is the user's alone, made where it is missing; None where there can be none."""
    if folder is None:
        return None
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        status = folder.stat()
    except OSError:
        return None
    if hasattr(os, "getuid") and (status.st_uid != os.getuid() or status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)):
        return None
    return folder


def _whole(path: Path) -> ctypes.CDLL | None:
    """Return a kept library whose bytes are those that were written, else None."""
    try:
        said = path.with_suffix(".sha256").read_text(encoding="ascii")
        if hashlib.sha256(path.read_bytes()).hexdigest() != said:
            return None
        loaded = ctypes.CDLL(str(path))
        os.utime(path)
    except (OSError, UnicodeDecodeError):
        return None
    return loaded


def _keep(made: Path, place: Path) -> None:
    """Keep a library and the digest of its bytes, and drop what was used longest ago."""
    data = made.read_bytes()
    for path, content in ((place, data), (place.with_suffix(".sha256"), hashlib.sha256(data).hexdigest().encode())):
        handle, name = tempfile.mkstemp(dir=place.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(name, path)
    others = sorted(place.parent.glob("*.so"), key=lambda path: path.stat().st_mtime)
    for path in others[:-MOST_KEPT]:
        path.unlink(missing_ok=True)
        path.with_suffix(".sha256").unlink(missing_ok=True)
