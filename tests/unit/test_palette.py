"""Colours that stand together can be told apart by everybody, and text can be read.

If one of these failed, one man in twelve would take one thruster for another, or the start for what came after it.
"""

import itertools
import re
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

from tethership.view import style
from tethership.view.campaign.figures import plot_peaks
from tethership.view.report.page_file import page_text

LEAST = 12.0
"""Least distance of two colours, CIEDE2000: some five times what is just seen side by side."""

READABLE = 4.5
"""Least contrast of text (WCAG 2.2, 1.4.3)."""

SEEN = 2.2
"""Least contrast of a line on white; those below 3 are ships that are named and the lightest of a scale."""

EYES = {
    "normal": np.eye(3),
    "protanope": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranope": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanope": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
"""What reaches an eye of linear red, green and blue: Machado, Oliveira & Fernandes (2009), severity 1."""

TOGETHER = {
    "series: thrusters, cables, angles": style.SERIES,
    "the ship on its cables": (style.START, style.BETWEEN, style.END, *style.SERIES[:3]),
    "tensions watched, over two cables": (*style.LIMITS, style.SERIES[0]),
    "two flights": style.FLIGHTS,
    "throttles of a trim": (style.SERIES[0], style.LACKING),
    "tension of a cable in space": style.TENSION,
    "arrows in space": tuple(style.ARROWS.values()),
}


def linear(colour):
    """Return a colour #RRGGBB as linear red, green and blue."""
    parts = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)


XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
"""From linear red, green and blue to CIE XYZ (sRGB, D65)."""


def lab(colour, eye="normal"):
    """Return a colour as an eye has it, in CIE L*a*b* (D65)."""
    ratio = XYZ @ np.clip(np.array(EYES[eye]) @ linear(colour), 0.0, 1.0) / XYZ.sum(axis=1)
    root = np.where(ratio > (6 / 29) ** 3, np.cbrt(ratio), ratio / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.array([116 * root[1] - 16, 500 * (root[0] - root[1]), 200 * (root[1] - root[2])])


def distance(first, second):
    """Return the colour difference CIEDE2000 of two colours in L*a*b* (Sharma, Wu & Dalal, 2005)."""
    (l1, a1, b1), (l2, a2, b2) = first, second
    mean = 0.5 * (np.hypot(a1, b1) + np.hypot(a2, b2))
    stretch = 1.5 - 0.5 * np.sqrt(mean**7 / (mean**7 + 25.0**7))
    z1, z2 = complex(stretch * a1, b1), complex(stretch * a2, b2)
    c1, c2 = abs(z1), abs(z2)
    turn = np.angle(z2 * z1.conjugate()) if c1 * c2 else 0.0
    hue = np.degrees(np.angle(z1)) % 360.0 + 0.5 * np.degrees(turn) if c1 * c2 else np.degrees(np.angle(z1 + z2))
    light, chroma = 0.5 * (l1 + l2), 0.5 * (c1 + c2)
    waves = ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))
    t = 1.0 + sum(size * np.cos(np.radians(n * hue + shift)) for size, n, shift in waves)
    by_light = (l2 - l1) / (1.0 + 0.015 * (light - 50.0) ** 2 / np.sqrt(20.0 + (light - 50.0) ** 2))
    by_chroma = (c2 - c1) / (1.0 + 0.045 * chroma)
    by_hue = 2.0 * np.sqrt(c1 * c2) * np.sin(0.5 * turn) / (1.0 + 0.015 * chroma * t)
    slant = 60.0 * np.exp(-((((hue % 360.0) - 275.0) / 25.0) ** 2))
    mixed = -2.0 * np.sqrt(chroma**7 / (chroma**7 + 25.0**7)) * np.sin(np.radians(slant))
    return float(np.sqrt(by_light**2 + by_chroma**2 + by_hue**2 + mixed * by_chroma * by_hue))


