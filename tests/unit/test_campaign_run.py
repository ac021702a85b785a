"""Campaigns flown for real: batches, resuming after SIGKILL, a Dask cluster that loses a worker, what is refused."""

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import tethership as ts
from tethership.campaign.answers import answer, exceeded, failed, undetermined
from tethership.campaign.execute import fly_campaign, in_this_process
from tethership.campaign.marks import Form
from tethership.campaign.plan import make_plan
from tethership.campaign.store import CampaignStore, open_results, whole_results
from tethership.campaign.work import fly_one
from tethership.errors import ConfigError
from tethership.results.seal import sealed
from tethership.scenario.load import packaged_text
from tethership.simulation.batch import CODES

COMMAND = [sys.executable, "-m", "tethership"]

LIMIT = 600.0
"""How long a command is waited for [s], on a loaded machine and with nothing compiled."""


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """Path of the packaged campaign `layers` with 48 cases and few flights kept."""
    text = packaged_text("campaigns", "layers")
    for word, number in (("samples", 48), ("worst", 1), ("random", 1)):
        text = re.sub(rf"^{word} = \d+", f"{word} = {number}", text, flags=re.MULTILINE)
    path = tmp_path_factory.mktemp("small") / "layers.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def run(*arguments, **options):
    """Run the command, check that it went well, and return its JSON."""
    limit = {"timeout": LIMIT, **options}
    done = subprocess.run([*COMMAND, *map(str, arguments), "--json"], capture_output=True, text=True, **limit)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def whole(tmp_path_factory, small):
    """48 cases under three laws, six batches, not interrupted: the folder and what was said."""
    folder = tmp_path_factory.mktemp("whole") / "layers"
    return folder, run("campaign", small, "--out", folder)


@pytest.fixture(scope="module")
def plan(small):
    return make_plan(small)


def marks(folder):
    return list((folder / "finished").glob("[0-9]*"))  # and none that is still being written under another name


def same(first, second):
    """Assert that two campaigns have the same numbers, bit for bit."""
    one, other = open_results(first), open_results(second)
    assert set(one) == set(other)
    for name in one:
        assert np.array_equal(one[name].values, other[name].values, equal_nan=True), name


def test_command_says_runs_failed_and_exceedance(whole):
    folder, said = whole
    assert said["runs"] == 144
    assert said["failed"] == 0
    for limit in ("control_threshold", "envelope_tear", "cable_break", "winch_pull", "attitude", "time"):
        row = said["exceedance"][limit]
        assert 0.0 <= row["low"] <= row["probability"] <= row["high"] <= 1.0
    assert {row["verdict"] for row in said["compliance"]} <= {"met", "not met", "undecided", "no verdict"}
    for path in said["files"]:
        assert Path(path).exists()
    assert "What varies" in (folder / "report.html").read_text(encoding="utf-8")
    assert len((folder / "flights.csv").read_text(encoding="utf-8").splitlines()) == 145


def test_report_in_a_browser(whole, browsed):
    dom = browsed(whole[0] / "report.html")
    assert "Probability of exceeding each limit" in dom
    assert 'data-errors="0"' in dom
    assert dom.count("<img") >= 5


def test_histories_are_kept_of_the_worst_and_of_some(whole):
    folder, said = whole
    chosen = [kept for kept in said["kept"] if kept["why"] == "worst" and kept["law"] == "rewind"]
    worst = [ts.Flight.load(folder / kept["file"]).metrics["tension_max"] for kept in chosen]
    peaks = np.sort(open_results(folder)["tension_max"].values[0])
    assert len(worst) == 1
    assert worst[0] > 0.9 * peaks[-1]


