"""Plans: the numbers and tables of the program to the last digit; frames in, frames out; errors name arguments."""

import json
import os
import pickle
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww


def files_below(folder):
    found = {}
    for here, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(here, name)
            with open(path, encoding="utf-8", newline="") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


@pytest.fixture
def same(wearwell, tmp_path):
    """Compares a plan with what the program answers to these arguments: JSON, text, tables and page."""

    def compare(plan, *arguments, titles=None, command="plan", file="plan.json"):
        here, there = tmp_path / "here", tmp_path / "there"
        code, out, error = wearwell(*command.split(), *arguments, "-o", there)
        assert code <= 1, error
        assert plan.trusted == (code == 0)
        plan.write(here)
        here, there = files_below(here), files_below(there)
        assert here.keys() == there.keys()
        given, wanted = (json.loads(files[file]) for files in (here, there))
        assert given == plan.summary
        for key in titles or ():
            assert given.pop(key, None) != wanted.pop(key, None), key
        assert given == wanted
        if not titles:
            assert here[file] == there[file]
        assert not [name for name in here if name.startswith("tables/") and here[name] != there[name]]
        assert "--" not in str(plan).replace("---", "")
        return out

    return compare


# ---- Demonstrate.

@pytest.mark.parametrize("given, options", [
    ({"failures": "0 to 3"}, ["--failures", "0 to 3"]),
    ({"shape": 2, "specimens": 10}, ["--shape", 2, "--specimens", 10]),
    ({"shape": "1.5 to 3", "time": "2e6 cycles", "confidence": 0.95}, ["--shape", "1.5 to 3", "--time", "2e6 cycles", "--confidence", "0.95"]),
    ({"distribution": "lognormal", "sigma": 0.5, "specimens": np.int64(4), "truth": ["B10 = 2e6 cycles", "B10 = 3e6 cycles"]},
     ["--distribution", "lognormal", "--sigma", 0.5, "--specimens", 4, "--true", "B10 = 2e6 cycles", "--true", "B10 = 3e6 cycles"]),
    ({"shape": 1.5, "sudden_death": 6}, ["--shape", 1.5, "--sudden-death", 6]),
])
def test_demonstrations_are_the_programs(same, given, options):
    same(ww.plan.demonstrate("B10 >= 1e6 cycles", **given), "demonstrate", "B10 >= 1e6 cycles", *options)


def test_success_run():
    plan = ww.plan.demonstrate("reliability >= 90 % at 1e6 cycles")  # ln(1 - 0.9)/ln(0.9) = 21.85
    assert plan.summary["plans"][0]["specimens"] == 22
    frame = plan.tables["plans"]
    assert isinstance(frame, pd.DataFrame) and len(frame) == 1


def test_a_plan_is_shown_written_and_kept(tmp_path):
    plan = ww.plan.demonstrate("B10 >= 1e6 cycles", time="2e6 cycles")
    assert repr(plan) == "<wearwell.Plan 'Show B10 >= 1e6 cycles'>"
    assert "Without shape" in str(plan)  # the program says --shape
    shown = plan._repr_html_()
    assert "B10 &gt;= 1e6 cycles" in shown and "<iframe" in shown
    plan.report(tmp_path / "plan.html")
    page = (tmp_path / "plan.html").read_text()
    assert page.startswith("<!doctype html>") and "Without shape" in page
    again = pickle.loads(pickle.dumps(plan))
    assert again.summary == plan.summary and str(again) == str(plan)
    assert again.tables["plans"].equals(plan.tables["plans"])


@pytest.mark.parametrize("given, message", [
    ({"confidence": 1.5}, "confidence: '1.5' must lie above 0 %"),
    ({"confidence": [0.9]}, "confidence is a list; it is a text or a number"),
    ({"confidence": float("nan")}, "confidence is nan; a number is finite"),
    ({"sigma": 1}, "sigma: a Weibull distribution has a shape"),
    ({"distribution": "lognormal"}, "needs sigma"),
    ({"specimens": 2.5}, "specimens is 2.5; it is a whole number"),
    ({"specimens": True}, "specimens is a truth value"),
    ({"specimens": object()}, "specimens is object"),
    ({"truth": "B10 >= 2e6 cycles"}, "truth: 'B10 >= 2e6 cycles'"),
    ({"sudden_death": 6}, "sudden_death: needs shape"),
    ({"shape": 2, "time": "1 m"}, "time: '1 m'"),
])
def test_errors_name_the_argument(given, message):
    with pytest.raises(ww.InputError) as error:
        ww.plan.demonstrate("B10 >= 1e6 cycles", **given)
    assert message in str(error.value)
    assert "--" not in str(error.value)


