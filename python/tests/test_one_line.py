"""One line for a table: what studies it makes, their numbers beside other programs, and what is refused."""

import copy
import functools
import json
import os
import pickle
import tomllib
import warnings
from decimal import Decimal

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import source

here = os.path.join(os.path.dirname(__file__), "peers")
pumps = pd.read_csv(os.path.join(here, "pumps.csv"))
units = {"hours": "h"}
wear = pd.DataFrame({"machine": ["A"] * 4 + ["B"] * 4 + ["C"] * 4, "km": [10.0, 20, 30, 40] * 3,
                     "wear": [11.0, 19, 32, 41, 14, 31, 44, 58, 9, 17, 24, 33]})


def table_of(path):
    return pd.read_csv(os.path.join(source, "examples", *path.split("/")))


@functools.lru_cache(maxsize=None)
def _fitted(function, arguments, options):
    data = {"pumps": pumps, "counts": pd.DataFrame({"hours": [300, 500, 700], "failed": [1, 1, 0], "count": [4, 6, 20]}), "bearings": table_of("life/bearings.csv"), "devices": table_of("accelerated/device_a.csv"), "wear": wear}
    name, *rest = arguments
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return getattr(ww, function)(data[name], *rest, method="exact", draws=50, chains=2, report=False,
                                     **{k: dict(v) if isinstance(v, tuple) and v and isinstance(v[0], tuple) else v for k, v in options})


def fitted(function, *arguments, **options):
    """A fit, made once for all tests."""
    return _fitted(function, arguments, tuple((k, tuple(v.items()) if isinstance(v, dict) else v) for k, v in options.items()))


def refusal(function, *arguments, **options):
    with pytest.raises(ww.InputError) as error:
        function(*arguments, report=False, **options)
    return str(error.value)


# ---- Numbers beside other programs: maximum likelihood estimates by R's survival, peers/peers.R.

peers = pd.read_csv(os.path.join(here, "peers.csv")).set_index(["task", "parameter"])["value"]
tasks = {
    "complete": ("bearings", "million_revolutions", {}),
    "censored": ("pumps", "hours", {"event": "failed"}),
    "lognormal": ("pumps", "hours", {"event": "failed", "family": "lognormal"}),
    "loglogistic": ("pumps", "hours", {"event": "failed", "family": "loglogistic"}),
    "exponential": ("pumps", "hours", {"event": "failed", "family": "exponential"}),
    "interval": ("pumps", ("last_ok", "first_failed"), {"unused": "failed"}),
    "entry": ("pumps", "hours", {"event": "failed", "entry": "since"}),
    "counts": ("counts", "hours", {"event": "failed", "count": "count"}),
    "groups": ("pumps", "hours", {"event": "failed", "by": "supplier"}),
    "arrhenius": ("devices", "hours", {"event": "status", "count": "count", "family": "lognormal", "stress": {"temperature_C": "arrhenius"},
                                       "units": {"temperature_C": "degC"}}),
}


@pytest.mark.parametrize("task", tasks)
def test_with_flat_priors_the_mode_is_the_estimate_of_survreg(task):
    data, life, options = tasks[task]
    mode = fitted("life", data, life, priors="flat", **options).results["mode"]
    assert mode["maximum_likelihood"]
    for name, value in peers[task].items():
        assert abs(mode["parameters"][name]["value"] / value - 1) < 2e-5, name


def test_every_task_has_a_peer():
    assert set(tasks) == set(peers.index.get_level_values("task"))


# ---- Default priors are those of `wearwell new --from`.

def priors_of_new(wearwell, tmp_path, frame, *options):
    frame.to_csv(tmp_path / "table.csv", index=False)
    code, out, error = wearwell("new", tmp_path / "study", "--from", tmp_path / "table.csv", *options)
    assert code == 0, out + error
    return tomllib.loads((tmp_path / "study" / "study.toml").read_text())["prior"]


def priors_of(study):
    return tomllib.loads(study.toml)["prior"]


def test_default_priors_of_lives_are_those_of_the_program(wearwell, tmp_path):
    new = priors_of_new(wearwell, tmp_path, pumps[["hours", "failed"]])
    assert priors_of(made(ww.life, pumps, "hours", event="failed", units=units)) == new == {
        "characteristic": {"distribution": "lognormal", "median": "1000 h", "log_sd": 2},
        "slope": {"distribution": "lognormal", "median": 1.5, "log_sd": 0.7}}


def test_default_priors_under_stress_are_those_of_the_program(wearwell, tmp_path):
    devices = table_of("accelerated/device_a.csv")
    new = priors_of_new(wearwell, tmp_path, devices.rename(columns={"temperature_C": "temperature [degC]", "hours": "life [h]"}))
    ours = priors_of(made(ww.life, devices, "hours", event="status", count="count", stress={"temperature_C": "arrhenius"},
                          units={"temperature_C": "degC", "hours": "h"}))
    assert ours == new and ours["energy"] == {"distribution": "normal", "mean": "0.7 eV", "sd": "0.3 eV"}


@pytest.mark.parametrize("lift", [0, 500])
def test_default_priors_of_paths_are_those_of_the_program(wearwell, tmp_path, lift):
    frame = wear.assign(wear=wear["wear"] + lift).rename(columns={"wear": "wear [um]", "km": "distance [km]"})
    new = priors_of_new(wearwell, tmp_path, frame, "--column", "unit=machine")
    new["rate_scatter"] = new.pop("scatter")
    assert priors_of(made(ww.degradation, frame, "wear", "distance", unit="machine")) == new
    assert ("start" in new) == (lift > 0)


def made(function, *arguments, **options):
    """The study that a function makes, without its fit."""
    kept = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ww.Study, "fit", lambda study, *_, **__: kept.append(study))
        function(*arguments, **options)
    return kept[0]


def test_families_scatter_alike_under_their_default_priors():
    """The standard deviation of ln life under the default median of each shape, by draws of unit scale."""
    rng = np.random.default_rng(1)
    shapes = {family: tomllib.loads(made(ww.life, pumps, "hours", event="failed", family=family).toml)["prior"] for family in
              ("weibull", "lognormal", "loglogistic", "gamma", "birnbaum-saunders")}
    u, z = rng.uniform(size=200_000), rng.normal(size=200_000)
    drawn = {
        "weibull": np.log(-np.log(u)) / shapes["weibull"]["slope"]["median"],
        "lognormal": shapes["lognormal"]["sigma"]["median"] * z,
        "loglogistic": np.log(u / (1 - u)) / shapes["loglogistic"]["shape"]["median"],
        "gamma": np.log(rng.gamma(shapes["gamma"]["shape"]["median"], size=len(u))),
        "birnbaum-saunders": 2 * np.arcsinh(shapes["birnbaum-saunders"]["alpha"]["median"] * z / 2),
    }
    for family, values in drawn.items():
        assert 0.78 < values.std() < 0.9, family


