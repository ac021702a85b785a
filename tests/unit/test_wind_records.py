"""Files of measured wind as instruments and models write them, made here."""

import numpy as np
import pytest
import xarray as xr

from tethership.errors import ConfigError
from tethership.scenario.wind_record import read_record

KNOT = 1852.0 / 3600.0


@pytest.fixture
def record(tmp_path):
    """A function that reads a text as a wind record."""

    def read(text, name="mast.csv", height=None, encoding="utf-8"):
        (tmp_path / name).write_bytes(text.encode(encoding))
        return read_record(tmp_path / name, height)

    return read


@pytest.fixture
def from_netcdf(tmp_path):
    """A function that reads a dataset, written as netCDF 4 or 3, as a wind record."""

    def read(data, engine="h5netcdf", height=None, **options):
        data.to_netcdf(tmp_path / "mast.nc", engine=engine, **options)
        return read_record(tmp_path / "mast.nc", height)

    return read


def rows(*columns):
    return "\n".join(",".join(f"{value:.15g}" for value in row) for row in zip(*columns, strict=True))


# -- units -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("head", "second", "speed", "direction"),
    [
        ("time [s],speed [kn],direction [rad]", 1.0, KNOT, 180.0 / np.pi),
        ("time (min),speed (km/h),direction (deg)", 60.0, 1.0 / 3.6, 1.0),
        ("time_h,speed_kt,direction_rad", 3600.0, KNOT, 180.0 / np.pi),
        ("time_ms,wind_speed_mph,wind_direction_deg", 1e-3, 0.44704, 1.0),
        ("t,ws m/s,wd °", 1.0, 1.0, 1.0),
        ("time,speed,direction\ns,ft/s,rad", 1.0, 0.3048, 180.0 / np.pi),
        ("time,speed,direction", 1.0, 1.0, 1.0),
    ],
)
def test_a_unit_in_the_head_of_a_column_is_read(record, head, second, speed, direction):
    found = record(f"{head}\n" + rows([0.0, 1.0, 2.0, 3.0], [8.0] * 4, [0.5] * 4))
    assert np.allclose(found.times, np.arange(4) * second)
    assert np.hypot(*found.mean[:2]) == pytest.approx(8.0 * speed)
    assert np.degrees(np.arctan2(-found.mean[1], -found.mean[0])) == pytest.approx(0.5 * direction)
    assert bool(found.remarks) == (second > 60.0)  # hours between samples are worth a word


def test_units_of_netcdf_are_read(from_netcdf):
    """Version 0.1 took hours for seconds, knots for m/s and radians for degrees."""
    attributes = {"time": "hours since 1900-01-01 00:00:00", "speed": "knots", "direction": "radians"}
    found = from_netcdf(
        xr.Dataset(
            {
                "speed": ("time", np.full(5, 10.0), {"units": attributes["speed"]}),
                "direction": ("time", np.full(5, 0.5), {"units": attributes["direction"]}),
            },
            {"time": ("time", 1_060_000.0 + 0.001 * np.arange(5), {"units": attributes["time"]})},
        )
    )
    assert np.allclose(found.times, 3.6 * np.arange(5), atol=1e-5)
    assert np.allclose(found.mean, [-10.0 * KNOT * np.cos(0.5), -10.0 * KNOT * np.sin(0.5), 0.0])


@pytest.mark.parametrize("unit", ["milliseconds since 2021-03-04T00:00:00Z", "ms"])
def test_milliseconds_of_netcdf_are_read(from_netcdf, unit):
    times = np.arange(5, dtype=np.int64) * 100 + 1_614_859_200_000
    wind = {"north": ("time", np.full(5, -7.0)), "east": ("time", np.zeros(5))}
    assert np.allclose(
        from_netcdf(xr.Dataset(wind, {"time": ("time", times, {"units": unit})})).times, np.arange(5) / 10
    )


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("time,speed [beaufort],direction", r"the unit of speed is 'beaufort'; give it in one of m/s, kn, km/h"),
        ("time,speed,direction [m]", "the unit of direction is 'm'; give it in one of deg, rad"),
        ("time [m/s],speed,direction", "the unit of time is 'm/s'; give it in one of s, ms"),
    ],
)
def test_a_unit_of_another_kind_is_refused(record, head, said):
    with pytest.raises(ConfigError, match=said):
        record(f"{head}\n" + rows(range(5), [5] * 5, [0] * 5))