def test_a_goal_is_refused_as_goal():
    with pytest.raises(ww.InputError, match="^goal: 'B10' states no goal"):
        ww.plan.demonstrate("B10")


# ---- Inspect.

@pytest.fixture(scope="module")
def liners():
    from conftest import source

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return ww.fit(os.path.join(source, "examples", "formula", "study.toml"), seed=1, report=False)


def test_inspections_of_a_table_are_the_programs(same, examples):
    table = os.path.join(examples, "decide", "lives.csv")
    same(ww.plan.inspect(table, risk=0.1, until="1000 h"), "inspect", table, "--risk", 0.1, "--until", "1000 h")
    costs = {"inspection_cost": "60 EUR", "failure_cost": "12000 EUR", "replacement_cost": "900 EUR"}
    options = [each for key, value in costs.items() for each in ("--" + key.replace("_", "-"), value)]
    same(ww.plan.inspect(table, new=True, **costs), "inspect", table, "--new", *options)


def test_a_frame_of_lives_is_its_file(examples):
    table = os.path.join(examples, "decide", "lives.csv")
    frame = pd.read_csv(table)
    of_file, of_frame = (ww.plan.inspect(each, risk=0.1).summary for each in (table, frame))
    assert {key: value for key, value in of_frame.items() if of_file[key] != value}.keys() <= {"lives", "title"}


def test_inspections_of_a_fit_are_the_programs(same, liners, tmp_path):
    liners.write(tmp_path / "results")
    folder = tmp_path / "results"
    unit = "1"
    given = {"force": "20 N"}
    same(ww.plan.inspect(str(folder), risk=0.05), "inspect", folder, "--risk", 0.05)
    same(ww.plan.inspect(liners, risk=0.05), "inspect", folder, "--risk", 0.05, titles=["title"])
    same(ww.plan.inspect(liners, unit=unit, given=given), "inspect", folder, "--unit", unit, "--given", "force = 20 N", titles=["title"])


def decided(same, lives, options, *about, **others):
    """ww.decide and wearwell decide say the same."""
    named = [each for key, value in options.items() for each in ("--" + key.replace("_", "-"), value)]
    same(ww.decide(lives, **{**options, **others}), *about, *named, command="decide", file="decisions.json",
         titles=["title"] if isinstance(lives, ww.Fit) else None)


def test_decisions_are_the_programs(same, liners, examples, tmp_path):
    table = os.path.join(examples, "decide", "lives.csv")
    costs = {"failure_cost": "12000 EUR", "replacement_cost": "900 EUR"}
    decided(same, table, {**costs, "month": "300 h", "months": 3, "claims": "2 %"}, table)
    folder = tmp_path / "results"
    liners.write(folder)
    read = {**costs, "inspection_cost": "60 EUR", "unit": "1", "inspect_after": "5 km"}
    named = [each for key, value in read.items() for each in ("--" + key.replace("_", "-"), value)]
    same(ww.decide(liners, **read, given={"force": "20 N"}, service_level="99 %"), folder, *named, "--given", "force = 20 N", "--service-level", 99,
         command="decide", file="decisions.json", titles=["title"])


def test_units_in_service_are_a_frame_or_a_file(same, tmp_path):
    fit = ww.life({"life [h]": [1200.0, 1500, 1900, 2300, 2600, 3100, 3600]}, "life", seed=1, method="exact", draws=100)
    fit.write(tmp_path / "results")
    ages = pd.DataFrame({"unit": ["P1", "P2"], "age [h]": [500.0, 2000.0]})
    ages.to_csv(tmp_path / "ages.csv", index=False)
    costs = {"failure_cost": 10, "replacement_cost": 1}
    for frame in (ages, tmp_path / "ages.csv"):
        decided(same, fit, costs, tmp_path / "results", "--in-service", tmp_path / "ages.csv", in_service=frame)
        same(ww.plan.inspect(fit, in_service=frame), "inspect", tmp_path / "results", "--in-service", tmp_path / "ages.csv", titles=["title"])
    with pytest.raises(ww.InputError, match="^in_service: a table of lives has its running units"):
        ww.decide({"life [h]": [1.0, 2.0]}, **costs, in_service=ages)


