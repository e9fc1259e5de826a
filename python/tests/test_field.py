"""Units that are repaired, warranty returns, and lives of two fits against each other: one line each, and the program's numbers."""

import json
import os
import subprocess
import tomllib

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import binary, source

quick = {"method": "exact", "draws": 50, "chains": 2, "report": False}


def table_of(path):
    return pd.read_csv(os.path.join(source, "examples", *path.split("/")))


def study_of(path):
    return tomllib.loads(open(os.path.join(source, "examples", *path.split("/"))).read())


def refusal(function, *arguments, **options):
    with pytest.raises(ww.InputError) as error:
        function(*arguments, **quick, **options)
    return str(error.value)




def repairs(frame, event="event", **options):
    return ww.repairable(frame, "age", unit="engine", event=event, units={"age": "day"}, **options, **quick)


@pytest.fixture(scope="module")
def valve_seats():
    return repairs(table_of("repairable/valve_seats.csv"), rounding="1 day", at="600 day", ahead="100 day")


def test_repairs_in_one_line_are_those_of_the_study_file(valve_seats):
    own = ww.fit(os.path.join(source, "examples", "repairable", "study.toml"), **quick)  # its priors are the defaults
    assert valve_seats.results["parameters"].keys() == own.results["parameters"].keys()
    for name, found in own.results["parameters"].items():
        assert valve_seats.results["parameters"][name]["q50"] == pytest.approx(found["q50"], rel=1e-12)
    assert valve_seats.results["repairable"]["forecast"] == own.results["repairable"]["forecast"]


@pytest.mark.parametrize("event", [
    lambda frame: frame["event"] == "failure", lambda frame: (frame["event"] == "failure").astype(int),
    lambda frame: frame["event"].map({"failure": 1, "end": -1}), lambda frame: frame["event"].map({"failure": "repair", "end": "end"})])
def test_events_of_all_kinds_are_the_same_repairs(valve_seats, event):
    frame = table_of("repairable/valve_seats.csv")
    found = repairs(frame.assign(event=event(frame)), rounding="1 day", at="600 day", ahead="100 day")
    assert found.results["parameters"] == valve_seats.results["parameters"]


def test_words_of_the_table_and_refusals_of_repairs(valve_seats):
    frame = table_of("repairable/valve_seats.csv")
    spanish = frame.assign(event=frame["event"].map({"failure": "cambio", "end": "hoy"}))
    found = repairs(spanish, {"column": "event", "failure": "cambio", "end": "hoy"}, rounding="1 day", at="600 day", ahead="100 day")
    assert found.results["parameters"] == valve_seats.results["parameters"]
    assert "the key 'runout'" in refusal(ww.repairable, frame, "age", unit="engine", event={"column": "event", "runout": 0})
    assert "process is 'power'" in refusal(ww.repairable, frame, "age", unit="engine", event="event", process="power")
    assert "no column 'engin'" in refusal(ww.repairable, frame, "age", unit="engin", event="event")
    censored = frame.assign(censored=(frame["event"] == "end").astype(int))
    said = refusal(ww.repairable, censored, "age", unit="engine", event="censored", units={"age": "day"})
    assert "{'column': 'censored', 'failure': 0}" in said and "{'column': 'censored', 'failure': 1}" in said
    assert "ahead" in refusal(ww.repairable, frame, "age", unit="engine", event="event", units={"age": "day"}, rounding="1 day", ahead="-3 day")


