"""The report works in a browser, from disk: pictures are seen, plots are drawn when opened, no script fails."""

import re

import numpy as np
import plotly.graph_objects as go
import pytest
from matplotlib.figure import Figure as Drawing

from tethership.view.report.report import Figure, Section, Table, write_report

pytestmark = pytest.mark.slow


def told(dom, name):
    """Return what the page says of itself."""
    found = re.search(rf'<html[^>]* data-{name}="([^"]*)"', dom)
    return found and found.group(1)


def drawn(dom):
    """Return how many plots are drawn."""
    return len(re.findall(r'<svg class="main-svg"[^>]*style="background', dom))


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    folder = tmp_path_factory.mktemp("browser")
    drawing = Drawing(figsize=(3, 2))
    drawing.add_subplot().plot([0, 1], [0, 1])
    drawing.savefig(folder / "a.png")
    time = np.linspace(0.0, 10.0, 50)
    frames = [go.Frame(data=[go.Scatter(x=time, y=np.sin(time + s))], name=str(s)) for s in range(3)]
    plots = [go.Figure(go.Scatter(x=time, y=np.cos(time))), go.Figure(go.Scatter(x=time, y=time), frames=frames)]
    figures = [Figure(f"Figure of number {i}.", folder / "a.png", plot) for i, plot in enumerate(plots)]
    figures.append(Figure("A picture.", folder / "a.png"))
    tables = [Table("T", ["a", "b"], [["x", "agrees"], ["<y>", None]])]
    return write_report(folder / "report.html", "Small", ["Words."], [Section("S", ["p"], tables, figures)], {"a": 1})


def test_pictures_are_seen_and_plots_wait(page, browsed):
    dom = browsed(page)
    assert told(dom, "errors") == "0"
    assert told(dom, "images") == "3"
    assert told(dom, "plots") == "0"
    assert dom.count('<figure class="picture"') == 3
    assert drawn(dom) == 0


def test_opening_draws_the_plots(page, browsed):
    dom = browsed(page, "#open-all")
    assert told(dom, "errors") == "0"
    assert told(dom, "plots") == "2"
    assert drawn(dom) == 2


@pytest.mark.parametrize(
    ("broken", "error"),
    [("<script>undefinedFunction()</script>", "undefinedFunction"), ('<img src="https://example.org/a.png">', "img")],
)
def test_errors_would_be_seen(page, browsed, tmp_path, broken, error):
    """Both kinds of errors that the tests above deny are counted where they occur, the network's among them."""
    copy = tmp_path / "broken.html"
    copy.write_text(page.read_text(encoding="utf-8").replace("</header>", f"{broken}</header>"), encoding="utf-8")
    dom = browsed(copy)
    assert int(told(dom, "errors")) >= 1
    assert re.search(rf'data-last-error="[^"]*({error}|blocked https://example.org)', dom)