def test_the_study_says_which_priors_are_defaults():
    toml = made(ww.life, pumps, "hours", event="failed", priors={"slope": ww.lognormal(2, 0.5)}).toml
    assert 'characteristic = { distribution = "lognormal", median = 1000.0, log_sd = 2 }    # default: a factor of 27' in toml
    assert 'slope = { distribution = "lognormal", median = 2, log_sd = 0.5 }\n' in toml
    assert "slopes" in refusal(ww.life, pumps, "hours", event="failed", priors={"slopes": ww.lognormal(2, 0.5)})
    assert "'flat'" in refusal(ww.life, pumps, "hours", event="failed", priors="jeffreys")


# ---- How lives ended.

words = np.where(pumps["failed"] == 1, "failed", "censored")


@pytest.mark.parametrize("event", [
    pumps["failed"].astype(bool), pumps["failed"].astype(float), pumps["failed"].astype("boolean"), pd.Series(words),
    pd.Series(np.where(pumps["failed"] == 1, "F", "suspended")), pd.Series(words).astype("category"), pumps["failed"].astype(object)])
def test_events_of_all_kinds_are_the_same(event):
    usual = made(ww.life, pumps[["hours", "failed"]], "hours", event="failed").description()
    assert "9 exact, 3 right-censored" in usual
    assert made(ww.life, pumps[["hours"]].assign(failed=event), "hours", event="failed").description() == usual


def test_an_event_that_can_be_read_in_two_ways_is_refused_with_both():
    frame = pumps[["hours"]].assign(censored=1 - pumps["failed"])
    said = refusal(ww.life, frame, "hours", event="censored")
    assert "event={'column': 'censored', 'failure': 0}" in said and "event={'column': 'censored', 'failure': 1}" in said
    study = made(ww.life, frame, "hours", event={"column": "censored", "failure": 0})
    assert 'status = { column = "censored", failure = 0 }' in study.toml
    assert "9 exact, 3 right-censored" in study.description()
    said = refusal(ww.life, frame.assign(censored=1 + pumps["failed"]), "hours", event="censored")
    assert "codes 1, 2" in said and "2 left-censored" in said
    assert made(ww.life, frame.assign(censored=words), "hours", event="censored")  # words say it themselves


def test_a_column_that_may_be_an_event_is_not_passed_over():
    assert 'event="failed"' in refusal(ww.life, pumps, "hours") and 'unused=["failed"]' in refusal(ww.life, pumps, "hours")
    assert "'stuck' is not a status" in refusal(ww.life, pumps.assign(failed="stuck"), "hours", event="failed")
    assert "no column 'fialed'" in refusal(ww.life, pumps, "hours", event="fialed") and "'failed'?" in refusal(ww.life, pumps, "hours", event="fialed")
    assert "the key 'runouts'" in refusal(ww.life, pumps, "hours", event={"column": "failed", "runouts": "x"})


# ---- Columns, units, conditions.

def test_no_unit_of_temperature_is_guessed():
    frame = pd.DataFrame({"hours": [100.0, 200, 30, 50], "T": [350.0, 350, 400, 400]})
    said = refusal(ww.life, frame, "hours", stress={"T": "arrhenius"})
    assert "units={'T': 'degC'}" in said and "units={'T': 'K'}" in said
    for each in (frame, frame.rename(columns={"T": "T [K]"})):
        options = {"units": {"T": "K"}} if each is frame else {}
        toml = made(ww.life, each, "hours", stress={"T": "eyring"}, **options).toml
        assert 'T_ref = "400 K"' in toml and "T_ref/T * exp(energy/boltzmann * (1/T - 1/T_ref))" in toml and 'given = { T = "350 K" }' in toml
    assert "arrhenius, eyring, inverse power" in refusal(ww.life, frame, "hours", stress={"T": "arrhenus"})
    assert "one value in all rows" in refusal(ww.life, frame.assign(T=1.0), "hours", stress={"T": "inverse power"})
    assert "above 0" in refusal(ww.life, frame.assign(T=[0, 0, 1.0, 1]), "hours", stress={"T": "inverse power"})


def test_groups_with_shapes_of_their_own():
    separate = made(ww.life, pumps, "hours", event="failed", by="supplier", shape="separate").toml
    assert 'scale = "characteristic[supplier]"\nshape = "slope[supplier]"' in separate and 'given = { supplier = "A" }' in separate
    shared = made(ww.life, pumps, "hours", event="failed", by="supplier", given={"supplier": "B"}).toml
    assert 'shape = "slope"\n' in shared and 'given = { supplier = "B" }' in shared
    assert "needs by" in refusal(ww.life, pumps, "hours", event="failed", shape="separate")
    assert "no 'C' (A, B)" in refusal(ww.life, pumps, "hours", event="failed", by="supplier", given={"supplier": "C"})
    assert "no condition" in refusal(ww.life, pumps, "hours", event="failed", given={"supplier": "A"})


def test_what_a_column_cannot_be():
    by_index = pumps.set_index("hours")
    assert "level of the index, and data.reset_index()" in refusal(ww.life, by_index, "hours", event="failed")
    with pytest.raises(ww.InputError, match=r"unit: data has no column 'machine'; it is a level of the index"):
        ww.Study("wear = k*km", wear.set_index("machine"), priors={"k": ww.half_normal(1), "sigma": ww.half_normal(1)}, unit="machine")
    assert "life is 3; it is the heading of a column" in refusal(ww.life, pumps, 3, event="failed")
    assert "event is int; it is the heading of a column" in refusal(ww.life, pumps, "hours", event=3)
    assert "'x [h]' or 'x [d]'" in refusal(ww.life, {"x [h]": [1.0], "x [d]": [2.0]}, "x")
    assert "above 0" in refusal(ww.life, {"x": [-1.0, 0.0]}, "x")
    assert refusal(ww.life, pumps.assign(hours=-pumps["hours"] + 400), "hours", event="failed").startswith("data, row 2, column 'hours'")
    assert "by: column 'hours' is that of life already" in refusal(ww.life, pumps, "hours", event="failed", by="hours")
    assert "family is 'weibul'" in refusal(ww.life, pumps, "hours", event="failed", family="weibul")


