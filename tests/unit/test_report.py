"""The report is one page that needs nothing else and says what it was given, in order, and nothing more.

If one of these failed, a reader would see another number than was computed, or a broken page where there is no network.
"""

import base64
import json
import re
import struct
import zlib
from html.parser import HTMLParser

import numpy as np
import plotly.graph_objects as go
import pytest
from plotly.offline import get_plotlyjs

from tethership.errors import ConfigError
from tethership.view.report.report import VERDICTS, Figure, Section, Table, write_report
from tethership.view.report.text import marked, number

VOID = {"meta", "img", "br", "link", "hr", "input"}
EVIL = "<script>alert('1')</script> & \"quotes\""


def png(width=3, height=2):
    """Return a white picture."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = (b"\x00" + b"\xff" * width) * height
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    parts = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + parts


class Page(HTMLParser):
    """A page, read: every element with its attributes and its text, and whether all are closed in order."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.elements, self.open, self.problems = [], [], []
        self.feed(text)
        self.problems += self.open

    def handle_starttag(self, tag, attrs):
        element = {"tag": tag, "text": "", **dict(attrs)}
        self.elements.append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop()["tag"] != tag:
            self.problems.append(tag)

    def handle_data(self, data):
        for element in self.open:
            element["text"] += data

    def all(self, tag, **wanted):
        """Return the elements of a tag and, if asked, of an attribute."""
        return [e for e in self.elements if e["tag"] == tag and all(e.get(k) == v for k, v in wanted.items())]

    def marked(self, name):
        """Return the elements of a class."""
        return [e for e in self.elements if name in (e.get("class") or "").split()]


def written(tmp_path, sections, title="A report", abstract=(), footer=None):
    """Return a report's text and the page read from it."""
    path = write_report(tmp_path / "new" / "report.html", title, abstract, sections, footer or {})
    text = path.read_text(encoding="utf-8")
    return text, Page(text)


def plot(name="</script><b>tension</b>"):
    """Return a plot."""
    return go.Figure(go.Scatter(x=[0, 1], y=[0.5, float("nan")], name=name))


def rich():
    """Return sections that hold everything."""
    tension = Table(
        "Largest tension.",
        ["wind [m/s]", "published [N]", "computed [N]", "verdict"],
        [[6.0, 156, 149.234, "agrees"], [9.0, None, 512.3, None], [12.0, 1246, 2923.4, "differs"]],
        "As in Table 3.",
        3,
        "tension",
    )
    inner = Section("Heading", figures=[Figure("A plot.", None, plot())], tables=[Table("Few.", ["a"], [["x"]])])
    return [
        Section("Stability", ["See [[tension]], [[picture]] and [[rewind]]."], label="stability"),
        Section(
            "Docking",
            ["Flown with `--wind 12`, **briefly**."],
            [tension],
            [Figure("A picture. It is white.", png(), plot(), "White.", "picture")],
            [Section("Rewind", label="rewind"), inner],
        ),
    ]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    return written(tmp_path_factory.mktemp("report"), rich(), "Docking", ["In short."], {"jax": "0.7", "seed": None})


def test_page_is_well_formed_and_accessible(report):
    text, page = report
    assert text.startswith("<!DOCTYPE html>")
    assert page.problems == []
    assert page.all("html")[0]["lang"] == "en"
    assert page.all("title")[0]["text"] == "Docking"
    assert [e.get("content") for e in page.all("meta", name="viewport")] == ["width=device-width, initial-scale=1"]
    assert [e["alt"] for e in page.all("img")] == ["White."]
    assert len(page.all("figcaption")) == len(page.all("figure")) == 4
    identifiers = [e["id"] for e in page.elements if "id" in e]
    assert len(identifiers) == len(set(identifiers))


def test_headings_are_in_order_and_numbered(report):
    headings = [(e["tag"], e["text"]) for e in report[1].elements if re.fullmatch(r"h\d", e["tag"])]
    assert headings == [
        ("h1", "Docking"),
        ("h2", "1 Stability"),
        ("h2", "2 Docking"),
        ("h3", "2.1 Rewind"),
        ("h3", "2.2 Heading"),
        ("h2", "Provenance"),
    ]


def test_tables_and_figures_are_numbered_through(report):
    captions = [e["text"] for e in report[1].all("figcaption")]
    assert captions == [
        "Table 1. Largest tension.",
        "Figure 1. A picture. It is white.",
        "Table 2. Few.",
        "Figure 2. A plot.",
    ]