def test_errors_of_decisions_name_the_argument(liners):
    lives = {"life [h]": [1200.0, 1500, 1900]}
    for options, message in (({"replacement_cost": "0 EUR"}, "^replacement_cost: must be above 0"), ({"months": 0}, "^months is 0"),
                             ({"service_level": 95}, "^service_level is 95; it is a share below 1"), ({"unit": "1"}, "^unit and inspect_after go together"),
                             ({"downtime_cost": "1 EUR/h"}, "^downtime_cost: .* it needs inspection_cost"), ({"month": "1 h"}, "^month: there is no running unit")):
        with pytest.raises(ww.InputError, match=message):
            ww.decide(lives, **{"failure_cost": "10 EUR", "replacement_cost": "1 EUR", **options})
    with pytest.raises(ww.InputError, match="^in_service: the units of this study are followed by their readings"):
        ww.decide(liners, failure_cost=10, replacement_cost=1, in_service={"unit": ["a"], "age [km]": [1.0]})
    with pytest.raises(ww.InputError, match="^lives is Study"):
        ww.decide(liners.study, failure_cost=10, replacement_cost=1)


def test_errors_of_inspections_name_the_argument(liners, examples):
    table = os.path.join(examples, "decide", "lives.csv")
    with pytest.raises(ww.InputError, match="^total_risk: needs warning"):
        ww.plan.inspect(table, total_risk=0.01)
    with pytest.raises(ww.InputError, match="^new: is for a new unit; leave out unit"):
        ww.plan.inspect(table, new=True, unit="P2")
    with pytest.raises(ww.InputError, match="new is a number; it is true or false"):
        ww.plan.inspect(table, new=1)
    with pytest.raises(ww.InputError, match="^lives is Study"):
        ww.plan.inspect(liners.study)
    with pytest.raises(ww.InputError, match="lives"):
        ww.plan.inspect({"age [h]": [1.0, 2.0]})
    with pytest.raises(ww.InputError, match="did you mean"):
        ww.plan.inspect(table, unit="P22")
    with pytest.raises(ww.InputError, match="no/such"):
        ww.plan.inspect("no/such")
    with pytest.raises(ww.InputError, match="fleet.toml: questions about the units of a monitor are for the command line"):
        ww.plan.inspect("fleet.toml")


def test_other_threads_and_an_exception_in_progress(liners):
    one, all_of_them = (ww.plan.inspect(liners, risk=0.05, threads=n) for n in (1, 0))
    assert one.json == all_of_them.json
    with pytest.raises(ww.InputError, match="threads is -1"):
        ww.plan.inspect(liners, threads=-1)


# ---- Accelerate.

accelerated = {"use": "50 degC", "highest": "120 degC", "until": "183 d", "specimens": 300, "failing_at_use": "0.1 %"}
options = ["accelerate", "--use", "50 degC", "--highest", "120 degC", "--until", "183 d", "--specimens", 300, "--failing-at-use", "0.1 %"]


def test_accelerated_tests_are_the_programs(same):
    same(ww.plan.accelerate(**accelerated, sigma=0.6, failing_at_highest=0.9), *options, "--sigma", 0.6, "--failing-at-highest", 0.9)
    same(ww.plan.accelerate(**accelerated, shape="1.4 to 2", activation_energy="0.65 to 0.8 eV", middle_share=0.25),
         *options, "--shape", "1.4 to 2", "--activation-energy", "0.65 to 0.8 eV", "--middle-share", 0.25)


def test_accelerated_tests_have_stop_times_by_level(same):
    plan = ww.plan.accelerate(**accelerated, relation="eyring", sigma=0.6, activation_energy="0.7 eV", stop=["366 d", "183 d", "92 d"])
    same(plan, *options, "--relation", "eyring", "--sigma", 0.6, "--activation-energy", "0.7 eV", "--stop", "366 d, 183 d, 92 d")
    assert [level["until"] for level in plan.summary["plans"][0]["levels"]] == pytest.approx([366, 92])
    with pytest.raises(ww.InputError, match="^stop: '366 d' has 1 time; it has three"):
        ww.plan.accelerate(**accelerated, sigma=0.6, failing_at_highest=0.9, stop="366 d")