def test_headings_with_units_spaces_and_words_of_the_language(tmp_path):
    frame = pumps[["hours", "failed"]].set_axis(["running hours [h]", "has failed"], axis=1)
    toml = made(ww.life, frame, "running hours", event="has failed").toml
    assert 'running_hours = "running hours [h]"' in toml and 'median = "1000 h"' in toml
    assert "median = 1000.0" in made(ww.life, frame.rename(columns={"running hours [h]": "hours (h)"}), "hours", event="has failed").toml  # no unit
    assert "log_column = " in made(ww.life, {"log": [1.0, 2.0]}, "log").toml
    frame.to_csv(tmp_path / "pumps.csv", index=False)
    assert tomllib.loads(made(ww.life, tmp_path / "pumps.csv", "running hours", event="has failed").toml) == tomllib.loads(toml)


def test_numbers_among_objects_are_numbers():
    as_numbers = made(ww.life, pumps, "hours", event="failed").description()
    for kind in (int, float, lambda hours: Decimal(int(hours))):
        as_objects = pumps.assign(hours=pd.Series([kind(each) for each in pumps["hours"]], dtype=object))
        assert made(ww.life, as_objects, "hours", event="failed").description() == as_numbers
    assert "bool, and above there is float" in refusal(ww.life, {"x": pd.Series([1.5, True], dtype=object)}, "x")
    assert "list in a column of objects, which may hold numbers or texts" in refusal(ww.life, {"x": pd.Series([[1], [2]])}, "x")
    assert "beyond 2^53" in refusal(ww.life, {"x": pd.Series([1, 2**60], dtype=object)}, "x")


def test_infinite_ends_of_intervals_are_open():
    looks = pd.DataFrame({"ok": [100.0, 200, 300, 0], "failed": [200.0, 300, np.nan, 100]})
    infinite = looks.assign(failed=looks["failed"].fillna(np.inf), ok=looks["ok"].replace(0, -np.inf))
    missing = looks.assign(ok=looks["ok"].replace(0, np.nan))
    for data in (infinite, {name: infinite[name].to_numpy() for name in infinite}):
        found, own = made(ww.life, data, ("ok", "failed")), made(ww.life, missing, ("ok", "failed"))
        assert found.toml == own.toml and found.description() == own.description()
    assert np.isinf(infinite["failed"][2])  # the caller's frame is left alone
    assert "column 'ok': an open end is NaN, not -inf" in refusal(ww.life, infinite.to_records(index=False), ("ok", "failed"))


def test_a_column_of_texts_is_no_life():
    message = refusal(ww.life, {"hours": ["123,4", "99,5"]}, "hours")
    assert message == "life: column 'hours' holds no numbers, but texts such as '123,4'"


# ---- The other functions.

def test_paths_of_units_need_their_column():
    assert "unit is missing: km falls at row 5 from 40 to 10" in refusal(ww.degradation, wear, "wear", "km")
    toml = made(ww.degradation, wear, "wear", "km", unit=False).toml
    assert "random_effects" not in toml and 'path = "rate * km"' in toml
    assert "units={'wear': 'um'}" in refusal(ww.degradation, wear, "wear", "km", unit="machine", limit="100 um")
    assert "limit = { path = 100.0 }" in made(ww.degradation, wear, "wear", "km", unit="machine", limit=100).toml
    power = made(ww.degradation, wear, "wear", "km", unit="machine", path="power", units={"km": "km", "wear": "um"}).toml
    assert 'path = "rate * 50 [km] * (km/(50 [km]))^power"' in power
    falls = made(ww.degradation, wear.assign(wear=500 - wear["wear"]), "wear", "km", unit="machine", limit=400).toml
    assert 'path = "start - rate * km"' in falls
    process = made(ww.degradation, wear, "wear", "km", unit="machine", family="gamma-process", limit=100).toml
    assert 'scale = "step_ratio"' in process and "limit = { wear = 100.0 }" in process
    assert "begins at 0" in refusal(ww.degradation, wear.assign(wear=500 + wear["wear"]), "wear", "km", unit="machine", family="wiener-process")


def test_level_takes_the_place_of_the_default_confidence():
    hours = {"hours": [310, 540, 700, 820]}
    asked = lambda fit: tomllib.loads(fit.toml)["predict"]
    life = asked(made(ww.life, hours, "hours", predict={"level": 0.95}))
    assert life["level"] == 0.95 and "credible_level" not in life
    sn = asked(made(ww.sn, table_of("fatigue/tests.csv"), "stress_amplitude_MPa", "cycles", event="status", stress_ratio="stress_ratio",
                    units={"stress_amplitude_MPa": "MPa"}, predict={"level": 0.95}))
    assert sn["level"] == 0.95 and "credible_level" not in sn
    wear = {"wear [um]": [1.1, 2.3, 0.9, 1.8], "km": [1, 2, 1, 2], "machine": ["A", "A", "B", "B"]}
    degradation = asked(made(ww.degradation, wear, "wear", "km", unit="machine", limit="10 um", predict={"level": 0.95}))
    assert degradation["level"] == 0.95 and "credible_level" not in degradation
    # One that is chosen stands beside it, which can be read two ways.
    assert "level" in refusal(ww.life, hours, "hours", confidence=0.99, predict={"level": 0.95})


def test_classical_estimates_beside_the_posterior():
    fit = fitted("life", "pumps", "hours", event="failed", by="supplier", classical=True)
    found = {each["name"]: each for each in fit.results["classical"]["maximum_likelihood"]["parameters"]}
    expected = pd.read_csv(os.path.join(here, "peers.csv")).query("task == 'groups'").set_index("parameter")["value"]
    for name, value in expected.items():
        assert found[name]["value"] == pytest.approx(value, rel=1e-5)
        assert found[name]["normal"]["lower"] < value < found[name]["normal"]["upper"]
    assert "classical" not in made(ww.life, pumps, "hours", event="failed").toml
    events = {"unit": ["A", "A", "A"], "age [h]": [100, 250, 400], "event": ["failure", "failure", "end"]}
    assert tomllib.loads(made(ww.repairable, events, "age [h]", unit="unit", event="event", classical=True).toml)["predict"]["classical"] is True
    assert "classical is 'yes'; it is True or False" in refusal(ww.life, pumps, "hours", event="failed", classical="yes")
    assert "classical" in refusal(ww.life, pumps, "hours", event="failed", unit="supplier", classical=True)


