"""`reproduce`, `identify`, `tune` from the shell: keys, reuse, wrong input, the report in a browser."""

import json

import pytest
from typer.testing import CliRunner

import tethership as ts
from tethership.cli import app
from tethership.errors import ConfigError


def run(*arguments: str):
    return CliRunner().invoke(app, list(arguments))


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """Tables, Figures 12 to 15 and the identification, computed once."""
    folder = tmp_path_factory.mktemp("study")
    only = "table3,table5,figure14,identification"
    result = run("reproduce", "--only", only, "--json", "--out", str(folder))
    assert result.exit_code == 0, result.output
    return folder, only, json.loads(result.stdout)


def test_reproduce(study, is_whole):
    """Tables with published, computed and ratio, claims with their verdict, counts, files; nothing is NaN."""
    folder, _, found = study
    assert set(found["tables"]) == {"table3", "table4", "table5", "table6"}
    row = found["tables"]["table3"][0]
    assert row["published"] == 283
    assert row["ratio"] == pytest.approx(row["computed"] / row["published"])
    assert list(found["claims"]) == [f"D{number}" for number in range(1, 12)]
    assert all(isinstance(claim["holds"], bool) and claim["numbers"] for claim in found["claims"].values())
    assert found["counts"]["holds"] + found["counts"]["does_not_hold"] == 11
    assert found["counts"]["agrees"] >= 40
    predicted = found["counts"]["held_out"]
    assert sum(predicted.values()) == found["counts"]["prediction"] == 33
    held = [row for rows in found["tables"].values() for row in rows if row["held_out"]]
    assert {row["wind"] for row in held} == {9.0}
    assert next(row["published"] for row in held if row["metric"] == "tension_max") == 1555
    assert json.loads((folder / "tables.json").read_text())["tables"] == found["tables"]
    for name in ("report.html", "figures/figure_14.png", "figures/figure_14.html", "figures/figure_15.png"):
        assert is_whole(folder / name), name


def test_a_partial_report_says_so_and_keeps_what_stands(study):
    """Of a folder with more only one part is asked for: report and JSON keep the tables, and say what they lack."""
    folder, only, found = study
    assert found["partial"] is True
    assert {"terms", "variants", "uncertainty"} <= set(found["left_out"])
    assert "tables and claims D1-D11" not in found["left_out"]
    drawn = (folder / "report.html").read_text()
    assert "(partial report)</h1>" in drawn
    assert "This report is partial." in drawn
    said = run("reproduce", "--only", only, "--out", str(folder)).stdout
    assert "partial: without" in said
    assert "leave out --only" in said
    told = json.loads(run("reproduce", "--only", "identification", "--json", "--out", str(folder)).stdout)
    assert told["computed_anew"] == []
    for kept in (told, json.loads((folder / "tables.json").read_text())):
        assert kept["tables"] == found["tables"]
        assert kept["claims"] == found["claims"]


def test_second_run_reuses_what_is_unchanged(study):
    """The same again computes nothing; a lost picture is drawn again, and only that."""
    folder, only, _ = study
    again = json.loads(run("reproduce", "--only", only, "--json", "--out", str(folder)).stdout)
    assert again["computed_anew"] == []
    (folder / "figures" / "fit_residuals.png").unlink()
    again = json.loads(run("reproduce", "--only", only, "--json", "--out", str(folder)).stdout)
    assert again["computed_anew"] == ["fit_pictures"]


def test_report_in_a_browser(study, browsed):
    """Every picture loads, every plot is drawn, no script fails."""
    folder, _, _ = study
    dom = browsed(folder / "report.html", "#open-all")
    head = dom[: dom.index(">", dom.index("<html")) + 1]
    assert 'data-errors="0"' in head
    assert dom.count("<img") >= 7
    assert "main-svg" in dom


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["reproduce", "--only", "table33"], r"--only has no part 'table33'; did you mean 'table3'"),
        (["reproduce", "--only", "table7"], r"--only has no part 'table7'"),
        (["reproduce", "--formulation", "publishd"], r"--formulation 'publishd'.*published"),
        (["identify", "aerostat"], r"not the paper's docking"),
        (["identify", "--set", "vehicle.body.mass=130"], r"vehicle\.body\.mass must be 136\.8"),
        (["reproduce", "--only", ","], r"--only names no part"),
        (["identify", "--power", "5", "--population", "64"], r"fewer than the population"),
        (["identify", "--formulation", "wrong"], r"formulation"),
        (["tune", "hover"], r"tuning needs all layers"),
        (["tune", "--searched", "20", "--flights", "10"], r"more than the 10 flights"),
        (["tune", "docking_paper", "--set", "control.heading.gain=0"], r"must be above 0"),
    ],
)
def test_wrong_input(arguments, message, tmp_path):
    """One clear line that says what came and what is allowed."""
    result = run(*arguments, "--out", str(tmp_path / "out"))
    assert isinstance(result.exception, ConfigError)
    with pytest.raises(ConfigError, match=f"(?s){message}"):
        raise result.exception


@pytest.mark.slow
def test_identify(tmp_path):
    """A search that is far too small still gives all keys and a vehicle that flies."""
    few = ["--power", "5", "--population", "8", "--generations", "1", "--left-out", "0", "--rounds", "2"]
    result = run("identify", *few, "--json", "--out", str(tmp_path))
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert {"parameters", "spread", "misfit", "left_out_misfit", "at_bound", "correlation", "members"} <= set(found)
    scenario = ts.load_scenario("docking_paper", {"vehicle": str(tmp_path / "lotte_identified_published.toml")})
    assert ts.trim(scenario).outcome is not ts.TrimOutcome.no_equilibrium


@pytest.mark.slow
def test_tune(tmp_path):
    """Never worse than the gains it starts from; the scenario it writes flies with the gains it tells."""
    few = ["--flights", "8", "--population", "8", "--generations", "1"]
    result = run("tune", "docking_paper", *few, "--json", "--out", str(tmp_path))
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert set(found["parameters"]) == set(found["former"])
    config = ts.load_scenario(str(tmp_path / "docking_retuned.toml"), {"vehicle": "lotte_identified_published"}).config
    assert config.control.heading.gain == pytest.approx(found["parameters"]["control.heading.gain"], rel=1e-5)
    assert config.wind.speed == 12.0