def test_errors_of_accelerated_tests_name_the_argument():
    with pytest.raises(ww.InputError, match="^shape, sigma: give one of them"):
        ww.plan.accelerate(**accelerated)
    with pytest.raises(ww.InputError, match="^exponent: belongs to relation inverse-power, not arrhenius"):
        ww.plan.accelerate(**accelerated, sigma=0.6, activation_energy="0.7 eV", exponent=4)
    with pytest.raises(ww.InputError, match="^life_at_highest and failing_at_highest say the same"):
        ww.plan.accelerate(**accelerated, sigma=0.6, failing_at_highest=0.9, life_at_highest="60 d")
    with pytest.raises(ww.InputError, match="^use: '200 degC' must be below highest '120 degC'"):
        ww.plan.accelerate(**{**accelerated, "use": "200 degC"}, sigma=0.6, failing_at_highest=0.9)


# ---- Next.

goal = "B10 at softer spring"


@pytest.fixture(scope="module")
def springs():
    from conftest import source

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return ww.fit(os.path.join(source, "examples", "spring", "sensible.toml"), seed=1, report=False)


@pytest.fixture(scope="module")
def candidates():
    return pd.DataFrame({"alternating_stress_MPa": [230.0, 260.0, 290.0], "mean_stress_MPa": 1000.0, "stop [cycles]": [5e5, 3e5, 2e5],
                         "cost [EUR]": [900, 500, 300]})


@pytest.fixture
def results(springs, tmp_path):
    springs.write(tmp_path / "results")
    return tmp_path / "results"


def test_next_tests_are_the_programs(same, springs, candidates, results, tmp_path):
    table = tmp_path / "tests.csv"
    candidates.to_csv(table, index=False)
    options = ["next", results, "--goal", goal, "--candidates", table, "--cost", "cost"]
    plan = ww.plan.next(results, goal, candidates=table, cost="cost")
    same(plan, *options)
    of_frame = ww.plan.next(springs, goal, candidates=candidates, cost="cost")
    assert of_frame.summary["candidates"] == plan.summary["candidates"]
    assert of_frame.tables["candidates"].equals(plan.tables["candidates"])
    assert len(plan.tables["candidates"]) == 3


def test_next_tests_by_loss(same, springs, candidates, results, tmp_path):
    table = tmp_path / "tests.csv"
    candidates.to_csv(table, index=False)
    plan = ww.plan.next(results, goal, candidates=table, cost="cost", by="loss", failure_cost="20 EUR", replacement_cost="1 EUR",
                        fleet_use="1e10 cycles", nodes=200)
    same(plan, "next", results, "--goal", goal, "--candidates", table, "--cost", "cost", "--by", "loss", "--failure-cost", "20 EUR",
         "--replacement-cost", "1 EUR", "--fleet-use", "1e10 cycles", "--nodes", 200)
    with pytest.raises(ww.InputError, match="^replacement_cost is missing: by loss needs failure_cost"):
        ww.plan.next(springs, goal, candidates=candidates, cost="cost", by="loss", failure_cost=3)


def test_grids_batches_and_several_specimens(same, springs, results):
    grid = "alternating_stress_MPa = 230 to 290 by 20; mean_stress_MPa = 1000; stop = 5e5 cycles"
    text = ww.plan.next(results, goal, grid=grid, specimens=[1, 3], batch=2, samples=64, nodes=200, seed=7)
    same(text, "next", results, "--goal", goal, "--grid", grid, "--specimens", "1, 3", "--batch", 2, "--samples", 64, "--nodes", 200,
         "--seed", 7)
    named = ww.plan.next(springs, goal, grid={"alternating_stress_MPa": [230, 250, 270, 290], "mean_stress_MPa": 1000, "stop": "5e5 cycles"},
                         specimens=[1, 3], batch=2, samples=64, nodes=200, seed=7, threads=1)
    assert named.summary["candidates"] == text.summary["candidates"]