def test_presets_are_their_study_files():
    joint = made(ww.joint, table_of("joint/joint_wear.csv"), "volume_mm3", "cycles", work_per_cycle="5.966 N m", limit="100 mm^3",
                 units={"volume_mm3": "mm^3"})
    assert tomllib.loads(joint.toml)["predict"] == {"limit": "100 mm^3", "cycles": [41170.0], "b_lives": [1, 10], "credible_level": 0.9}
    assert "work_per_cycle is missing" in refusal(ww.joint, {"n": [1], "V": [1.0]}, "V", "n", units={"V": "mm^3"})
    tests = table_of("fatigue/tests.csv")
    sn = tomllib.loads(made(ww.sn, tests, "stress_amplitude_MPa", "cycles", event="status", stress_ratio="stress_ratio",
                            units={"stress_amplitude_MPa": "MPa"}, required_life="1e6 cycles", reliability="90 %", predict={"stress_ratio": 0.1}).toml)
    assert sn["law"] == {"mean_stress": "goodman"} and sn["predict"]["required_life"] == ["1e6 cycles"]
    assert "needs stress_ratio or mean_stress" in refusal(ww.sn, tests, "stress_amplitude_MPa", "cycles", event="status", correction="gerber")
    assert "correction is 'goodmann'" in refusal(ww.sn, tests, "stress_amplitude_MPa", "cycles", correction="goodmann")
    inspections = table_of("bearing/inspections.csv")
    conditions = {"contact": "stationary", "radius": "10 mm", "clearance": "clearance_um", "revolutions": "revolutions", "length": "20 mm"}
    of = {"depth_um": "um", "clearance_um": "um", "force_N": "N"}
    bearing = tomllib.loads(made(ww.bearing, inspections, "depth_um", unit="bearing", force="force_N", units=of, **conditions).toml)
    assert bearing["conditions"] == {"contact": "stationary", "radius": "10 mm", "length": "20 mm"}
    assert bearing["prior"] == {"k_scatter": {"distribution": "default"}}
    assert "pressure is missing" in refusal(ww.bearing, inspections, "depth_um", units=of, **conditions)
    assert "no column 'forces'" in refusal(ww.bearing, inspections, "depth_um", force="forces", units=of, **conditions)
    assert ww.bearing.length and ww.clutch.CycleSum  # the modules are modules still
    assert "'failure': 0} reads 0 or False" in refusal(ww.staircase, {"S": [1.0, 2], "censored": [0, 1]}, "S", "censored", units={"S": "MPa"})


def test_stresses_asked_of_an_sn_curve():
    tests = {"S [MPa]": [450, 450, 400, 400, 350, 350, 300], "N": [3.1e4, 4.4e4, 9e4, 1.3e5, 3.2e5, 2.4e5, 1.1e6]}
    asked = lambda at, **options: tomllib.loads(made(ww.sn, tests, "S", "N", at=at, **options).toml)
    assert asked("320 MPa")["predict"]["stress"] == {"320 MPa": {"alternating_stress": "320 MPa"}}
    several = asked([320, "0.33 GPa"], stress_ratio=-1, scatter="grows")
    assert several["predict"]["stress"]["320"] == {"alternating_stress": "320 MPa", "stress_ratio": -1}
    assert several["predict"]["stress"]["0.33 GPa"]["alternating_stress"] == "0.33 GPa" and several["law"]["scatter"] == "grows"
    digits = asked([320.0, 1234567.8], units={"N": "cycles"})["predict"]["stress"]
    assert digits == {"320": {"alternating_stress": "320 MPa"}, "1234567.8": {"alternating_stress": "1234567.8 MPa"}}
    shaft = {"alternating_stress": 320, "stress_ratio": 0}
    assert asked({"shaft": shaft}, stress_ratio=-1)["predict"]["stress"] == {"shaft": {**shaft, "alternating_stress": "320 MPa"}}
    assert refusal(ww.sn, tests, "S", "N", at="soon").startswith("at: 'soon': alternating_stress: 'soon' is not a number with a unit")
    assert "scatter is 'growing'" in refusal(ww.sn, tests, "S", "N", scatter="growing")


