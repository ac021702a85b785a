"""A campaign's store that was damaged: what is lost or changed is flown again and told, the rest stands, bit for bit.

Truth: the numbers that were kept; here they are drawn, not flown. If this fails, a campaign whose store lost a chunk
looks safer than it is.
"""

import csv
import io
import json
import shutil

import numpy as np
import pytest

from tethership.campaign import run as campaign_run
from tethership.campaign.answers import exceeded, failed, outcomes
from tethership.campaign.execute import in_this_process
from tethership.campaign.marks import Form
from tethership.campaign.plan import make_plan
from tethership.campaign.run import run_campaign
from tethership.campaign.store import UNITS, CampaignStore, open_results, whole_results
from tethership.errors import ConfigError, TethershipWarning
from tethership.results.lock import held
from tethership.view.campaign.csv import KEPT, write_flights

EVERY = [0, 1, 2, 3, 4, 5]


@pytest.fixture(scope="module")
def plan():
    """48 cases under three laws: six batches of 24."""
    return make_plan("layers", {"samples": 48})


def drawn(batch):
    """Return numbers for a batch, the same at every call."""
    numbers, count = np.random.default_rng(batch.number), len(batch.values)
    found = {name: numbers.random(count) for name in UNITS}
    found["outcome"] = numbers.integers(0, 4, count).astype(np.int32)
    found["seconds_above"] = numbers.random((count, 4))
    found["docking_time"][::3] = np.nan
    return found | {"error_E": np.full(count, np.nan)}  # a chunk that is not even written


def fill(store, plan):
    """Fly what is not finished."""
    for number in store.unfinished():
        store.keep(plan.batch(number), drawn(plan.batch(number)))


@pytest.fixture(scope="module")
def undamaged(plan, tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign") / "whole"
    fill(CampaignStore(folder, plan), plan)
    return folder


@pytest.fixture
def folder(undamaged, tmp_path):
    return shutil.copytree(undamaged, tmp_path / "layers")


def flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 4
    path.write_bytes(content)


def zero(path):
    path.write_bytes(bytes(path.stat().st_size))


def remove(path):
    shutil.rmtree(path) if path.is_dir() else path.unlink()


CHUNK, META = "results.zarr/tension_max/c/0/0", "results.zarr/tension_max/zarr.json"


@pytest.mark.parametrize(
    ("damage", "place", "again"),
    [
        (remove, CHUNK, [0]),
        (flip, CHUNK, [0]),
        (zero, CHUNK, [0]),
        (remove, "results.zarr/outcome/c/2/1", [5]),
        (flip, "results.zarr/seconds_above/c/1/0/0", [2]),
        (zero, META, []),
        (remove, META, []),
        (flip, "results.zarr/zarr.json", []),
        (remove, "results.zarr/zarr.json", []),
        (flip, "results.zarr/input/c/1/0/0", []),
        (remove, "results.zarr/input", []),
        (zero, "results.zarr/replicate/zarr.json", []),
        (remove, "results.zarr/tension_max", EVERY),
        (remove, "results.zarr", EVERY),
        (zero, "finished/000003", [3]),
        (flip, "finished/000003", [3]),
        (zero, "campaign.json", []),
        (remove, "campaign.json", []),
    ],
)
def test_what_is_damaged_is_refused_then_flown_again(folder, undamaged, plan, damage, place, again):
    damage(folder / place)
    if "replicate" not in place:  # which no reader uses without the plan
        with pytest.raises(ConfigError) as caught:
            whole_results(folder)
        assert "\n" not in str(caught.value)
    if again or (place == "campaign.json" and damage is zero):
        with pytest.warns(TethershipWarning, match=r"flown again|written anew"):
            store = CampaignStore(folder, plan)
    else:
        store = CampaignStore(folder, plan)
    assert store.unfinished() == again
    fill(store, plan)
    assert whole_results(folder).identical(whole_results(undamaged))
    assert CampaignStore(folder, plan).unfinished() == []


def test_chunks_are_those_that_zarr_writes(undamaged, plan, tmp_path):
    """Byte for byte, the last batch of a law being shorter, and no chunk where there is nothing to say."""
    shorter = make_plan("layers", {"samples": 41})
    ours, theirs = CampaignStore(tmp_path / "ours", shorter), CampaignStore(tmp_path / "theirs", shorter)
    for number in ours.unfinished():
        batch, found = shorter.batch(number), drawn(shorter.batch(number))
        ours.keep(batch, found)
        for name, values in found.items():
            rows = slice(batch.first, batch.first + len(values))
            theirs._arrays.output(name, Form.of(values))[batch.law, rows] = values
    one, other = (
        {path.relative_to(folder): path.read_bytes() for path in (folder / "results.zarr").rglob("*") if path.is_file()}
        for folder in (tmp_path / "ours", tmp_path / "theirs")
    )
    assert one == other
    assert len(list((tmp_path / "ours" / "results.zarr" / "error_E").rglob("*"))) == 1  # its metadata
    ours.keep(shorter.batch(0), drawn(shorter.batch(0)) | {"flight_time": np.full(24, np.nan)})
    assert np.isnan(open_results(tmp_path / "ours")["flight_time"].values[0, :24]).all()


def test_flights_are_written_as_csv_number_by_number(undamaged, plan, tmp_path):
    """The text that a row at a time of numpy's numbers gives."""
    data = whole_results(undamaged)
    flags = exceeded(plan, data)
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(["law", "case", *plan.sample.names, "outcome", "failed", *KEPT, *flags])
    ended, lost = outcomes(data), failed(data)
    for law, case in np.ndindex(ended.shape):
        numbers = [data[name].values[law, case] for name in KEPT]
        passed = [int(of[law, case]) for of in flags.values()]
        drawn = plan.sample.values[case]
        writer.writerow([plan.laws[law].name, case, *drawn, ended[law, case], int(lost[law, case]), *numbers, *passed])
    written = write_flights(tmp_path, plan, data, flags)
    assert written.read_bytes().decode() == text.getvalue()
    assert "nan" in text.getvalue()


def test_a_whole_store_is_not_touched(folder, plan):
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}
    assert CampaignStore(folder, plan).unfinished() == []
    assert before == {path: path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()}


