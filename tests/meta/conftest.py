"""The command in this process, for tests of what it refuses."""

import sys

import pytest

from tethership.cli import main


@pytest.fixture
def command(monkeypatch, capsys, tmp_path):
    """Return a function that runs the command in an empty folder and returns exit code, output and error."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        monkeypatch.setattr(sys, "argv", ["tethership", *map(str, words)])
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capsys.readouterr()
        return stop.value.code, out, err

    return call


@pytest.fixture
def refusal(command, tmp_path):
    """Return a function that runs the command and returns the one line with which it is refused.

    Refused means: exit 2, nothing on standard output, no new file or folder.
    """

    def call(*words):
        before = sorted(tmp_path.rglob("*"))
        code, out, err = command(*words)
        assert (code, out, err.count("\n")) == (2, "", 1), (code, out[:200], err[:2000])
        assert len(err) < 5000
        assert sorted(tmp_path.rglob("*")) == before
        return err

    return call
