"""The line chosen by name, apart from the formulation; names that stand for all items of a list, or for a component."""

import json

import numpy as np
import pytest

import tethership as ts
from tethership.physics.cable import ElasticCatenary, PublishedTension

KINDS = {"catenary": ElasticCatenary, "published": PublishedTension}


@pytest.mark.parametrize("formulation", ["consistent", "published"])
@pytest.mark.parametrize("line", [None, "catenary", "published"])
def test_the_formulation_sets_only_what_is_left_out(formulation, line):
    changes = {"formulation": formulation} | ({} if line is None else {"cables.nose.line.model": line})
    scenario = ts.load_scenario("docking", changes)
    wanted = line or {"consistent": "catenary", "published": "published"}[formulation]
    assert isinstance(scenario.system.cables[0].law, KINDS[wanted])
    assert scenario.config.line_models() == {"nose": {"model": wanted}}


def test_a_line_by_name_is_the_line_of_its_formulation():
    named = ts.load_scenario("docking", {"cables.nose.line.model": "published"})
    own = ts.load_scenario("docking", {"formulation": "published"})
    first, second = (scenario.system.cables[0] for scenario in (named, own))
    span = np.array([-14.0, 0.0, -14.0])
    forces = [cable.law.force(span, cable.length, np.array([0.1, 0.0, 0.8])).ship for cable in (first, second)]
    assert np.array_equal(*forces)
    assert type(named.system.ship.envelope) is not type(own.system.ship.envelope)


def test_cables_have_lines_of_their_own():
    scenario = ts.load_scenario("three_lines")
    names = [cable.name for cable in scenario.config.cables]
    mixed = scenario.changed({f"cables.{names[0]}.line.model": "published"})
    assert [type(cable.law) for cable in mixed.system.cables] == [
        PublishedTension,
        *[ElasticCatenary] * (len(names) - 1),
    ]


def test_the_option_line(command):
    code, out, _ = command("trim", "--formulation", "published", "--line", "catenary", "--json")
    told = json.loads(out)
    assert (code, told["line"], told["formulation"]) == (0, {"nose": {"model": "catenary"}}, "published")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("trim", "--line", "catenry"), "did you mean 'catenary'?"),
        (("trim", "hover", "--line", "catenary"), "needs a cable, and hover has none"),
        (("campaign", "gusts", "--line", "rope"), "is no line"),
        (("trim", "--set", "cables.nose.line.model=rope"), "one of 'catenary', 'published'"),
        (("trim", "--set", "cables.nose.line.model=catenry"), "did you mean 'catenary'?"),
        (("trim", "--set", "vehicle.*.mass=3"), "vehicle is no list; * stands for the items of one"),
        (("trim", "hover", "--set", "cables.*.length=3"), "cables is no list"),
        (("trim", "--set", "cables.nose.anchor.7=3"), "there is no component 7; they are 0 to 2"),
        (("trim", "--set", "cables.nose.anchor.1=x"), "is no number"),
        (("trim", "--set", "cables.nose.anchor.1=3kg"), "'kg'"),
        (("trim", "--set", "gusts=3"), "gusts: it is"),
        (("trim", "--set", "wind=3"), "wind"),
    ],
)
def test_wrong_lines_and_names(command, words, said):
    code, out, err = command(*words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err


def test_a_star_sets_all_items_and_a_number_one_component():
    scenario = ts.load_scenario("docking", {"vehicle.thrusters.*.lag": 0.3, "cables.nose.anchor.2": -1.0})
    assert {thruster.lag for thruster in scenario.config.vehicle.thrusters} == {0.3}
    assert scenario.config.cables[0].anchor == (0.0, 0.0, -1.0)
    inches = scenario.changed({"cables.nose.tether_point.0": {"value": 80.0, "unit": "cm"}})
    before, after = (one.config.cables[0].tether_point for one in (scenario, inches))
    assert after == pytest.approx((0.8, before[1], before[2]))