def test_tests_that_were_done(same, springs, results, candidates, tmp_path):
    done = pd.DataFrame({"type": ["H"], "normalized_displacement_mean": [np.nan], "normalized_displacement_amplitude": [np.nan],
                         "life_normalized": [1.1], "mean_stress_MPa": [1000.0], "alternating_stress_MPa": [250.0]})
    log = tmp_path / "log.csv"
    done.to_csv(log, index=False)
    table = tmp_path / "tests.csv"
    candidates.to_csv(table, index=False)
    options = {"candidates": table, "cost": "cost", "until": "width <= factor 1.5"}
    of_file = ww.plan.next(results, goal, tests=log, **options)
    same(of_file, "next", results, "--goal", goal, "--candidates", table, "--cost", "cost", "--tests", log, "--until", "width <= factor 1.5")
    assert of_file.summary["candidates"] == ww.plan.next(springs, goal, tests=[done], **options).summary["candidates"]
    assert of_file.summary["candidates"] != ww.plan.next(springs, goal, **options).summary["candidates"]


def test_errors_of_next_tests_name_the_argument(springs, candidates):
    def refused(message, *arguments, **options):
        with pytest.raises(ww.InputError) as error:
            ww.plan.next(springs, *arguments, **options)
        assert message in str(error.value)
        assert "--" not in str(error.value)

    refused("goal: the study has no", "B10 at hanger", candidates=candidates)
    refused("grid: 'stress'", goal, grid="stress")
    refused("by: 'size' must be variance, information or loss", goal, candidates=candidates, by="size")
    refused("cost: candidates has no column 'price'", goal, candidates=candidates, cost="price")
    refused("specimen_cost", goal, candidates=candidates, specimen_cost=-1)
    refused("batch is 2.5; it is a whole number", goal, candidates=candidates, batch=2.5)
    refused("seed is", goal, candidates=candidates, seed=-1)
    refused("candidates, row 2", goal, cost="cost", candidates=candidates.assign(**{"alternating_stress_MPa": [230.0, np.nan, 290.0]}))
    with pytest.raises(ww.InputError, match="^fit is DataFrame; it is a fit"):
        ww.plan.next(candidates, goal)


# ---- Size.

priors = """
title = "Wear of a liner"
model = "formula"
[data]
file = "not-measured-yet.csv"
[data.columns]
wear = { column = "V", unit = "mm^3" }
force = { column = "F", unit = "N" }
distance = { column = "s", unit = "m" }
[likelihood.wear]
family = "normal"
mean = "k * force * distance"
sd = "sigma"
[prior]
k = { distribution = "lognormal", median = "1e-7 mm^3/(N m)", log_sd = 1 }
sigma = { distribution = "lognormal", median = "0.1 mm^3", log_sd = 0.3 }
"""
size_options = {"width": "factor 1.3", "simulations": 20, "most": 40, "seed": 3}


def test_sizes_are_the_programs(same, tmp_path):
    study, tests = tmp_path / "study.toml", tmp_path / "tests.csv"
    study.write_text(priors)
    frame = pd.DataFrame({"F [N]": [100.0, 200.0], "s [m]": [4e4, 4e4], "specimens": [1, 2]})
    frame.to_csv(tests, index=False)
    plan = ww.plan.size(study, "k", tests=tests, **size_options)
    same(plan, "size", study, "--goal", "k", "--tests", tests, "--width", "factor 1.3", "--simulations", 20, "--most", 40, "--seed", 3)
    assert ww.plan.size(study, "k", tests=frame, **size_options).summary == plan.summary
    seen = []
    ww.plan.size(study, "k", tests=frame, **size_options, progress=lambda what, done, total, seconds: seen.append(total))

    def stop(*_):
        raise ZeroDivisionError

    if seen:  # it took long enough for a report
        with pytest.raises(ZeroDivisionError):
            ww.plan.size(study, "k", tests=frame, **size_options, progress=stop)


def test_errors_of_sizes_name_the_argument(tmp_path):
    study = tmp_path / "study.toml"
    study.write_text(priors)
    tests = {"F [N]": [100.0], "s [m]": [4e4]}
    with pytest.raises(ww.InputError, match="^width: 'factor 0.5'"):
        ww.plan.size(study, "k", tests=tests, width="factor 0.5")
    with pytest.raises(ww.InputError, match="^simulations is 5; it is a whole number from 20 to 100000"):
        ww.plan.size(study, "k", tests=tests, width="factor 2", simulations=5)
    with pytest.raises(ww.InputError, match="^tests is missing"):
        ww.plan.size(study, "k", width="factor 2", tests=None)
    with pytest.raises(ww.InputError, match="^study is DataFrame; it is a study, or the path of a study file"):
        ww.plan.size(pd.DataFrame(tests), "k", width="factor 2", tests=tests)
