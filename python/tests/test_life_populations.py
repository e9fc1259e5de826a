"""Lives beyond one distribution that begins at 0, in one line: families, thresholds, shares of parts, subpopulations."""

import os
import re
import tomllib
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import source
from wearwell._impl.life_families import families

pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}
few = {"method": "exact", "draws": 50, "chains": 2, "seed": 1, "report": False}


def table_of(name):
    return pd.read_csv(os.path.join(source, "examples", "life", name), comment="#")


def quiet(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return function(*arguments, **options)


def made(*arguments, **options):
    """The study of ww.life, without its fit."""
    kept = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ww.Study, "fit", lambda study, *_, **__: kept.append(study))
        ww.life(*arguments, **options)
    return kept[0]


def refusal(**options):
    with pytest.raises(ww.InputError) as error:
        ww.life({**pumps, "site": ["A", "B"] * 4 + ["A"]}, "hours", event="failed", units={"hours": "h"}, report=False, **{"unused": None if {"by", "unit", "mode"} & set(options) else "site"}, **options)
    return str(error.value)


def test_families_are_those_that_the_library_has_for_lives():
    """Families of positive values are those that take a threshold; docs/reference/study-keys.md is written by the library."""
    with open(os.path.join(source, "docs", "reference", "study-keys.md"), encoding="utf-8") as file:
        row = re.search(r"\| `likelihood\.\*\.threshold` .*expression or number, of ([^|]*) \|", file.read())
    assert set(families) == set(row[1].split(", ")) | {"log-location-scale"}


@pytest.mark.parametrize("family", families)
def test_every_family_is_fitted_as_its_study(family):
    """The numbers of the study as a file, to the last bit."""
    options = {"standard": "normal"} if family == "log-location-scale" else {}
    fit = quiet(ww.life, pumps, "hours", event="failed", units={"hours": "h"}, family=family, **options, **few)
    study = quiet(ww.Study.from_toml(fit.study.toml, {"data": pumps}).fit, 1, method="exact", draws=50, chains=2, report=False)
    assert fit.parameters[["mean", "sd", "q05", "q95"]].equals(study.parameters[["mean", "sd", "q05", "q95"]])
    assert np.isfinite(fit.parameters["mean"]).all()


# Studies as one would write them, without ww.life.
limited = """
model = "formula"
[data]
file = "circuits.csv"
[data.columns]
hours = { column = "hours", unit = "h" }
status = "status"
count = "count"
[likelihood.hours]
family = "weibull"
scale = "characteristic"
shape = "slope"
share_defective = "share_defective"
[prior]
characteristic = { distribution = "lognormal", median = "50000 h", log_sd = 7 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
share_defective = { distribution = "uniform", lower = 0, upper = 1 }
[predict]
b_lives = [0.5]
credible_level = 0.9
classical = true
"""
shifted = """
model = "formula"
[data]
file = "d.csv"
[data.columns]
hours = { column = "hours", unit = "h" }
status = { column = "failed", failure = 1 }
[likelihood.hours]
family = "weibull"
scale = "characteristic"
shape = "slope"
threshold = "threshold"
[prior]
characteristic = { distribution = "lognormal", median = "1000 h", log_sd = 2 }
slope = { distribution = "lognormal", median = 1.5, log_sd = 0.7 }
threshold = { distribution = "half-normal", scale = "200 h" }
[predict]
b_lives = [1, 10, 50]
credible_level = 0.9
"""


def same_numbers(fit, text, tables):
    own = quiet(ww.Study.from_toml(text, tables).fit, 1, method="exact", draws=50, chains=2, report=False)
    columns = ["mean", "sd", "q05", "q50", "q95"]
    pd.testing.assert_frame_equal(fit.parameters[columns], own.parameters.loc[fit.parameters.index, columns], check_exact=True)
    assert list(fit.lives["b10"]) == list(own.lives["b10"])


def test_a_share_that_can_fail_is_that_of_the_study():
    circuits = table_of("circuits.csv")
    fit = quiet(ww.life, circuits, "hours", event="status", count="count", units={"hours": "h"}, share_defective=True, classical=True, b=0.5, **few)
    same_numbers(fit, limited, {"circuits.csv": circuits})
    estimates = {each["name"]: each for each in fit.results["classical"]["maximum_likelihood"]["parameters"]}
    assert abs(estimates["share_defective"]["value"] - 0.00674) < 5e-6  # Meeker and Escobar 1998
    assert abs(np.log(estimates["characteristic"]["value"]) - 3.34) < 0.01
    assert fit.percentile(10)["q50"].iloc[0] == np.inf


def test_a_threshold_is_that_of_the_study():
    fit = quiet(ww.life, pumps, "hours", event="failed", units={"hours": "h"}, threshold=True, **few)
    same_numbers(fit, shifted, {"d.csv": pumps})
    assert fit.parameters.loc["threshold", "q95"] < 150


@pytest.mark.parametrize("threshold", [100, "100 h", "6000 min"])
def test_a_known_threshold_is_a_shift(threshold):
    """Lives above a known threshold are lives of a Weibull distribution that begins there."""
    lower = {**pumps, "hours": [each - 100 for each in pumps["hours"]]}
    priors = {"characteristic": ww.lognormal("500 h", log_sd=2)}
    known = quiet(ww.life, pumps, "hours", event="failed", units={"hours": "h"}, threshold=threshold, priors=priors, b=10, **few)
    plain = quiet(ww.life, lower, "hours", event="failed", units={"hours": "h"}, priors=priors, b=10, **few)
    np.testing.assert_allclose(known.parameters["mean"], plain.parameters["mean"], rtol=1e-6)
    np.testing.assert_allclose(known.percentile(10)["q50"], plain.percentile(10)["q50"] + 100, rtol=1e-6)