def test_readings_that_scatter_by_a_share_of_the_path():
    toml = tomllib.loads(made(ww.degradation, wear, "wear", "km", unit="machine", family="lognormal").toml)
    assert toml["likelihood"]["wear"] == {"family": "lognormal", "median": "path", "log_sd": "sigma"} and toml["formula"]["path"] == "rate * km"
    assert toml["prior"]["sigma"] == {"distribution": "half-normal", "scale": 1}
    assert "need" in refusal(ww.degradation, wear, "wear", "km", unit="machine", family="lognormal", starts_at_zero=False)
    assert "need" in refusal(ww.degradation, wear, "wear", "km", unit="machine", family="lognormal", starts_at_zero=0)
    ended = wear.assign(failed=[0, 1] * (len(wear) // 2))
    assert tomllib.loads(made(ww.degradation, ended, "wear", "km", unit="machine", unused="failed").toml)["data"]["unused"] == ["failed"]


def test_a_joint_after_each_inspection():
    looks = {"n": [1, 100, 1000], "V": [1.6, 2.6, 8.1]}
    fit = ww.joint(looks, "V", "n", work_per_cycle="6 N m", units={"V": "mm^3"}, stages=True, method="exact", draws=100, report=False)
    assert len(fit.results["stages"]) == 3
    assert "stages is 1" in refusal(ww.joint, looks, "V", "n", work_per_cycle="6 N m", units={"V": "mm^3"}, stages=1)
    assert "predict={'work_per_cycle'" in refusal(ww.joint, {**looks, "W": [6, 600, 6000]}, "V", "n", work_per_cycle="6 N m", work="W")
    several = {"d [um]": [3, 5], "n": [1e4, 2e4], "c [um]": [20, 30]}
    message = refusal(ww.bearing, several, "d", contact="journal", radius="10 mm", clearance="c", pressure="1 MPa", revolutions="n", limit="80 um")
    assert "needs predict={'clearance': ...}" in message


def test_clutch_of_tables_in_memory():
    """Of tables too short to be fitted: the example of the docstring is fitted."""
    point = {"slip_speed [rpm]": [1200.0], "torque [N m]": [25.0], "temperature [degC]": [120.0], "closing_time [s]": [0.9]}
    design = {"point": [1], "role": ["model"], **point}
    cycles = {"plate": [1], "cycle": [1], **point, "energy": [25131.0]}
    weighings = {"plate": [1], "cycle": [0], "block": ["start"], "mass [g]": [249.9995]}
    kept = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ww.Study, "_made", classmethod(lambda cls, text, given, arguments: kept.append((text, given)) or cls.__new__(cls)))
        patch.setattr(ww.Study, "fit", lambda study, **_: None)
        ww.clutch(design, cycles, weighings, density="2.2 g/cm^3", depth="1 mm", area="100 cm^2", balance_sd="1 mg", replicates=0,
                  points={"steep hill": {"slip_speed": "2800 rpm", "torque": "75 N m", "temperature": "240 degC", "closing_time": "3.4 s"}},
                  units={"cycles": {"energy": "J"}})
    text = tomllib.loads(kept[0][0])
    assert text["data"] == {"design": "design", "cycles": "cycles", "weighings": "weighings"} and text["lining"]["area"] == "100 cm^2"
    assert text["life"]["points"]["steep hill"]["torque"] == "75 N m" and text["uncertainty"] == {"replicates": 0}
    assert kept[0][1]["cycles"][0].unit("energy") == "J"
    lining = {"density": "2.2 g/cm^3", "depth": "1 mm", "area": "100 cm^2", "balance_sd": "1 mg"}
    for wrong, message in ({"search": 3}, "search is int; it is a dict"), ({"points": {"hill": 3}}, "points: hill is int"), ({"points": 3}, "points is int"), \
            ({"units": 3}, "units is int"), ({"units": {"cycles": 3}}, "units: cycles is int"), ({"missing_cycles": None}, "missing_cycles is None; it is 'refuse'"):
        with pytest.raises(ww.InputError, match=message):
            ww.clutch(design, cycles, weighings, **lining, **wrong)
    hill = {"points": {"hill": {}}}
    for wrong, message in (hill, r"these are missing, here with values of an example: points\.hill\.slip_speed = "), ({"title": 3}, "title: must be a text, and is"), \
            ({"levels": "half", "units": {"cycles": {"energy": "J"}}}, "levels: entry 1: 'half' is not a number"):
        with pytest.raises(ww.InputError, match=f"^{message}"):
            ww.clutch(design, cycles, weighings, **lining, **wrong)
    for name, (table, message) in {
            "design": (pd.DataFrame(design).set_index("point"), r"design has no column 'point'; it is a level of the index, and design.reset_index\(\) makes it"),
            "cycles": (pd.Series([1.0]), "cycles is Series, one column without others"),
            "weighings": ({**weighings, "cycle": [True]}, "weighings, column 'cycle' holds True and False")}.items():
        with pytest.raises(ww.InputError, match=message):
            ww.clutch(**{"design": design, "cycles": {**cycles, "energy [J]": [25131.0]}, "weighings": weighings, name: table}, **lining)
    later = {"plate": [1, 1], "cycle": [0, 40], "block": ["start", "run-in"], "mass [g]": [249.9995, 249.8]}
    with pytest.raises(ww.InputError, match=r'but 40 ran; if a log loses some cycles, missing_cycles="fill" says so$'):
        ww.clutch(design, {**{k: v for k, v in cycles.items() if k != "energy"}, "energy [J]": [25131.0]}, later, **lining)
    with pytest.raises(ww.InputError, match="'cycle' is no table"):
        ww.clutch(design, cycles, weighings, density=1, depth=1, area=1, balance_sd=1, units={"cycle": {}})
    with pytest.raises(ww.InputError, match=r"cycles, column 'energy' has no unit: name it 'energy \[J\]', or write units={'cycles': {'energy': 'J'}}"):
        ww.clutch(design, cycles, weighings, density="2.2 g/cm^3", depth="1 mm", area="100 cm^2", balance_sd="1 mg")


def test_units_beyond_what_fits_into_memory_are_refused_before_the_fit():
    """600 units: their lives would take 6 GB. The refusal names the argument, and comes without a fit."""
    readings = pd.DataFrame({"wear": [1.0, 2.1] * 600, "km": [10.0, 20.0] * 600, "machine": np.repeat(range(600), 2)})
    stages = []
    with pytest.raises(ww.InputError, match=r"limit: 30: the data have 600 units of 'machine', .* predict=\{\"lives_of\": \[\]\} only a new one$"):
        ww.degradation(readings, "wear", "km", unit="machine", limit=30, progress=lambda *each: stages.append(each))
    assert not stages


def test_fit_of_one_line_can_be_pickled_and_copied():
    fit = fitted("life", "pumps", "hours", event="failed", units=units)
    again = pickle.loads(pickle.dumps(fit))
    assert again.results == fit.results and again.study.toml == fit.study.toml and copy.deepcopy(fit) is fit
    assert again.percentile(10).equals(fit.percentile(10))


# ---- Errors in the words of the caller.

def test_words_of_errors_are_those_of_the_call(tmp_path):
    with pytest.raises(TypeError, match=r"fit\(\) got an unexpected keyword argument 'chain'") as error:
        ww.fit("study.toml", chain=4)
    assert "Study.fit" not in str(error.value)
    with pytest.raises(FileNotFoundError, match="nope.toml") as missing:
        ww.fit(tmp_path / "nope.toml")
    assert isinstance(missing.value, ww.InputError) and isinstance(missing.value, ValueError)
    with pytest.raises(FileNotFoundError, match="nope.csv"):
        ww.table(tmp_path / "nope.csv")
    assert "wearwell.life" in refusal(ww.fit, pumps)
    with pytest.raises(ww.InputError, match=r"^priors: k") as said:
        ww.Study("wear = k*km", wear, priors={"k": ww.lognormal(1, -1), "sigma": ww.half_normal(1)})
    assert "study:" not in str(said.value)


def test_warnings_stand_at_the_callers_line():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ww.joint({"n": [1, 100, 1000, 5000, 10000], "V": [1.59, 2.57, 8.10, 24.48, 46.21]}, "V", "n", work_per_cycle="5.966 N m",
                 units={"V": "mm^3"}, method="exact", draws=50, report=False)
    assert caught and all(each.filename == __file__ for each in caught if each.category is ww.CheckWarning)


def test_help_begins_with_what_people_need():
    first = ww.__doc__.split("\n")
    assert first[4].startswith("One line for a table") and "``life``" in ww.__doc__ and ww.__all__[0] == "life"


# ---- Units, failure modes.

absorbers = table_of("life/shock_absorbers.csv")
mode_of = {"mode": "failure mode", "family": "exponential"}


def test_mean_lives_of_exponential_modes_are_total_time_over_failures():
    """The maximum likelihood estimate of each mode, in closed form; failures by the other one are run-outs."""
    fit = ww.life(absorbers, "km", priors="flat", method="exact", draws=50, chains=2, report=False, **mode_of)
    for name, each in fit.results["mode"]["parameters"].items():
        failures = (absorbers["failure mode"] == name[len("mean_life["):-1]).sum()
        assert abs(each["value"] / (absorbers["km"].sum() / failures) - 1) < 1e-4, name
    assert list(fit.lives["of"]) == ["new unit", "new unit with mode 1 alone", "new unit with mode 2 alone"]
    part = fit.survival_function([5000, 10000])
    assert part["q50"].is_monotonic_decreasing and list(part.index) == [5000, 10000]
    assert abs(fit.percentile(10)["predictive"].iloc[0] / fit.lives.loc[0, "b10"] - 1) < 1e-9
    with pytest.raises(ww.InputError, match="mode: is not a condition"):
        fit.ask({"given": {"mode": "mode 1"}})


def test_default_study_of_modes_is_that_of_the_program(wearwell, tmp_path):
    new = priors_of_new(wearwell, tmp_path, absorbers)
    study = tomllib.loads(made(ww.life, absorbers, "km", mode="failure mode", units={"km": "km"}).toml)
    assert study["prior"] == new and study["failure_modes"] == {"column": "mode"}
    assert study["likelihood"]["km"] == {"family": "weibull", "scale": "characteristic[mode]", "shape": "slope[mode]"}


def test_modes_are_read_from_words_codes_and_events():
    causes = absorbers["failure mode"].map({"mode 1": 1, "mode 2": 2, "censored": 0})
    ended = causes > 0
    coded = made(ww.life, absorbers.assign(cause=causes), "km", mode={"column": "cause", "runout": 0}, unused="failure mode")
    beside = made(ww.life, absorbers.assign(cause=causes.where(ended), ended=ended), "km", event="ended", mode="cause", unused="failure mode")
    for study in (coded, beside):
        assert "38 observations: 27 run-outs, 7 failed by 1, 4 failed by 2" in study.description()
    shared = tomllib.loads(made(ww.life, absorbers, "km", mode="failure mode", shape="shared").toml)
    assert shared["likelihood"]["km"]["shape"] == "slope"
    stressed = absorbers.assign(load=[1.0, 2.0] * 19)
    text = made(ww.life, stressed, "km", mode="failure mode", family="lognormal", stress={"load": "inverse power"}).toml
    assert 'median_life = "life_ref[mode] * (load/load_ref)^-load_power"' in text


def test_lives_of_units_differ_at_random():
    """The formula study with the same random effect, written with ww.Study."""
    batches = pd.DataFrame({"batch": list("AABBCC"), "hours": [210.0, 340, 460, 610, 150, 190]})
    ours = tomllib.loads(made(ww.life, batches, "hours", unit="batch", family="exponential", units=units).toml)
    study = tomllib.loads(ww.Study(formula="hours = mean_life", family="exponential", data=batches, unit="batch", units=units,
                                   random_effects=["mean_life"], priors={"mean_life": ww.lognormal("1000 h", log_sd=2)}).toml)
    for table in ("random_effects", "likelihood"):
        assert ours[table] == study[table]
    assert ours["prior"] == {"mean_life": {"distribution": "lognormal", "median": "1000 h", "log_sd": 2},
                             "mean_life_scatter": {"distribution": "half-normal", "scale": 1}}
    known = {"mean_life": ww.lognormal(300, log_sd=0.3), "mean_life_scatter": ww.lognormal(0.3, log_sd=0.3)}
    fit = ww.life(batches, "hours", unit="batch", family="exponential", priors=known, method="exact", draws=50, chains=2, report=False, b=10)
    assert fit.lives.loc[0, "of"] == "new batch" and list(fit.percentile(10).index) == [10]


@pytest.mark.parametrize("options, message", [
    ({"unit": "supplier", "by": "supplier"}, "by and unit: each group has its own scale, which then has no random effect; leave one out"),
    ({"mode": "failure mode", "by": "supplier"}, "by and mode: each failure mode has its own scale, for all groups; leave one out"),
    ({"mode": "failure mode", "unit": "supplier"}, "unit and mode: failure modes have no random effects; leave one out"),
    ({"mode": {"columns": "x"}}, "mode has the key 'columns'; it is like {'column': 'cause', 'runout': 0}"),
    ({"mode": "cause"}, "mode: data has no column 'cause'"),
    ({"shape": "separate"}, "shape='separate' needs by or mode"),
    ({}, 'mode="failure mode" in wearwell.life'),  # its run-outs would be failures
    ({"event": "code"}, "if the codes are failure modes, mode={'column': 'code', 'runout': 0} in place of event"),
    ({"mode": "code", "unused": "failure mode"}, "name a column as event, or write mode={'column': ..., 'runout': \"0\"}"),
])
def test_units_and_modes_are_refused_in_the_words_of_arguments(options, message):
    table = absorbers.assign(supplier=["A", "B"] * 19, code=[0, 1, 2] * 12 + [0, 1])
    assert message in refusal(ww.life, table, "km", **options)


def test_residuals_and_their_figure():
    """Medians over draws of exponential scores; of a run-out the middle of the probability that is left."""
    from statistics import NormalDist

    fit = fitted("life", "pumps", "hours", event="failed", family="exponential")
    means = fit.draws["mean_life"].to_numpy()
    for (_, row), residual in zip(pumps.iterrows(), fit.residuals().itertuples()):
        below = 1 - np.exp(-row["hours"] / means)
        below = below if row["failed"] else (1 + below) / 2
        scores = [NormalDist().inv_cdf(each) for each in below]
        assert abs(residual.residual - np.median(scores)) < 1e-6 and residual.censored == (not row["failed"])
    hazard = fit.residuals("cox-snell")["residual"]
    assert np.allclose(hazard, [-np.log(1 - NormalDist().cdf(each)) for each in fit.residuals()["residual"]])
    plot = fit.plot("residuals")
    assert plot.figures == ["residuals"] and "<svg" in plot.to_html() and len(plot.to_dict()["layer"]) == 3
    with pytest.raises(ww.InputError, match="kind is 'deviance'; it is 'score' or 'cox-snell'"):
        fit.residuals("deviance")


# ---- Columns that are not used.

fleet = pd.DataFrame({"hours": [310.0, 480, 520, 640, 700, 700, 150, 260, 420, 330], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1, 1]})
in_hours = {"event": "failed", "units": {"hours": "h"}, "method": "exact", "draws": 50, "chains": 2, "report": False}