def test_a_changed_manifest_is_told(folder):
    path = folder / "campaign.json"
    path.write_text(path.read_text().replace('"cases": 48', '"cases": 24'))
    with pytest.raises(ConfigError, match=r"campaign\.json is damaged or was changed: it has not the checksum"):
        open_results(folder)
    path.write_text("[]")
    with pytest.raises(ConfigError, match=r"cannot read .*campaign\.json"):
        open_results(folder)


def as_version_0_1(folder):
    """Take the checksums away that version 0.1 did not write."""
    manifest = json.loads((folder / "campaign.json").read_text())
    for key in ("checksum", "lanes", "input", "inputs"):
        del manifest[key]
    (folder / "campaign.json").write_text(json.dumps(manifest))
    for mark in (folder / "finished").iterdir():
        mark.write_text("")


def test_results_of_version_0_1_are_read_with_a_warning(folder, undamaged):
    as_version_0_1(folder)
    with pytest.warns(TethershipWarning, match=r"written by tethership 0\.1, without a checksum"):
        assert whole_results(folder).identical(whole_results(undamaged))


@pytest.mark.parametrize("place", [CHUNK, "results.zarr/outcome/c/2/1", "results.zarr/unbalanced/c/0/0"])
def test_results_of_version_0_1_with_a_lost_chunk_are_refused(folder, place):
    as_version_0_1(folder)
    remove(folder / place)
    with (
        pytest.warns(TethershipWarning),
        pytest.raises(ConfigError, match=r"1 of 6 finished batches in .* are damaged; run the same command again"),
    ):
        open_results(folder)


def test_a_store_of_another_campaign_is_no_result(folder, plan):
    """A mark or a file of another campaign in this one's folder."""
    (folder / "finished" / ".DS_Store").write_text("theirs")
    other = make_plan("layers", {"samples": 48, "seed": 2})
    mark = json.loads((folder / "finished" / "000001").read_text())
    (folder / "finished" / "000001").write_text(json.dumps(mark | {"campaign": other.digest()}))
    with pytest.warns(TethershipWarning, match=r"1 of 6 finished batches .* \(24 flights\)"):
        assert CampaignStore(folder, plan).unfinished() == [1]


def test_two_campaigns_in_one_folder_are_refused(folder, monkeypatch):
    monkeypatch.setattr(campaign_run, "_hands", lambda *_: in_this_process)
    with held(folder), pytest.raises(ConfigError, match=r"in use by process \d+ of .*wait until that ends"):
        run_campaign("layers", folder, {"samples": 48})
