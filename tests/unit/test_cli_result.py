"""The one kind of result and the one way to tell it: JSON alone, whole numbers at any width, CSV of the same table.

If one of these failed, scripts would read words among JSON, or people a number with its last digits cut off.
"""

import csv
import json
import sys

import pytest
import typer

from tethership.cli.common import NO_ANSWER
from tethership.cli.result import Result, show
from tethership.cli.tables import Cell, Row, Table, print_table

LONG = "a remark of many words that does not fit beside its number on a narrow terminal " * 2

ROWS = [
    Row("tension", 1234567.890123, "N", ".3f", LONG),
    Row("outcome", "docked"),
    Row("a quantity with a name of more than forty letters", 1.0 / 3.0, "kg m^2", ".15f"),
]

NUMBERS = ("1234567.890", "0.333333333333333")


@pytest.fixture
def result():
    return Result(
        {"tension": 1234567.890123, "missing": float("nan")},
        "title",
        [Table(ROWS, "first"), Table([[1.0]], "second", ("other",), ("a head",))],
        lines=["said after"],
        files=["a.nc"],
        warnings=["beware"],
    )


@pytest.fixture
def terminal(monkeypatch):
    """Pretend that standard output is a terminal of a width."""

    def of(width):
        monkeypatch.setenv("COLUMNS", str(width))
        monkeypatch.setenv("TERM", "xterm-256color")
        monkeypatch.setattr(sys.stdout, "isatty", lambda: True)

    return of


def test_json_is_one_object_and_nothing_else(result, capsys):
    show(result, as_json=True)
    out, err = capsys.readouterr()
    assert json.loads(out) == {"tension": 1234567.890123, "missing": None, "files": ["a.nc"]}
    assert (out.count("\n"), err) == (1, "")


def test_words_in_their_order_and_warnings_on_standard_error(result, capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "20")
    show(result, as_json=False)
    out, err = capsys.readouterr()
    lines = out.splitlines()
    assert [lines[0], lines[1], lines[5], lines[-2], lines[-1]] == [
        "title",
        "first",
        "second",
        "said after",
        "wrote a.nc",
    ]
    assert lines[2].endswith(LONG.strip())  # no terminal: a line stays one line
    assert lines[6].strip() == "a head"
    assert err == "tethership: warning: beware\n"
    assert "\x1b" not in out
    assert not any(line != line.rstrip() for line in lines)


@pytest.mark.parametrize("width", [20, 80, 200])
def test_a_terminal_wraps_words_and_never_numbers(terminal, capsys, width):
    terminal(width)
    print_table(ROWS, "title")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "title"
    tension, quantity = (next(line for line in lines if number in line) for number in NUMBERS)
    assert tension.split()[:3] == ["tension", NUMBERS[0], "N"]
    assert quantity.split()[-3:] == [NUMBERS[1], "kg", "m^2"]
    assert "…" not in "".join(lines)
    assert " ".join(" ".join(lines).split()).count("remark of many words") >= 1
    assert len(lines) > 4
    assert width < 120 or max(map(len, lines)) <= width


def test_columns_of_numbers_stand_below_one_another_and_empty_ones_are_left_out(capsys):
    rows = [["a", Cell(1.0, "1.00"), "", 5], ["b", Cell(22.0, "22.00"), "", 17]]
    print_table(rows, columns=("name", "size", "nothing", "count"), heads=("name", "size [m]", "nothing", "count"))
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["name", "size", "[m]", "count"]
    assert [line.split() for line in lines] == [["a", "1.00", "5"], ["b", "22.00", "17"]]
    assert len({len(line) for line in (head, *lines)}) == 1


def test_a_table_without_rows_is_its_title(capsys):
    print_table([], "nothing found", ("name",), ("name",))
    assert capsys.readouterr().out == "nothing found\n"


def test_csv_is_the_table_with_every_digit(result, tmp_path, capsys):
    """The other table has columns of its own and is not written; the file is told among the files."""
    path = tmp_path / "t.csv"
    show(result, as_json=True, csv=path)
    assert json.loads(capsys.readouterr().out)["files"] == ["a.nc", str(path)]
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == ["quantity", "value", "unit"]
    assert [[name, unit] for name, _, unit in rows] == [[row.name, row.unit] for row in ROWS]
    assert [float(rows[0][1]), rows[1][1], float(rows[2][1])] == [row.value for row in ROWS]


def test_csv_of_what_people_are_not_shown(tmp_path, capsys):
    """A cell is written as its value; where data are given they are written in place of the tables."""
    data = Table([[Cell(0.5, "50 %"), "x", "beyond"], [Cell(None, "–"), "y", "beyond"]], columns=("share", "of"))
    show(Result({}, tables=[Table(ROWS)], data=data), as_json=False, csv=tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text().splitlines() == ["share,of", "0.5,x", ",y"]
    assert "50 %" not in capsys.readouterr().out


@pytest.mark.parametrize("as_json", [True, False])
@pytest.mark.parametrize(("reason", "said"), [("none converged", "tethership: none converged\n"), ("", "")])
def test_no_answer_is_told_and_ends_with_3(capsys, as_json, reason, said):
    with pytest.raises(typer.Exit) as end:
        show(Result({"outcome": "none"}, answered=False, reason=reason), as_json)
    assert end.value.exit_code == NO_ANSWER
    out, err = capsys.readouterr()
    assert out == ('{"outcome": "none"}\n' if as_json else "")
    assert err == said


def test_a_reason_is_only_said_where_there_is_no_answer(capsys):
    show(Result({}, "found", reason="none"), as_json=False)
    assert capsys.readouterr() == ("found\n", "")