def warned(function, *arguments, **options):
    """What is said of columns before a fit, all of it at this file."""
    with warnings.catch_warnings(record=True) as caught, pytest.MonkeyPatch.context() as patch:
        warnings.simplefilter("always")
        patch.setattr(ww.Study, "fit", lambda study, *_, **__: None)
        function(*arguments, **options)
    of_columns = [each for each in caught if str(each.message).startswith("column '")]
    assert all(each.category is ww.CheckWarning and each.filename == __file__ for each in of_columns)
    return [str(each.message) for each in of_columns]


@pytest.mark.parametrize("name", ["count", "Counts", "weight", "weights", "n", "quantity", "qty", "freq", "frequency", "number"])
def test_counts_that_are_not_used_are_named(name):
    said = warned(ww.life, fleet.assign(**{name: [1, 20] * 5}), "hours", **in_hours)
    assert said == [f"column '{name}' looks like a number of equal rows and is not used: write count=\"{name}\", or unused=\"{name}\" if it says "
                    "something else"]


@pytest.mark.parametrize("column", [[1] * 10, list(range(1, 11)), [1.5] * 10, [0, 2] * 5, ["a", "b"] * 5, [2, None] * 5], ids=str)
def test_other_columns_are_no_counts(column):
    assert not warned(ww.life, fleet.assign(n=column), "hours", **in_hours)