# -- what people have --------------------------------------------------------------------------------------------------


def test_a_campbell_logger(record):
    """TOA5: four lines of head, stamps in quotes, "NAN" where nothing was measured."""
    lines = [f'"2021-03-04 11:59:5{5 + n}",{n},{5 + n},270,8.9,12.{n}' for n in range(4)]
    lines += ['"2021-03-04 11:59:59",4,"NAN","NAN",8.9,12.4', '"2021-03-04 12:00:00.5",5,10.5,270,8.9,12.5']
    head = (
        '"TOA5","38961","CR1000","38961","CR1000.Std.26","CPU:mast.CR1","50269","OneSec"\n'
        '"TIMESTAMP","RECORD","WS_ms_S_WVT","WindDir_D1_WVT","WS_ms_Max","BattV"\n'
        '"TS","RN","meters/second","degrees","meters/second","Volts"\n"","","WVc","WVc","Max","Smp"\n'
    )
    found = record(head + "\n".join(lines[:4] + lines[5:]) + "\n", "mast.dat")
    assert np.allclose(found.times, [0.0, 1.0, 2.0, 3.0, 5.5])
    assert np.allclose(found.velocities[:, 1], [5.0, 6.0, 7.0, 8.0, 10.5])  # from the west the air goes east
    assert found.remarks == (
        "mast.dat: not used: RECORD, WS_ms_Max, BattV",
        "mast.dat: 1 gap of up to 2.5 s bridged; a usual step is 1 s",
    )
    holed = record(head + "\n".join(lines) + "\n", "mast.dat")
    assert np.allclose(holed.times, found.times)
    assert "mast.dat: 1 of 6 samples are missing, sample 5 the first" in holed.remarks


def test_a_sonic_at_10_hz(record):
    times = np.arange(100) / 10
    u, v, w = 5.0 + np.sin(times), -3.0 + np.cos(times), 0.3 * np.sin(3.0 * times)
    stamps = [f"2021-03-04T12:00:{time:04.1f}+01:00" for time in times]
    lines = "\n".join(f"{s},{a:.6f},{b:.6f},{c:.6f},290.1" for s, a, b, c in zip(stamps, u, v, w, strict=True))
    found = record(f"TIMESTAMP,u [m/s],v [m/s],w [m/s],T_sonic\n{lines}\n")
    assert np.allclose(found.times, times)
    assert np.allclose(found.velocities, np.stack([v, u, -w], axis=1), atol=1e-6)
    assert found.remarks == (
        "mast.csv: not used: T_sonic",
        "mast.csv: read v as northward, u as eastward, w as upward; an anemometer's own axes must be turned to these "
        "first",
    )


def test_up_is_against_down(record):
    """Version 0.1 dropped the column."""
    up = record("time,north,east,up\n" + rows(range(5), [-6] * 5, [0] * 5, [0.5] * 5))
    down = record("time,speed,direction,down\n" + rows(range(5), [6] * 5, [0] * 5, [-0.5] * 5))
    assert np.allclose(up.mean, [-6.0, 0.0, -0.5])
    assert np.allclose(down.mean, up.mean)


