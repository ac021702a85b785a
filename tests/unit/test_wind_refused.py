"""Files that hold no measured wind, or are hostile: refused in one line."""

import os
import re

import numpy as np
import pytest

from tethership.errors import ConfigError
from tethership.scenario.wind_record import read_record


@pytest.fixture
def record(tmp_path):
    """A function that reads a text as a wind record."""

    def read(text):
        (tmp_path / "mast.csv").write_bytes(text.encode("utf-8"))
        return read_record(tmp_path / "mast.csv")

    return read


def rows(*columns):
    return "\n".join(",".join(f"{value:.15g}" for value in row) for row in zip(*columns, strict=True))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has nothing and no sample; wanted: time with north"),
        ("# only a remark\n\n", "has nothing and no sample"),
        ("time,north,east\n", "has a head and no sample"),
        ("TOA5,a\n", "has nothing and no sample"),
        ("time,speed\n0,1\n", "has time, speed; wanted: time with north, east"),
        (",\n,\n", "has no column with a name; wanted"),
        ("time,north,east\n0,1,1\n1,1\n", "sample 2 has 2 cells, the head 3"),
        ("time,north,east\n0,1,1\n1,x,1\n", "north of sample 2 is 'x', not a number; leave it empty"),
        ("time,north,east\n0,1,1\n,1,1\n2,1,1\n3,1,1\n", "sample 2 has no time"),
        ("time,north,east\n0,1,1\n2,1,1\n1,1,1\n3,1,1\n", "times must rise; time of sample 3 is 1 s before the last"),
        ("time,north,east\n0,1,1\n1,1,1\n1,1,1\n3,1,1\n", "time of sample 3 is that of the sample before"),
        ("time,north,east\n0,1,1\n2,1,2\n", "has 2 samples; a record has at least 4"),
        ("time,north,east\n0,1,1\n1,-999,2\n2,1,1\n3,1,1\n", "has 3 samples beside 1 that are missing"),
        ("time,north,east\n" + "\n".join(f"{t},-999,-999" for t in range(9)), "has 0 samples beside 9"),
        ("time,speed,direction\n0,1,1\n1,-3,1\n", "speed of sample 2 is -3, which is -3 m/s and cannot be"),
        ("time,speed,direction\n0,1,1\n1,250,1\n", "250 m/s and cannot be .* or mend the unit"),
        ("time,speed,direction\n0,1,1\n1,3,800\n", "direction of sample 2 is 800"),
        ("time,speed,direction\n04/03/2021 12:00,1,1\n04/03/2021 12:01,3,8\n", "is '04/03/2021 12:00', .* ISO 8601"),
        ("time,speed,direction\n2021-03-04T12:00Z,1,1\n2021-03-04T12:01,3,8\n", "all with a zone or all without"),
        (
            "time,speed,direction\n" + rows(20210304120000 + np.arange(5), [5] * 5, [0] * 5),
            "neither seconds nor a time",
        ),
        (
            "time,speed,direction\n" + rows(44259.5 + np.arange(5) / 86400, [5] * 5, [0] * 5),
            "write its unit in the head",
        ),
        ("time,speed,speed_kt,direction\n" + rows(range(5), [5] * 5, [9] * 5, [0] * 5), "could both be the speed"),
        ("time,north,north,east\n" + rows(range(5), [5] * 5, [9] * 5, [0] * 5), "could both be the north"),
        ('"' + ("x" * 1000 + "\n") * 200, "field larger than field limit"),
        ("time,north\0,east\n0,1,1\n", "it is not a text file"),
        ("time,north,east" + "," * 20_000 + "\n0,1,1\n", "has a line of 20015 characters, at most 10000 are read"),
        ("time,north,east\n" + "\n" * 1_000_000, "has 1000001 lines, at most 1000000 are read"),
    ],
)
def test_a_file_without_a_wind_is_refused_in_one_line(record, text, said):
    with pytest.raises(ConfigError, match=said) as caught:
        record(text)
    assert "\n" not in str(caught.value)


def test_places_that_are_no_files_are_refused_before_they_are_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "folder.nc").mkdir()
    with (tmp_path / "large.csv").open("wb") as file:
        file.truncate(300_000_000)
    for name, said in (
        ("pipe.csv", "no regular file"),
        ("folder.nc", "no regular file"),
        ("large.csv", "it has 300 MB; at most 32 MB are read"),
        ("missing.csv", "No such file"),
        ("nul\0.csv", "null"),
        ("x" * 300 + ".csv", "too long"),
    ):
        with pytest.raises(ConfigError, match=said) as caught:
            read_record(tmp_path / name)
        assert "\0" not in str(caught.value)
    (tmp_path / "mast.xlsx").write_text("x")
    with pytest.raises(ConfigError, match=re.escape("a measured wind is a .csv, .txt, .dat or .nc file with time")):
        read_record(tmp_path / "mast.xlsx")


def test_a_netcdf_that_declares_320_gb_is_refused(tmp_path):
    import h5netcdf

    with h5netcdf.File(tmp_path / "huge.nc", "w") as file:
        file.dimensions = {"time": 40_000_000_000}
        for name in ("time", "north", "east"):
            file.create_variable(name, ("time",), "f8", chunks=(1_000_000,))
    with pytest.raises(ConfigError, match=r"(time|north|east) declares 4e\+10 values, at most 4e\+06 are read"):
        read_record(tmp_path / "huge.nc")


@pytest.mark.parametrize(
    "content", [b"", b"CDF\x01", b"\x89HDF\r\n\x1a\n" + b"\0" * 100, b"CDF\x01" + b"\xff" * 200, b"x" * 50]
)
def test_a_broken_netcdf_is_refused_in_one_line(tmp_path, content):
    (tmp_path / "mast.nc").write_bytes(content)
    with pytest.raises(ConfigError, match="cannot read the wind of") as caught:
        read_record(tmp_path / "mast.nc")
    assert "\n" not in str(caught.value)
