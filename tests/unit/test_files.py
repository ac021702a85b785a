"""Writing: whole or not at all, alone or together, through no link, and leaving nothing where a command is refused.

If this fails, a full disk or a kill destroys what an earlier run wrote, or leaves its pictures beside another flight.
"""

import errno
import json
import os
import select
import signal
import subprocess
import sys
import time

import pytest

from tethership.cli import main
from tethership.errors import ConfigError
from tethership.results import files
from tethership.results.files import write_atomically, write_together
from tethership.results.lock import held


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def run(monkeypatch, capsys):
    """Run the command in this process; return exit code, standard output and error."""

    def call(*words):
        monkeypatch.setattr(sys, "argv", ["tethership", *map(str, words)])
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capsys.readouterr()
        return stop.value.code, out, err

    return call


def test_a_file_appears_whole_in_a_new_folder(tmp_path):
    assert write_atomically(tmp_path / "a" / "b.txt", "wörter\n").read_bytes() == "wörter\n".encode()
    assert names(tmp_path / "a") == ["b.txt"]


def test_a_link_is_replaced_not_written_through(tmp_path):
    (tmp_path / "theirs").write_text("theirs")
    (tmp_path / "flight.nc").symlink_to(tmp_path / "theirs")
    write_atomically(tmp_path / "flight.nc", "ours")
    assert (tmp_path / "theirs").read_text() == "theirs"
    assert not (tmp_path / "flight.nc").is_symlink()


def full_disk(monkeypatch, room):
    """Let a disk be full after so many files."""
    left = [room]

    def fsync(number):
        left[0] -= 1
        if left[0] < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(files.os, "fsync", fsync)


def test_a_full_disk_leaves_what_stood_there(tmp_path, monkeypatch):
    (tmp_path / "replay.html").write_text("earlier")
    full_disk(monkeypatch, 0)
    with pytest.raises(ConfigError, match=r"cannot write .*replay\.html: No space left on device; choose another"):
        write_atomically(tmp_path / "replay.html", "x" * 1000)
    assert (tmp_path / "replay.html").read_text() == "earlier"
    assert names(tmp_path) == ["replay.html"]


SET = ("flight.nc", "docking.png", "replay.html")


def run_of(folder, word):
    return {folder / name: f"{word} {name}" for name in SET}


def shown(folder):
    """Return of which run each file is."""
    return {path.name: path.read_text().split()[0] for path in folder.iterdir() if path.name in SET}


@pytest.mark.parametrize("room", [0, 1, 2])
def test_a_full_disk_leaves_the_whole_earlier_run(tmp_path, monkeypatch, room):
    write_together(run_of(tmp_path, "old"))
    full_disk(monkeypatch, room)
    with pytest.raises(ConfigError, match="No space left on device"):
        write_together(run_of(tmp_path, "new"))
    assert shown(tmp_path) == dict.fromkeys(SET, "old")
    assert len(names(tmp_path)) == 3


KILLED = """
import os, signal, sys
from pathlib import Path
from tethership.results import files
left = int(sys.argv[2])
def dying(call):
    def counted(*arguments, **options):
        global left
        left -= 1
        if left < 0:
            os.kill(os.getpid(), signal.SIGKILL)
        return call(*arguments, **options)
    return counted
files.os.replace, files.os.fsync, Path.unlink = map(dying, (os.replace, os.fsync, Path.unlink))
folder = Path(sys.argv[1])
names = ("flight.nc", "docking.png", "replay.html")
files.write_together({folder / name: f"new {name}" for name in names})
"""


@pytest.mark.parametrize("steps", range(9))
def test_killed_at_any_step_no_picture_of_another_run_lies_there(tmp_path, steps):
    """Steps: three files to the disk, two old ones taken away, three names; then all is done."""
    write_together(run_of(tmp_path, "old"))
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path), str(steps)], timeout=120)
    assert done.returncode == -signal.SIGKILL
    found = shown(tmp_path)
    assert len(set(found.values())) == 1
    assert "flight.nc" in found
    assert (found["flight.nc"] == "new") == (steps > 5)
    if steps <= 3:
        assert len(found) == 3


def test_what_a_run_does_not_draw_is_taken_away(tmp_path):
    write_together(run_of(tmp_path, "old"))
    files_there = write_together({tmp_path / "flight.nc": "new f", tmp_path / "docking.png": None})
    assert files_there == [tmp_path / "flight.nc"]
    assert shown(tmp_path) == {"flight.nc": "new", "replay.html": "old"}


def test_a_new_name_is_taken_once(tmp_path):
    write_atomically(tmp_path / "mine.toml", "first", new=True)
    with pytest.raises(ConfigError, match=r"mine\.toml exists already; nothing is overwritten"):
        write_atomically(tmp_path / "mine.toml", "second", new=True)
    (tmp_path / "link.toml").symlink_to(tmp_path / "nowhere")
    with pytest.raises(ConfigError, match="exists already"):
        write_atomically(tmp_path / "link.toml", "second", new=True)
    assert names(tmp_path) == ["link.toml", "mine.toml"]
    assert (tmp_path / "mine.toml").read_text() == "first"


def test_a_refused_command_leaves_nothing(run, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "theirs").write_text("theirs")
    (tmp_path / "out" / ".tethership-probe").symlink_to(tmp_path / "theirs")
    code, out, err = run("dock", "nothing_of_that_name", "--out", tmp_path / "out", "--csv", tmp_path / "new" / "t.csv")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert (tmp_path / "theirs").read_text() == "theirs"
    assert names(tmp_path) == ["out", "theirs"]
    code, _, err = run("dock", "nothing_of_that_name", "--out", tmp_path / "deep" / "er")
    assert (code, names(tmp_path)) == (2, ["out", "theirs"]), err


def test_a_place_that_cannot_be_is_said_before_any_work(run, tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "gone").symlink_to(tmp_path / "nowhere")
    for place in ("file", "file/deeper", "gone"):
        code, out, err = run("dock", "--out", tmp_path / place)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert "cannot write into" in err
        assert "choose another folder with --out" in err


HOLDER = """
import sys, time
from pathlib import Path
from tethership.results.lock import held
with held(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def test_one_at_a_time_in_a_folder_and_a_kill_frees_it(tmp_path):
    command = [sys.executable, "-c", HOLDER, str(tmp_path)]
    other = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert other.stdout is not None
        assert select.select([other.stdout], [], [], 120)[0]
        assert other.stdout.readline() == "held\n"
        today = time.strftime("%Y-%m-%d")
        with (
            pytest.raises(ConfigError, match=rf"in use by process {other.pid} of .*, since {today}.*choose another"),
            held(tmp_path),
        ):
            pass
    finally:
        other.kill()
        other.wait(60)
    assert json.loads((tmp_path / ".tethership-lock.json").read_text())["process"] == other.pid  # it could not tidy up
    with held(tmp_path):
        assert json.loads((tmp_path / ".tethership-lock.json").read_text())["process"] == os.getpid()
    assert names(tmp_path) == [".tethership-lock"]