def test_subpopulations_are_those_of_the_study():
    study = tomllib.loads(made(table_of("controllers.csv"), "hours", event="status", units={"hours": "h"}, subpopulations=["early", "wear-out"]).toml)
    assert study["subpopulations"] == {"names": ["early", "wear-out"], "share": {"early": "share_early"}}
    assert study["likelihood"]["hours"] == {"family": "weibull", "scale": "characteristic[subpopulation]", "shape": "slope[subpopulation]"}
    assert study["prior"] == {"characteristic": {"distribution": "lognormal", "median": "50000 h", "log_sd": 2},
                              "slope": {"distribution": "lognormal", "median": 1.5, "log_sd": 0.7},
                              "share_early": {"distribution": "uniform", "lower": 0, "upper": 1}}
    assert tomllib.loads(made(pumps, "hours", event="failed", subpopulations=3).toml)["subpopulations"]["share"] == {"early": "share_early", "middle": "share_middle"}
    shared = tomllib.loads(made(pumps, "hours", event="failed", subpopulations=2, shape="shared", family="lognormal").toml)
    assert shared["likelihood"]["hours"]["log_sd"] == "sigma"


def test_subpopulations_under_stress():
    ovens = {"T": [150] * 4 + [175] * 4, "hours": [3200, 4100, 5000, 5000, 1100, 1500, 1900, 2600]}
    study = made(ovens, "hours", subpopulations=2, stress={"T": "arrhenius"}, units={"T": "degC", "hours": "h"})
    assert "characteristic = \"life_ref[subpopulation] * exp(" in study.toml
    assert "in the order of their median lives" in study.description()


def test_dead_parts_are_lives_of_0():
    table = {"hours": [0, 0, *pumps["hours"]], "failed": [1, 1, *pumps["failed"]]}
    fit = quiet(ww.life, table, "hours", event="failed", units={"hours": "h"}, share_dead_on_arrival=True, **few)
    assert abs(fit.parameters.loc["share_dead_on_arrival", "mean"] - 3 / 13) < 1e-6  # beta(1 + 2, 1 + 9)
    with pytest.raises(ww.InputError, match="share_dead_on_arrival"):
        ww.life(table, "hours", event="failed", units={"hours": "h"}, report=False)


def test_flat_priors_of_shares_are_between_0_and_1():
    circuits = table_of("circuits.csv")
    prior = tomllib.loads(made(circuits, "hours", event="status", count="count", share_defective=True, threshold=True, priors="flat").toml)["prior"]
    assert prior["share_defective"] == {"distribution": "uniform", "lower": 0, "upper": 1}
    assert prior["threshold"] == {"distribution": "flat", "unit": "1", "lower": 0}


@pytest.mark.parametrize("options, message", [
    ({"family": "weibul"}, "family is 'weibul'; it is weibull, exponential"),
    ({"family": "log-location-scale"}, "standard is None; the distribution of the standardized logarithm is 'smallest extreme value', 'normal'"),
    ({"standard": "normal"}, "standard is 'normal' and family is 'weibull'; standard is of family='log-location-scale'"),
    ({"subpopulations": 1}, "subpopulations is 1; it is 2, 3 or 4, or as many names in the order of their median lives"),
    ({"subpopulations": ["one"]}, "subpopulations is ['one']"),
    ({"subpopulations": True}, "subpopulations is True"),
    ({"subpopulations": ["a", "a"]}, "has 'a' twice"),
    ({"subpopulations": ["a b", "a-b", "c"]}, "share_a_b twice"),
    ({"subpopulations": 2, "by": "site"}, "by and subpopulations: each group has its own scale"),
    ({"subpopulations": 2, "unit": "site"}, "unit and subpopulations: subpopulations have no random effects; leave one out"),
    ({"subpopulations": 2, "mode": "site"}, "mode and subpopulations"),
    ({"share_defective": True, "unit": "site"}, "unit and share_defective: lives with random effects have no such share; leave one out"),
    ({"share_dead_on_arrival": 0.1, "mode": "site"}, "mode and share_dead_on_arrival: failure modes have no such share"),
    ({"share_defective": 1.5}, "share_defective is 1.5; it is True, for a share with a prior, or a known share from 0 to 1"),
    ({"share_defective": "p"}, "share_defective is 'p'"),
    ({"share_defective": True, "predict": {"mean_life": True}}, "does not exist with share_defective"),
    ({"threshold": "3 kg"}, "threshold"),
    ({"threshold": [1]}, "threshold is list; it is a number or a text with a unit"),
    ({"shape": "separate"}, "shape='separate' needs by or mode: the column of the groups or failure modes that differ; or subpopulations"),
    ({"share_defective": True, "priors": {"p": ww.uniform(0, 1)}}, "the study has no parameter 'p' (parameters: characteristic, slope, share_defective)"),
])
def test_what_is_refused_is_refused_in_the_words_of_arguments(options, message):
    said = refusal(**options)
    assert message in said and "[likelihood" not in said, said


def test_returns_take_families_by_their_own_names():
    with pytest.raises(ww.InputError, match="family is 'log-location-scale'"):
        ww.returns(pd.DataFrame({"month": ["2024-01"], "sold": [10], "2024-02": [1]}), warranty="36 month", family="log-location-scale")