def test_delayed_fixes_in_one_line_are_those_of_the_study_file():
    study = study_of("repairable/delayed_fixes.toml")
    frame = table_of("repairable/delayed_fixes.csv")
    fixes = {**{each: "none" for each in study["fixes"]["none"]}, **{each: "during" for each in study["fixes"]["during"]}, **study["fixes"]["effectiveness"]}

    def projected(fixes, mode="mode", **_):  # further options are those of `refusal`
        return ww.repairable(frame, "test time", unit="system", event="event", mode=mode, fixes=fixes, priors=study["prior"], classical=True,
                             predict={"level": 0.9, "sides": "both"}, **quick).results["repairable"]["projection"]

    own = ww.fit(os.path.join(source, "examples", "repairable", "delayed_fixes.toml"), **quick)
    found = projected(fixes)
    assert found == own.results["repairable"]["projection"]
    uncertain = projected({**fixes, "BD1": {"distribution": "beta", "alpha": 67, "beta": 33}})  # of the same mean
    assert uncertain["mean_effectiveness"] == pytest.approx(found["mean_effectiveness"], rel=1e-5)
    assert "BD1: is 1.4" in refusal(projected, {**fixes, "BD1": 1.4})
    assert "BD1 is 'later'" in refusal(projected, {**fixes, "BD1": "later"})
    assert "BD1 is True" in refusal(projected, {**fixes, "BD1": True})
    assert "does not name mode 'BD3'" in refusal(projected, {each: fix for each, fix in fixes.items() if each != "BD3"})
    assert "names mode 'BD99'" in refusal(projected, {**fixes, "BD99": 0.4})
    assert "mode needs fixes" in refusal(projected, None)
    assert "mode needs fixes" in refusal(projected, fixes, None)
    assert "no column 'mod'" in refusal(projected, fixes, "mod")


triangle = table_of("warranty/returns.csv")


def test_returns_in_one_line_are_those_of_the_study_file():
    planned = table_of("warranty/planned_sales.csv")
    study = study_of("warranty/study.toml")
    of_file = ww.fit(os.path.join(source, "examples", "warranty", "study.toml"), **quick)
    found = ww.returns(triangle, sold="sold", quantity="shipped", warranty="36 month", cost_per_return="180 EUR", planned_sales=planned,
                       survival_to="36 month", priors={"characteristic": study["prior"]["characteristic"]}, **quick)
    for name, each in of_file.results["parameters"].items():
        assert found.results["parameters"][name]["q50"] == pytest.approx(each["q50"], rel=1e-12)
    assert found.results["returns"]["forecast"] == of_file.results["returns"]["forecast"]


def test_single_units_with_dates_of_pandas_are_those_of_texts():
    units = table_of("warranty/units.csv").head(3000)
    dates = units.assign(**{each: pd.to_datetime(units[each]) for each in ("sale date", "failure date")})
    of = dict(sold="sale date", returned="failure date", until="2025-12", ahead="6 month", family="exponential")
    texts, found = (ww.returns(frame, **of, **quick) for frame in (units, dates))
    assert found.results["parameters"] == texts.results["parameters"]
    assert 'median = "500 month"' in found.study.toml  # ten times two years, rounded up


def test_periods_as_headings_and_delays_as_tables():
    months = pd.PeriodIndex(list(triangle.columns[2:]), freq="M")
    renamed = triangle.set_axis([*triangle.columns[:2], *months], axis=1)
    delays = pd.DataFrame({"delay [month]": [0, 0.5, 2], "share": [0.6, 0.3, 0.1]})
    of = dict(warranty="36 month", family="exponential", delay_of_report=delays)
    assert ww.returns(renamed, **of, **quick).results["parameters"] == ww.returns(triangle, **of, **quick).results["parameters"]
    assert "it has two, delays" in refusal(ww.returns, triangle, delay_of_report=delays.assign(third=1))
    assert "no column 'sale'" in refusal(ww.returns, triangle, sold="sale")
    assert "family is 'weibul'" in refusal(ww.returns, triangle, family="weibul")
    assert "sold is missing" in refusal(ww.returns, table_of("warranty/units.csv"), returned="failure date")
    unknown = pd.DataFrame({"sold": ["x1", "x2"], "returned": ["x2", None]})
    assert "priors: no default" in refusal(ww.returns, unknown, sold="sold", returned="returned")


@pytest.fixture(scope="module")
def two_makes():
    rng = np.random.default_rng(5)
    makes = [{"hours": np.round(scale * rng.weibull(2, 12), 1)} for scale in (900, 600)]
    return [ww.life(each, "hours", units={"hours": "h"}, **quick) for each in makes]