def test_contents_and_references_lead_to_what_they_name(report):
    page = report[1]
    targets = {e["id"]: e["text"] for e in page.elements if "id" in e}
    links = {e["text"]: e["href"][1:] for e in page.all("a")}
    assert set(links) >= {"1 Stability", "2.2 Heading", "Table 1", "Table 2", "Figure 1", "Figure 2", "Section 2.1"}
    for text, target in links.items():
        words = text.removeprefix("Section ")
        assert words in targets[target], text
    assert page.all("p")[1]["text"] == "See Table 1, Figure 1 and Section 2.1."
    assert "Figure 1 A picture" in [e["text"] for e in page.all("li")]


def test_sections_deeper_than_headings_go(tmp_path):
    section = Section("deepest")
    for _ in range(7):
        section = Section("deep", sections=[section])
    page = written(tmp_path, [section])[1]
    assert page.problems == []
    assert [e["text"] for e in page.all("h6")][-1] == "1.1.1.1.1.1.1.1 deepest"


def test_nothing_is_loaded_from_elsewhere(report):
    text, page = report
    for element in page.elements:
        for name in ("src", "href", "srcset", "data", "action"):
            address = element.get(name) or ""
            assert address.startswith(("#", "data:image/png;base64,")) or not address, element["tag"]
    styles = "".join(e["text"] for e in page.all("style"))
    assert "url(" not in styles
    assert "@import" not in styles
    policy = page.all("meta", **{"http-equiv": "Content-Security-Policy"})[0]["content"]
    assert "default-src 'none'" in policy
    assert "http" not in policy
    assert not page.all("link")
    assert "@media print" in text


def test_addresses_are_plain_links(tmp_path):
    page = written(tmp_path, [Section("Source", ["See (https://doi.org/10.1016/j.ast.2024.1?a=1&b=<2>)."])])[1]
    links = [e for e in page.all("a") if e["href"].startswith("http")]
    assert [(e["href"], e["text"]) for e in links] == [("https://doi.org/10.1016/j.ast.2024.1?a=1&b=",) * 2]


def test_plotly_is_there_once_and_only_if_there_is_a_plot(report, tmp_path):
    start = get_plotlyjs()[:200]
    assert report[0].count(start) == 1
    assert len(report[1].marked("plot")) == 2
    still = written(tmp_path, [Section("Still", figures=[Figure("A picture.", png())])])[0]
    assert start not in still
    assert len(still) < 30_000


def test_plots_are_data_that_cannot_end_their_script(report):
    scripts = [e["text"] for e in report[1].all("script", type="application/json")]
    assert len(scripts) == 2
    for script in scripts:
        data = json.loads(script)
        assert data["data"][0]["name"] == "</script><b>tension</b>"
        assert "<" not in script


def test_plot_from_a_file_is_the_same_as_from_memory(tmp_path):
    file = tmp_path / "plot.json"
    plot().write_json(file)
    pages = [written(tmp_path, [Section("S", figures=[Figure("F", None, source)])])[1] for source in (plot(), file)]
    one, other = (json.loads(page.all("script", type="application/json")[0]["text"]) for page in pages)
    assert one == other


def test_picture_is_embedded_with_its_size(report, tmp_path):
    (image,) = report[1].all("img")
    assert base64.b64decode(image["src"].removeprefix("data:image/png;base64,")) == png()
    assert (image["width"], image["height"]) == ("3", "2")
    (tmp_path / "a.png").write_bytes(png(7, 5))
    image = written(tmp_path, [Section("S", figures=[Figure("**Bold** `code`", tmp_path / "a.png")])])[1].all("img")[0]
    assert (image["width"], image["height"], image["alt"]) == ("7", "5", "Bold code")


def test_everything_is_escaped(tmp_path):
    table = Table(EVIL, [EVIL], [[EVIL]], EVIL)
    section = Section(EVIL, [EVIL, f"`{EVIL}`", f"**{EVIL}**"], [table], [Figure(EVIL, png(), None, EVIL)])
    text, page = written(tmp_path, [section], EVIL, [EVIL], {EVIL: EVIL})
    assert page.problems == []
    assert "alert('1')" not in text.replace("&#x27;", "")
    assert len(page.all("script")) == 2  # the page's own
    for tag in ("title", "h1", "th", "code", "strong", "dt", "dd"):
        assert page.all(tag)[0]["text"] == EVIL, tag
    assert page.all("img")[0]["alt"] == EVIL
    assert "Table 1. " + EVIL in [e["text"] for e in page.all("figcaption")]