@pytest.mark.parametrize("engine", ["h5netcdf", "scipy"])
def test_a_point_of_era5(from_netcdf, engine):
    """Packed into 16 bits, hours since 1900, one place: netCDF 3 as of old, netCDF 4 as of now."""
    hours = 1_060_000 + np.arange(6)
    dims = ("time", "latitude", "longitude")
    packing = {"dtype": "int16", "scale_factor": 0.001, "add_offset": 2.0, "_FillValue": np.int16(-32767)}
    wind = {
        "u10": (dims, np.full((6, 1, 1), 4.0), {"units": "m s**-1", "standard_name": "unknown"}),
        "v10": (dims, np.full((6, 1, 1), -3.0), {"units": "m s**-1"}),
        "t2m": (dims, np.full((6, 1, 1), 290.0), {"units": "K"}),
        "w": (dims, np.full((6, 1, 1), 0.1), {"units": "Pa s**-1"}),
    }
    coords = {
        "time": (
            "time",
            hours.astype("int32"),
            {"units": "hours since 1900-01-01 00:00:00.0", "calendar": "gregorian"},
        ),
        "latitude": ("latitude", [45.0]),
        "longitude": ("longitude", [9.0]),
    }
    found = from_netcdf(xr.Dataset(wind, coords), engine, encoding={"u10": packing, "v10": packing})
    assert np.allclose(found.times, 3600.0 * np.arange(6))
    assert np.allclose(found.mean, [-3.0, 4.0, 0.0], atol=1e-3)
    assert found.height == 10.0
    assert found.remarks[0] == "mast.nc: not used: t2m, w, latitude, longitude"
    assert "a sample every 3600 s holds no gusts" in found.remarks[1]


def test_several_places_are_refused(from_netcdf):
    dims = ("time", "latitude", "longitude")
    wind = {name: (dims, np.ones((6, 2, 3))) for name in ("u10", "v10")}
    with pytest.raises(ConfigError, match=r"u10 runs over latitude \(2\), longitude \(3\) besides time; select one"):
        from_netcdf(xr.Dataset(wind, {"time": ("time", np.arange(6.0))}))


def test_an_airport(record):
    """Knots and degrees, calm without a direction, M where nothing was measured."""
    stamps = [f"2024-01-01 {hour:02d}:53" for hour in range(7)]
    lines = [
        f"KXYZ,{s},{d},{k}"
        for s, d, k in zip(stamps, [270, 0, "M", 270, "M", 270, 270], [10, 0, 0, "M", 9, 8, 8], strict=True)
    ]
    found = record("station,valid,drct,sknt\n" + "\n".join(lines), "airport.txt")
    assert np.allclose(found.velocities[:, 1], np.array([10, 0, 0, 8, 8]) * KNOT)
    assert found.times[-1] == 6 * 3600.0
    assert "airport.txt: 2 of 7 samples are missing, sample 4 the first" in found.remarks


LIDAR_WIDE = "Timestamp (end of interval)" + "".join(
    f",{height}m Wind Speed (m/s),{height}m Wind Direction (°)" for height in (40, 80)
)
LIDAR_LONG = "time,height [m],speed,direction"


def test_a_lidar_asks_for_one_of_its_heights(record):
    wide = "\n".join(f"2021/03/04 12:00:0{n},5,0,{8 + n},0" for n in range(5))
    long = "\n".join(f"{n},40,5,0\n{n},80,{8 + n},0" for n in range(5))
    for text, encoding in ((f"{LIDAR_WIDE}\n{wide}", "latin-1"), (f"{LIDAR_LONG}\n{long}", "utf-8")):
        with pytest.raises(ConfigError, match=r"has several heights \(40, 80 m\); say which .* height = \{ value = 40"):
            record(text, encoding=encoding)
        with pytest.raises(ConfigError, match=r"has no height of 60 m, but \(40, 80 m\)"):
            record(text, height=60.0, encoding=encoding)
        found = record(text, height=80.0, encoding=encoding)
        assert np.allclose(found.velocities[:, 0], -8.0 - np.arange(5))
        assert found.height == 80.0
    assert record(f"{LIDAR_LONG}\n" + rows(range(5), [40] * 5, [5] * 5, [0] * 5)).height == 40.0


def test_heights_along_a_dimension(from_netcdf):
    speed = np.stack([np.full(5, 5.0), np.full(5, 9.0)], axis=0)
    data = xr.Dataset(
        {"wind_speed": (("height", "time"), speed), "wind_from_direction": (("time", "height"), np.zeros((5, 2)))},
        {"time": ("time", np.arange(5.0)), "height": ("height", [10.0, 100.0], {"units": "ft"})},
    )
    with pytest.raises(ConfigError, match=r"several heights \(3.048, 30.48 m\)"):
        from_netcdf(data)
    assert from_netcdf(data, height=30.48).mean[0] == pytest.approx(-9.0)