def test_lives_of_two_fits_are_those_of_the_program(two_makes, tmp_path):
    new, old = two_makes
    new.write(tmp_path / "new")
    old.write(tmp_path / "old")
    command = [binary, "life", "new", "--against", "old", "--horizon", "300 h", "--confidence", "95 %", "--json"]
    printed = json.loads(subprocess.run(command, cwd=tmp_path, capture_output=True, check=True).stdout)
    in_memory = new.against(old, horizon="300 h", confidence="95 %")
    of_folder = new.against(tmp_path / "old", horizon="300 h", confidence=0.95)
    for found in (in_memory, of_folder):
        for key in ("outlives", "ratios", "survival_difference", "confidence"):
            assert found.summary[key] == printed[key]
    assert in_memory.outlives == printed["outlives"]["mean"] and in_memory.title == "fit, unit against other, unit"
    assert list(in_memory.differences.index) == ["B1 ratio", "B10 ratio", "B50 ratio", "outlives", "survival difference"]
    # The other way round everything is turned.
    back = old.against(new, horizon="300 h")
    assert back.outlives == pytest.approx(1 - in_memory.outlives, abs=1e-3)
    assert back.differences.loc["B10 ratio", "q50"] == pytest.approx(1 / in_memory.differences.loc["B10 ratio", "q50"], rel=0.02)
    assert "at least, 95 %" in str(in_memory)


def test_what_cannot_be_compared_is_refused_in_arguments(two_makes, valve_seats):
    new, old = two_makes
    for wrong, said in ((valve_seats, "no life of a new unit"), ({"hours": [1.0]}, "other is dict"), ("nowhere", "nowhere")):
        with pytest.raises(ValueError if wrong != "nowhere" else (ww.InputError, FileNotFoundError), match=said):
            new.against(wrong)
    with pytest.raises(ww.InputError, match="^horizon"):
        new.against(old, horizon="3 kg")
    with pytest.raises(ww.InputError, match="^confidence"):
        new.against(old, confidence=1.5)
    with pytest.raises(ww.InputError, match="at"):
        new.against(old, at="nothing")


def test_counts_are_failures_of_one_age(valve_seats):
    frame = table_of("repairable/valve_seats.csv")
    keys = list(frame.columns)
    counted = frame.groupby(keys, sort=False).size().rename("n").reset_index()
    assert counted["n"].max() == 2  # two failures at one age
    found = repairs(counted, count="n", rounding="1 day", at="600 day", ahead="100 day")
    assert found.results["repairable"]["failures"] == valve_seats.results["repairable"]["failures"]
    for name, own in valve_seats.results["parameters"].items():
        assert found.results["parameters"][name]["q50"] == pytest.approx(own["q50"], rel=1e-9)
    with pytest.warns(ww.CheckWarning, match="column 'n' looks like a number of equal rows and is not used: write count=\"n\""):
        repairs(counted, rounding="1 day")
    assert "column 'n': 1.5 ends of observation of one unit" in refusal(ww.repairable, counted.assign(n=1.5), "age", unit="engine", event="event", count="n", units={"age": "day"})


def test_grouped_counts_are_those_of_the_study_file():
    frame = table_of("repairable/grouped.csv")
    arguments = dict(unit="helicopter", count="count", grouped=True, units={"age": "h"}, **quick)
    priors = study_of("repairable/grouped.toml")["prior"]
    found = ww.repairable(frame, "age", classical=True, ahead="20 h", predict={"level": 0.9, "sides": "both"}, priors=priors, **arguments)
    own = ww.fit(os.path.join(source, "examples", "repairable", "grouped.toml"), **quick)
    assert found.results["classical"] == own.results["classical"]
    assert found.results["repairable"]["tests"]["chi_square"]["statistic"] == pytest.approx(5.45, abs=0.005)  # MIL-HDBK-189: 5.5
    assert "event is missing" in refusal(ww.repairable, frame, "age", unit="helicopter", count="count")
    assert "grouped needs count" in refusal(ww.repairable, frame, "age", unit="helicopter", grouped=True)
    assert "grouped is 1" in refusal(ww.repairable, frame, "age", unit="helicopter", count="count", grouped=1)