def test_marks_of_text():
    assert marked("a `b*c*` **d**") == "a <code>b*c*</code> <strong>d</strong>"
    assert marked("2**3, a`b") == "2**3, a`b"
    assert marked("`**no** [[x]] https://a.b`", {}) == "<code>**no** [[x]] https://a.b</code>"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (149.234, "149.2"),
        (0.3, "0.3"),
        (0.0100000009, "0.01"),
        (9.99996, "10"),
        (-2.346, "−2.346"),
        (2923.4, "2923"),
        (9999.7, "10\u202f000"),
        (123456.7, "123\u202f457"),
        (1234, "1234"),
        (12460, "12\u202f460"),
        (-7, "−7"),
        (0.0, "0"),
        (-0.0, "0"),
        (1.3e-7, "1.30 × 10<sup>−7</sup>"),
        (-4.2e9, "−4.20 × 10<sup>9</sup>"),
        (0.00123456, "0.001235"),
        (np.float64(0.5), "0.5"),
        (np.int64(20000), "20\u202f000"),
        (float("nan"), "not a number"),
        (float("-inf"), "−∞"),
    ],
)
def test_numbers_as_in_print(value, text):
    assert number(value) == text


def test_cells(tmp_path):
    rows = [["a", 1.5, None, True, "12 %"], ["b", None, "long words", False, "−3"], ["c", 2, "x", np.bool_(True), None]]
    page = written(tmp_path, [Section("S", tables=[Table("T", ["name", "n", "words", "ok", "share"], rows)])])[1]
    assert [e["text"] for e in page.all("td")] == [
        *("1.5", "–", "yes", "12 %"),
        *("–", "long words", "no", "−3"),
        *("2", "x", "yes", "–"),
    ]
    heads = page.all("th")
    assert [e["scope"] for e in heads] == ["col"] * 5 + ["row"] * 3
    assert [e["text"] for e in heads[5:]] == ["a", "b", "c"]
    right = [e["text"] for e in page.marked("n") if e["tag"] == "th"]
    assert right == ["n", "share"]
    assert page.marked("verdict") == []


@pytest.mark.parametrize(("word", "kind"), VERDICTS.items())
def test_verdicts_are_read_without_colour(tmp_path, word, kind):
    table = Table("T", ["claim", "verdict", "text"], [["a", word, f"{word} so"], ["b", None, ""]], verdict_column=1)
    page = written(tmp_path, [Section("S", tables=[table])])[1]
    (cell,) = page.marked("verdict")
    sign = {"good": "✓", "fair": "≈", "bad": "✗"}[kind]
    assert cell["text"] == f"{sign} {word}"
    assert kind in cell["class"].split()
    rows = page.all("tr")[1:]
    assert [row.get("class") for row in rows] == [kind, None]


def test_long_tables_scroll_inside_their_box(tmp_path):
    tables = [Table("T", ["a"], [[i] for i in range(count)]) for count in (5, 100)]
    boxes = written(tmp_path, [Section("S", tables=tables)])[1].marked("box")
    assert ["long" in box["class"].split() for box in boxes] == [False, True]
    assert all(box["tabindex"] == "0" for box in boxes)


def test_footer_tells_what_is_known(report):
    page = report[1]
    assert [e["text"] for e in page.all("dt")] == ["jax"]
    assert [e["text"] for e in page.all("dd")] == ["0.7"]


def test_report_of_nothing_is_a_page(tmp_path):
    page = written(tmp_path, [])[1]
    assert page.problems == []
    assert page.all("h1")[0]["text"] == "A report"
    assert not page.all("nav")


@pytest.mark.parametrize(
    ("section", "message"),
    [
        (Section("S", tables=[Table("T", ["a", "b"], [[1, 2], [1]])]), r"row 2 of table 1 \('T'\) has 1 cells"),
        (Section("S", tables=[Table("T", ["a"], [], verdict_column=1)]), r"no verdict column 1; give 0 to 0"),
        (Section("S", figures=[Figure("F")]), r"figure 1 \('F'\) shows nothing"),
        (Section("S", figures=[Figure("F", b"GIF89a")]), "its picture is no PNG; save the picture as .png"),
        (Section("S", ["[[tensoin]]"], [Table("T", ["a"], [], label="tension")]), "labelled 'tensoin'; did you mean"),
        (Section("S", tables=[Table("T", ["a"], [], label="S")], label="S"), "Section 1 and Table 1 are both labelled"),
    ],
)
def test_wrong_content_is_told(tmp_path, section, message):
    with pytest.raises(ConfigError, match=message):
        write_report(tmp_path / "report.html", "T", [], [section], {})
    assert not (tmp_path / "report.html").exists()


def test_wrong_files_are_told(tmp_path):
    (tmp_path / "file").write_text("[1]")
    for figure, message in (
        (Figure("F", tmp_path / "none.png"), "cannot read .*none.png: No such file"),
        (Figure("F", None, tmp_path / "file"), "file is no plot; write it with Figure.write_json"),
    ):
        with pytest.raises(ConfigError, match=message):
            write_report(tmp_path / "report.html", "T", [], [Section("S", figures=[figure])], {})
    with pytest.raises(ConfigError, match=r"cannot write .*; choose another folder with --out"):
        write_report(tmp_path / "file" / "report.html", "T", [], [], {})