def contrast(first, second="#FFFFFF"):
    """Return the contrast ratio of two colours (WCAG 2.2)."""
    low, high = sorted(XYZ[1] @ linear(colour) for colour in (first, second))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize(
    ("first", "second", "published"),
    [
        ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
        ((50.0, -1.3802, -84.2814), (50.0, 0.0, -82.7485), 1.0),
        ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
        ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
        ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
    ],
)
def test_the_distance_is_the_published_one(first, second, published):
    """Pairs of the table of Sharma, Wu & Dalal (2005)."""
    assert distance(first, second) == pytest.approx(published, abs=1e-4)


@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize("group", TOGETHER)
def test_colours_together_are_told_apart(group, eye):
    for first, second in itertools.combinations(TOGETHER[group], 2):
        assert distance(lab(first, eye), lab(second, eye)) >= LEAST, (first, second)


def test_the_test_can_fail():
    """The colours of version 0.1: start and what came after it, two thrusters, the first limit and the second."""
    for first, second in (("#009E73", "#8C8C8C"), ("#E69F00", "#CC79A7"), ("#8C510A", "#D55E00")):
        assert min(distance(lab(first, eye), lab(second, eye)) for eye in EYES) < LEAST


def test_lines_are_seen_on_white():
    thin = {*style.SERIES, *style.LIMITS, style.START, style.END}
    assert min(map(contrast, thin)) >= 3.0
    assert contrast(style.BETWEEN) >= SEEN


def test_colour_is_never_the_only_sign():
    count = len(style.SERIES)
    assert len({style.dash(i) for i in range(count)}) == count
    assert len({style.mark(i) for i in range(count)}) == count


def colours_of(name, folder="report"):
    """Return the custom properties of a style."""
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", page_text(folder, name)))


def test_text_of_the_pages_is_read():
    """Words on white, and on the panels' tints."""
    palette = colours_of("palette.css")
    for name in ("ink", "soft", "link", "good", "fair", "bad"):
        for ground in ("#ffffff", palette["faint"], "#fbfbfa"):
            assert contrast(palette[name], ground) >= READABLE, name
    assert min(map(contrast, style.LIMITS)) >= READABLE
    assert contrast(palette["bad"], "#fcf1f2") >= READABLE
    assert contrast(palette["fair"], "#fdf8ec") >= READABLE


@pytest.mark.parametrize("given", [False, True])
def test_one_style_holds_whatever_the_callers_is(given):
    """Sizes and colours of text and grid are the sheet's when the picture is saved, and the caller's style stays."""
    peaks = {"one": np.linspace(100.0, 900.0, 50)}
    with matplotlib.rc_context({"font.size": 21.0, "axes.grid": False, "text.color": "red", "grid.color": "red"}):
        before = dict(matplotlib.rcParams)
        axes = plot_peaks(peaks, {"tear": 481.0}, Figure().subplots() if given else None)
        assert dict(matplotlib.rcParams) == before
        axes.figure.canvas.draw()
    assert {text.get_fontsize() for text in axes.texts} == {style.SMALL}
    for axis in (axes.xaxis, axes.yaxis):
        assert axis.label.get_fontsize() == style.SHEET["font.size"]
        assert {label.get_fontsize() for label in axis.get_ticklabels(which="both")} == {style.SMALL}
        assert {line.get_color() for line in axis.get_gridlines()} == {style.GUIDE}
        assert all(line.get_visible() for line in axis.get_gridlines())


def test_sizes_stand_in_the_sheet_alone():
    """No picture has a size of text of its own: the sheet has them all, and `style` what differs on purpose."""
    named = {"style.SMALL", "style.LARGE", '"medium"'}
    for path in Path(style.__file__).parents[1].rglob("*.py"):
        found = re.findall(r"(?:fontsize|labelsize|titlesize)=([^,)\n]+)", path.read_text(encoding="utf-8"))
        assert set(found) <= named or path.name == "style.py", path