def test_presets_name_columns_that_they_do_not_use():
    tests = {"S [MPa]": [300, 315, 330, 315, 300, 315, 300, 285, 300, 315], "broke": [0, 0, 1, 1, 0, 1, 1, 0, 0, 1], "n": [1, 2] * 5}
    of_counts = ["column 'n' looks like a number of equal rows and is not used: write count=\"n\", or unused=\"n\" if it says something else"]
    assert warned(ww.staircase, tests, "S", "broke") == of_counts
    assert not warned(ww.staircase, tests, "S", "broke", unused="n") and not warned(ww.staircase, tests, "S", "broke", count="n")
    looks = {"cycles": [1, 100, 1000, 5000], "V": [1.59, 2.57, 8.10, 24.48], "joint": ["A", "A", "B", "B"], "n": [1, 2, 1, 2]}
    joint = dict(work_per_cycle="5.966 N m", units={"V": "mm^3"})
    assert warned(ww.joint, looks, "V", "cycles", **joint) == [*of_counts, (
        "column 'joint' looks like a label of units with several rows each and is not used, so all rows count as those of one joint: write "
        "wearwell.degradation(..., unit=\"joint\"), whose rate differs from unit to unit, or unused=\"joint\" if that is so")]
    assert not warned(ww.joint, looks, "V", "cycles", unused=["n", "joint"], **joint)
    inspections = table_of("bearing/inspections.csv")
    bearing = dict(contact="stationary", radius="10 mm", clearance="25 um", revolutions="revolutions", pressure="1 MPa", units={"depth_um": "um"})
    assert warned(ww.bearing, inspections, "depth_um", **bearing) == [
        "column 'bearing' looks like a label of units with several rows each and is not used, so all rows count as independent: write "
        "unit=\"bearing\", or unused=\"bearing\" if that is so"]
    assert not warned(ww.bearing, inspections, "depth_um", unit="bearing", **bearing)


@pytest.mark.parametrize("name", ["unit", "machine", "Serial", "id", "machine_id", "serial number"])
def test_units_that_are_not_used_are_named(name):
    repeated = fleet.assign(**{name: list("AABBCCDDEE")})
    said = warned(ww.life, repeated, "hours", **in_hours)
    assert len(said) == 1 and f'write unit="{name}", or unused="{name}" if that is so' in said[0]
    assert not warned(ww.life, repeated, "hours", unused=name, **in_hours)
    assert not warned(ww.life, fleet.assign(**{name: list("ABCDEFGHIJ")}), "hours", **in_hours)
    assert not warned(ww.life, fleet.assign(**{name: "A"}), "hours", **in_hours)
    assert not warned(ww.life, repeated, "hours", by=name, **in_hours)
    groups = repeated.assign(maker=list("XY") * 5)
    assert 'write unit="' + name + '" in place of by, or' in warned(ww.life, groups, "hours", by="maker", **in_hours)[0]


@pytest.mark.parametrize("kind", ["dict", "array", "table", "file"])
def test_unused_columns_of_every_table_are_seen(kind, tmp_path):
    frame = fleet.assign(qty=[1, 20] * 5, machine=list("AABBCCDDEE"))
    frame.to_csv(tmp_path / "fleet.csv", index=False)
    data = {"dict": frame.to_dict("list"), "array": frame.to_records(index=False), "table": ww.table(frame),
            "file": str(tmp_path / "fleet.csv")}[kind]
    said = warned(ww.life, data, "hours", **in_hours)
    assert [each.split("'")[1] for each in said] == ["qty", "machine"]


def test_columns_in_use_are_not_warned_of():
    frame = fleet.assign(count=[1, 2] * 5, machine=list("AABBCCDDEE"))
    assert not warned(ww.life, frame, "hours", count="count", unused="machine", **in_hours)
    assert not warned(ww.life, frame.assign(weight=2), "hours", count="count", unused="machine", **in_hours)
    assert not warned(ww.life, frame, "hours", unused=["count", "machine"], **in_hours)
    assert not warned(ww.life, fleet.assign(**{"weight [kg]": [1, 20] * 5}), "hours", **in_hours)
    tests = {"S": [300, 320, 340, 360, 380, 400], "N": [9e5, 5e5, 3e5, 2e5, 1e5, 5e4], "n": [1, 2, 1, 1, 3, 1]}
    of_sn = {"units": {"S": "MPa", "N": "cycles"}, "method": "exact", "draws": 50, "chains": 2, "report": False}
    assert 'count="n"' in warned(ww.sn, tests, "S", "N", **of_sn)[0] and not warned(ww.sn, tests, "S", "N", count="n", **of_sn)
    said = warned(ww.degradation, {"km": [1, 2, 3, 4], "wear": [11.0, 19, 32, 41], "machine": ["A", "A", "B", "B"]}, "wear", "km", method="exact",
                  draws=50, chains=2, report=False)
    assert 'unit="machine", or unit=False if that is so' in said[0]