def test_a_case_of_the_batch_is_the_single_flight(whole, plan):
    data = open_results(whole[0])
    peaks = data["tension_max"].values[0]
    gentle = int(np.argsort(peaks)[len(peaks) // 4])
    alone = fly_one(plan.scenario, plan.names, plan.values[0, gentle], "tight")
    # steps of 0.05 s are off by some 0.3 % of the mean tension in the median flight (benchmarks/campaign.py)
    assert alone.metrics["tension_mean"] == pytest.approx(float(data["tension_mean"].values[0, gentle]), rel=1e-2)


def test_every_case_has_its_own_turbulence(whole):
    theta = open_results(whole[0])["theta_rms"].values
    assert len(np.unique(theta)) == 144


@pytest.mark.slow
def test_killed_and_started_again_it_ends_bit_identical(whole, tmp_path, small):
    folder = tmp_path / "layers"
    command = [*COMMAND, "campaign", small, "--out", str(folder), "--workers", "1", "--json"]
    started = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    limit = time.monotonic() + LIMIT
    while not marks(folder) and time.monotonic() < limit and started.poll() is None:
        time.sleep(0.01)
    end([started])
    before = {mark.name: mark.stat().st_mtime_ns for mark in marks(folder)}
    assert 0 < len(before) < 6
    said = run("campaign", small, "--out", folder)
    assert said["flown"] == 24 * (6 - len(before))
    assert before.items() <= {mark.name: mark.stat().st_mtime_ns for mark in marks(folder)}.items()
    same(whole[0], folder)


def test_killed_before_the_store_was_whole_it_begins_again(tmp_path, plan):
    store = CampaignStore(tmp_path / "x", plan)
    shutil.rmtree(store.folder / "finished")
    shutil.rmtree(store.folder / "results.zarr" / "input")
    again = CampaignStore(tmp_path / "x", plan)
    assert again.unfinished() == [0, 1, 2, 3, 4, 5]
    again.keep(plan.batch(0), {"tension_max": np.ones(24)})
    assert np.array_equal(open_results(tmp_path / "x")["input"].values, plan.values)


def test_a_batch_without_its_mark_is_flown_again(whole, tmp_path, plan):
    folder = tmp_path / "layers"
    shutil.copytree(whole[0], folder)
    (folder / "finished" / "000001").unlink()
    store = CampaignStore(folder, plan)
    store._arrays.output("tension_max", Form("<f8", ()))[0, 24:] = -1.0  # as a write cut off would leave it
    with in_this_process() as hands:
        assert fly_campaign(plan, store, hands) == 24
    same(whole[0], folder)


def test_a_finished_campaign_flies_nothing(whole, small):
    folder, said = whole
    again = run("campaign", small, "--out", folder)
    assert again["flown"] == 0
    assert again["exceedance"] == said["exceedance"]


@pytest.mark.parametrize(
    ("changes", "scenario_changes"),
    [({"seed": 2}, {}), ({"samples": 47}, {}), ({}, {"wind.speed": 9.0}), ({}, {"stop.time_limit": 90.0})],
)
def test_another_campaign_in_the_folder_is_refused_and_nothing_touched(whole, changes, scenario_changes, small):
    folder, _ = whole
    before = (folder / "campaign.json").read_bytes(), sorted(marks(folder))
    with pytest.raises(ConfigError, match=r"another campaign.*--out"):
        CampaignStore(folder, make_plan(small, changes, scenario_changes))
    assert before == ((folder / "campaign.json").read_bytes(), sorted(marks(folder)))


def test_a_store_of_another_version_is_refused(whole, tmp_path, plan):
    folder = tmp_path / "old"
    shutil.copytree(whole[0], folder)
    manifest = json.loads((folder / "campaign.json").read_text())
    manifest |= {"tethership": "0.0.1", "digest": "x"}
    (folder / "campaign.json").write_text(json.dumps(sealed(manifest)))
    with pytest.raises(ConfigError, match=re.escape("a campaign of tethership 0.0.1")):
        CampaignStore(folder, plan)


def test_disk_full_keeps_what_is_done(tmp_path, plan, monkeypatch):
    store = CampaignStore(tmp_path / "full", plan)
    batch = plan.batch(0)
    store.keep(batch, {"tension_max": np.ones(24)})

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(store._arrays, "output", full)
    with pytest.raises(ConfigError, match=r"No space left on device.*run the same command again"):
        store.keep(plan.batch(1), {"tension_max": np.ones(24)})
    assert open_results(tmp_path / "full")["tension_max"].values[0, :24].sum() == 24
    assert store.unfinished() == [1, 2, 3, 4, 5]


def test_failed_flights_count_against_every_limit(whole, plan):
    data = open_results(whole[0]).copy(deep=True)
    data["unbalanced"].values[0, 0] = 1.0
    data["unbalanced"].values[0, 1] = np.nan
    assert failed(data).sum() == 2
    assert all(flags[0, :2].all() for flags in exceeded(plan, data).values())
    assert answer(plan, data)["failed"] == 2


@pytest.mark.slow
def test_no_scheduler_is_said_in_one_line(tmp_path, small):
    done = subprocess.run(
        [*COMMAND, "campaign", small, "--scheduler", "tcp://127.0.0.1:9", "--out", str(tmp_path / "x")],
        capture_output=True,
        text=True,
        timeout=LIMIT,
    )
    assert done.returncode == 2
    assert "no scheduler answers at tcp://127.0.0.1:9" in done.stderr.splitlines()[-1]


WITHOUT = """
import sys

class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] == "tethership":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Hidden())
from dask.__main__ import main
sys.argv = ["dask", *sys.argv[1:]]
main()
"""


def start_scheduler(folder):
    """Start a scheduler on loopback; returns its process and the options that name it."""
    file = folder / "scheduler.json"
    common = ["--no-dashboard", "--scheduler-file", str(file)]
    command = [sys.executable, "-m", "dask", "scheduler", "--host", "127.0.0.1", "--port", "0", *common]
    process = subprocess.Popen(command, **quiet(folder))
    limit = time.monotonic() + 60
    while not file.exists() and time.monotonic() < limit:
        time.sleep(0.1)
    return process, common


def quiet(folder):
    return {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder, "start_new_session": True}


def end(processes):
    for process in processes:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait(60)


@pytest.mark.slow
def test_a_worker_without_the_package_is_said_so(tmp_path, small):
    pytest.importorskip("distributed")
    scheduler, common = start_scheduler(tmp_path)
    options = ["worker", "--nworkers", "1", "--nthreads", "1", "--no-nanny", *common]
    worker = subprocess.Popen([sys.executable, "-c", WITHOUT, *options], **quiet(tmp_path))
    try:
        address = json.loads((tmp_path / "scheduler.json").read_text())["address"]
        command = [*COMMAND, "campaign", small, "--out", str(tmp_path / "x"), "--scheduler", address]
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    finally:
        end([worker, scheduler])
    assert done.returncode == 2, done.stderr
    assert "no tethership that can be imported" in done.stderr


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers on loopback: the address and the workers' processes."""
    pytest.importorskip("distributed")
    scheduler, common = start_scheduler(tmp_path)
    command = [sys.executable, "-m", "dask", "worker", "--nworkers", "1", "--nthreads", "1", "--no-nanny", *common]
    workers = [subprocess.Popen(command, **quiet(tmp_path)) for _ in range(2)]
    try:
        yield json.loads((tmp_path / "scheduler.json").read_text())["address"], workers
    finally:
        end([*workers, scheduler])


def test_a_cluster_that_loses_a_worker_loses_nothing(whole, cluster, tmp_path, small):
    address, workers = cluster
    folder = tmp_path / "layers"
    command = [*COMMAND, "campaign", small, "--out", str(folder), "--scheduler", address, "--json"]
    started = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        limit = time.monotonic() + LIMIT
        while not marks(folder) and time.monotonic() < limit and started.poll() is None:
            time.sleep(0.01)
        os.killpg(workers[0].pid, signal.SIGKILL)
        output, errors = started.communicate(timeout=LIMIT)
    finally:
        started.kill()
        started.wait(60)
    assert started.returncode == 0, errors
    assert json.loads(output)["runs"] == 144
    same(whole[0], folder)


def test_plots_show_the_answers(whole, small):
    folder, told = whole
    found = ts.run_campaign(small, folder)
    assert found.flown == 0
    axes = ts.plot_campaign(found)
    drawn = [container.lines[0].get_xdata() for container in axes.containers]
    for points, law in zip(drawn, told["laws"].values(), strict=True):
        np.testing.assert_allclose(points, [row["probability"] for row in law["exceedance"].values()])
    peaks = ts.plot_campaign(found, kind="peaks").lines[0].get_xdata()
    np.testing.assert_array_equal(peaks, np.sort(found.data["tension_max"].values[0]))
    assert len(ts.plot_campaign(found, kind="convergence", law="heading").lines) >= 2
    assert len(ts.plot_campaign(found, kind="importance").patches) == len(found.plan.config.vary) - 1  # no seed
    assert ts.plot_campaign(found, kind="times").get_xlabel() == "time to dock [s]"
    for given, message in (({"kind": "peak"}, "did you mean 'peaks'"), ({"kind": "convergence", "law": "x"}, "no law")):
        with pytest.raises(ConfigError, match=message):
            ts.plot_campaign(found, **given)


@pytest.mark.slow
def test_flights_without_a_start_have_no_verdict_and_exit_3(tmp_path):
    """Wind from aside has no equilibrium for six throttles: nothing can be said of the odds."""
    text = 'title = "Aside"\nscenario = "docking_paper"\nsamples = 6\nworst = 0\nrandom = 0\nverified = 0.0\n'
    text += '[vary."wind.from_direction"]\ndistribution = "uniform"\nlow = 60.0\nhigh = 90.0\nunit = "deg"\n'
    text += '[[requirements]]\nlimit = "cable_break"\nprobability = 0.5\n'
    (tmp_path / "aside.toml").write_text(text, encoding="utf-8")
    command = [*COMMAND, "campaign", str(tmp_path / "aside.toml"), "--out", str(tmp_path / "out"), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    told = json.loads(done.stdout)
    assert done.returncode == 3
    assert told["failed"] == told["runs"] == 6
    assert told["outcomes"] == {"no_equilibrium": 6}
    assert told["compliance"][0]["verdict"] == "no verdict"
    assert told["compliance"][0]["reason"] == "6 of 6 flights have no result"
    assert "no flight has a result (no_equilibrium)" in done.stderr
    with (tmp_path / "out" / "flights.csv").open(encoding="utf-8") as file:
        assert {(row["outcome"], row["failed"]) for row in csv.DictReader(file)} == {("no_equilibrium", "1")}


def test_flights_that_end_early_are_told(whole, plan):
    folder, told = whole
    data = open_results(folder)
    early = data["outcome"].values != CODES.index(ts.Outcome.docked)
    flags = exceeded(plan, data)
    for name, left in undetermined(data, flags).items():
        assert not np.any(left & flags[name])
        assert not np.any(left & ~early)
        rows = [law["exceedance"][name]["undetermined"] for law in told["laws"].values()]
        assert rows == [int(of.sum()) for of in left]
    assert np.any(early)
    assert not undetermined(data, flags)["time"].any()
    assert data["tension_max"].attrs["units"] == "N"


def test_a_store_that_lacks_a_number_is_told(whole, tmp_path):
    folder, _ = whole
    copy = shutil.copytree(folder, tmp_path / "copy")
    shutil.rmtree(copy / "results.zarr" / "tension_max")
    with pytest.raises(ConfigError, match="lacks tension_max"):
        whole_results(copy)