def test_semicolons_and_decimal_commas(record):
    found = record("date;time;ws;wd\n" + "\n".join(f"2021-03-04;23:59:5{n + 5},5;7,25;180,0" for n in range(5)))
    assert np.allclose(found.mean, [7.25, 0.0, 0.0])
    assert np.allclose(found.times, np.arange(5))


# -- missing values and gaps -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "marker", ["-999,999", "-9999,-9999", "9999,999", "99.99,999.9", ",", "NaN,NaN", "1e20,1e20", "-,999"]
)
def test_markers_of_missing_values_are_bridged_and_told(record, marker):
    """Version 0.1 flew a mean of 26.5 m/s from 178.8°."""
    lines = [f"{n},6,30" for n in range(12)]
    lines[4] = f"4,{marker}"
    found = record("time,speed,direction\n" + "\n".join(lines))
    assert np.hypot(*found.mean[:2]) == pytest.approx(6.0)
    assert len(found.times) == 11
    assert found.remarks[0] == "mast.csv: 1 of 12 samples are missing, sample 5 the first"


def test_fill_values_of_netcdf_are_bridged(from_netcdf):
    values = np.full(12, -6.0)
    values[[3, 7]] = [-1234.0, np.nan]
    wind = {"north": ("time", values, {"missing_value": -1234.0}), "east": ("time", np.zeros(12))}
    found = from_netcdf(xr.Dataset(wind, {"time": ("time", np.arange(12.0))}))
    assert np.allclose(found.mean, [-6.0, 0.0, 0.0])
    assert "2 of 12 samples are missing" in found.remarks[0]


def test_missing_samples_at_the_ends_are_cut_off(record):
    lines = [f"{n + 100},{'' if n in (0, 1, 9) else n},30" for n in range(10)]
    found = record("time,speed,direction\n" + "\n".join(lines))
    assert np.allclose(found.times, np.arange(7))
    assert "3 of 10 samples are missing, sample 1 the first" in found.remarks[0]


def test_a_long_gap_is_refused(record):
    """Version 0.1 drew a cubic over 500 s."""
    times = np.concatenate([np.arange(50.0), 549.0 + np.arange(50.0)])
    said = r"nothing was measured for 500 s after sample 50 \(49 s from the first\); where a step is 1 s up to 10 s are"
    with pytest.raises(ConfigError, match=said):
        record("time,north,east\n" + rows(times, -6.0 - 0.0 * times, 0.0 * times))


def test_a_mean_is_one_over_time(record):
    """Fast samples in a lull and slow ones in a blow: by count 8 m/s, over time 10.4 m/s."""
    times, speeds = [0, 1, 2, 3, 4, 5, 10, 15, 20], [4, 4, 4, 4, 8, 12, 12, 12, 12]
    found = record("time,speed,direction\n" + rows(times, speeds, [90] * 9))
    by_hand = (3 * 4 + 0.5 * (4 + 8) + 0.5 * (8 + 12) + 3 * 5 * 12) / 20
    assert np.allclose(found.mean, [0.0, -by_hand, 0.0])
    assert by_hand > 1.25 * np.mean(speeds)


def test_epoch_milliseconds_are_known_by_their_size(record):
    times = 1_614_859_200_000 + 100 * np.arange(5)
    found = record("time,north,east\n" + rows(times, [5] * 5, [0] * 5))
    assert found.times[-1] == pytest.approx(0.4)
    assert found.remarks == ("mast.csv: time is read as ms since 1970: in seconds it would be beyond the year 2100",)
    seconds = record("time,north,east\n" + rows(1_614_859_200 + np.arange(5), [5] * 5, [0] * 5))
    assert (seconds.times[-1], seconds.remarks) == (4.0, ())