# ---- Questions and cells in the words of the call.

@functools.lru_cache(maxsize=None)
def of_fleet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return ww.life(fleet, "hours", **in_hours)


@pytest.mark.parametrize("ask, said", [
    (lambda f: f.survival_function("5 kg"), "times: '5 kg': unit 'kg' has the wrong dimension (expected one like 's'); hours is in h"),
    (lambda f: f.survival_function([100, "x"]), "times: 'x' is not a number with a unit (like '1.5 s'); hours is in h"),
    (lambda f: f.hazard("x"), "times: 'x' is not a number with a unit (like '1.5 s'); hours is in h"),
    (lambda f: f.conditional("5 kg"), "survived: '5 kg': unit 'kg' has the wrong dimension (expected one like 's'); hours is in h"),
    (lambda f: f.life(survived="5 kg"), "survived: '5 kg': unit 'kg' has the wrong dimension (expected one like 's')"),
    (lambda f: f.ask({"survival_to": "5 kg"}), "predict.survival_to: '5 kg': unit 'kg' has the wrong dimension (expected one like 's')"),
    (lambda f: f.survival_function(-5), "times is -5; lives of this study are 0 or more"),
    (lambda f: f.survival_function([1, "-5 h"]), "times holds '-5 h'; lives of this study are 0 or more"),
    (lambda f: f.hazard(np.array([-0.5])), "times is -0.5; lives of this study are 0 or more"),
    (lambda f: f.survival_function(pd.to_timedelta([100], unit="h")), "times is Timedelta; it is a number, or a text with a unit, like '100 h'"),
    (lambda f: f.survival_function(pd.to_timedelta([100], unit="h").to_numpy()),  # 3.6e14 ns as a whole number, else
     "times holds dates or times (timedelta64[ns]); it is a number, or a text with a unit, like '100 h'"),
    (lambda f: f.hazard(np.array(["2026-01-01"], dtype="datetime64[ns]")),
     "times holds dates or times (datetime64[ns]); it is a number, or a text with a unit, like '100 h'"),
    (lambda f: f.conditional(np.timedelta64(100, "ns")),
     "survived holds dates or times (timedelta64[ns]); it is a number, or a text with a unit, like '100 h'"),
    (lambda f: f.life(survived=np.timedelta64(100, "ns")),
     "survived holds dates or times (timedelta64[ns]); it is a number, or a text with a unit, like '100 h'"),
    (lambda f: f.ask({"survival_to": np.array([100], dtype="timedelta64[ns]")}),
     "predict.survival_to holds dates or times (timedelta64[ns]); it is a number, or a text with a unit, like '100 h'"),
    (lambda f: ww.compare(f, 3), "fit 2 is int; it is a fit, or the folder of a result"),
    (lambda f: f.conditional(-1), "survived is -1; lives of this study are 0 or more"),
    (lambda f: f.life(survived="-1 h"), "survived is '-1 h'; lives of this study are 0 or more")])
def test_questions_are_refused_in_the_words_of_arguments(ask, said):
    with pytest.raises(ww.InputError) as refused:
        ask(of_fleet())
    assert str(refused.value) == said


def test_lives_of_both_signs_are_asked_below_zero():
    study = ww.Study("logs = mu", {"logs": [1.0, 2.0, 3.0, 2.5]}, priors={"mu": ww.normal(2, 2), "sigma": ww.half_normal(2)}, predict={"b_lives": [10]})
    fit = study.fit(method="exact", draws=50, chains=2, report=False)
    assert 0.9 < fit.survival_function(-1).iloc[0]["q50"] < 1


def test_a_threshold_is_refused_with_its_argument():
    path = {"km": [10, 20, 30, 40], "wear": [11, 19, 32, 41]}
    in_um = {"y": "wear", "x": "km", "units": {"wear": "um", "km": "km"}}
    said = "limit: '100 kg': unit 'kg' has the wrong dimension (expected one like 'm')"
    assert refusal(ww.degradation, path, limit="100 kg", **in_um) == said
    fit = ww.degradation(path, limit="100 um", method="exact", draws=50, chains=2, report=False, **in_um)
    with pytest.raises(ww.InputError) as refused:
        fit.life(limit="100 kg")
    assert str(refused.value) == said


def test_cells_of_events_and_lives():
    truths = fleet.assign(failed=fleet["failed"].astype(bool).astype(object))
    assert made(ww.life, truths, "hours", event="failed").description() == made(ww.life, fleet, "hours", event="failed").description()
    assert "event=\"failed\"" in refusal(ww.life, truths, "hours")  # is not passed over either
    for column, what in (([1, 1, 1, 1, np.nan, 0, 1, 1, 1, 1], "NaN"), ([True, True, True, True, None] + [True] * 5, "NaN"),
                         (["failed"] * 4 + [None] + ["runout"] * 5, "no text")):
        for event in ("failed", {"column": "failed", "failure": "failed" if what == "no text" else 1}):
            said = refusal(ww.life, fleet.assign(failed=column), "hours", event=event)
            assert said.startswith(f"data, row 5, column 'failed' is missing ({what}): it says how each row ended; write 1 for a failure and 0 for")
    said = refusal(ww.life, fleet.assign(hours=[-5.0] + [100.0] * 9), "hours", event="failed")
    assert said == "data, row 1, column 'hours': -5 must be positive for the weibull family"
    assert "bool" in refusal(ww.life, fleet.assign(failed=[True, "x"] * 5), "hours", event="failed")


def test_parameters_and_default_priors_are_those_of_the_r_package():
    """tests/golden/life_families.json is what both make of the same nine lives; r/tests/testthat/test-life.R reads it too."""
    pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
    with open(os.path.join(source, "tests", "golden", "life_families.json")) as file:
        expected = json.load(file)
    for family, of in expected.items():
        study = tomllib.loads(made(ww.life, pumps, "hours", event="failed", family=family, standard=of["likelihood"].get("standard"),
                                   units={"hours": "h"}).toml)
        assert study["likelihood"]["hours"] == of["likelihood"] and study["prior"] == of["prior"], family
