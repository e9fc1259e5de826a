"""Plots of fits, and what fits of lives answer under conditions."""

import functools
import json
import math
import os
import warnings
import xml.etree.ElementTree as ElementTree

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import source
from wearwell._impl import marks as marks_module

pumps = pd.read_csv(os.path.join(os.path.dirname(__file__), "peers", "pumps.csv"))


@functools.lru_cache(maxsize=None)
def fit_of(name):
    """Fits, each made once for all tests."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        if name == "joint":
            return ww.fit(os.path.join(source, "examples", "joint", "study.toml"), seed=1, method="exact")
        quick = {"event": "failed", "units": {"hours": "h"}, "method": "exact", "seed": 1}
        if name == "groups":
            return ww.life(pumps, "hours", by="supplier", family="exponential", draws=100, report=False, **quick)
        return ww.life(pumps, "hours", family=name, report=name == "weibull", **quick)


# ---- Plots.

def test_plots_are_the_figures_of_the_report():
    fit = fit_of("weibull")
    report = json.loads(fit._files()["report.json"])
    paper = report["sections"][0]["blocks"]
    figure = next(each for block in paper if "figures" in block for each in block["figures"])
    plot = fit.plot("probability")
    assert plot.figures == [figure["id"]] == ["probability-paper"] and fit.plot().figures == plot.figures
    shown = plot.to_dict()
    assert shown["layer"] == figure["specification"]["layer"] and shown["title"] == figure["title"]
    assert shown["$schema"].endswith("v5.json") and shown["width"] == 480
    both = fit.plot("posterior").to_dict()
    assert [each["title"] for each in both["concat"]] == ["characteristic", "slope"] and "$schema" not in both["concat"][0]
    bundle = plot._repr_mimebundle_()
    assert bundle["application/vnd.vegalite.v5+json"] == shown and bundle["text/plain"] == repr(plot) and "<svg" in bundle["text/html"]
    json.dumps(bundle, allow_nan=False)


def test_names_of_plots():
    assert fit_of("weibull").plots[:5] == ["life", "probability", "curve", "posterior", "pairs"]
    assert fit_of("joint").plot("residuals").figures == ["check"] and fit_of("joint").plot("life").figures == ["life"]
    for fit in (fit_of("weibull"), fit_of("joint")):
        for name in fit.plots:
            assert fit.plot(name).name == name
    with pytest.raises(ww.InputError, match="plot: 'survival' is not a plot of this fit; it has life, probability, .* belief-slope"):
        fit_of("weibull").plot("survival")
    with pytest.raises(ww.InputError, match="report=False"):
        fit_of("groups").plot("life")


@pytest.mark.parametrize("name", ["weibull", "joint"])
def test_pictures_without_scripts_hold_every_point(name):
    fit = fit_of(name)
    clips = set()
    for each in fit.plots:
        plot = fit.plot(each)
        if plot.figures != [each]:
            continue
        page = plot.to_html()
        tree = ElementTree.fromstring(page[page.index("<svg"):page.index("</svg>") + 6])
        assert "nan" not in page and "inf" not in page.lower().replace("information", "")
        marks, across, up = marks_module.marks_of(plot._figures[0]["specification"])
        points = sum(sum(map(math.isfinite, mark.columns["y"])) for mark in marks if mark.kind == "point" and mark.shape == "circle")
        assert len(tree.findall(".//{*}circle")) == points
        assert across.low < across.high and up.low < up.high and (len(marks_module.ticks_of(across)) >= 2 or not across.numbers)
        clips.add(tree.find(".//{*}clipPath").get("id"))
    assert len(clips) == len([each for each in fit.plots if fit.plot(each).figures == [each]])


class Axes:
    """Axes that keep what is drawn on them, as matplotlib's take it."""

    def __init__(self):
        self.calls = []

    def __getattr__(self, name):
        if name in ("flat", "__iter__"):
            raise AttributeError(name)  # one, not several
        return lambda *arguments, **options: self.calls.append((name, arguments, options))

    def of(self, name):
        return [(arguments, options) for each, arguments, options in self.calls if each == name]


def test_matplotlib_gets_the_same_numbers():
    ax = Axes()
    assert fit_of("weibull").plot("probability", ax=ax) is ax
    (x, y), options = ax.of("scatter")[0]
    assert list(x) == sorted(pumps["hours"][pumps["failed"] == 1]) and options["label"] == "observed"
    assert np.all(np.diff(y) > 0)
    assert ax.of("set_xscale")[0][0] == ("log",) and ax.of("set_ylabel")[0][0] == ("Failed [%]",)
    assert {"5", "50", "90"} <= set(ax.of("set_yticklabels")[0][0][0])
    assert len(ax.of("fill_between")) == len(ax.of("plot")) == 1 and ax.of("legend")
    rules = Axes()
    fit_of("joint").plot("residuals", ax=rules)
    assert rules.of("vlines") and rules.of("axhline") and len(rules.of("scatter")[0][0][0]) == 5
    both = [Axes(), Axes()]
    fit_of("joint").plot("posterior", ax=both)
    assert [each.of("set_title")[0][0][0].split(",")[0] for each in both] == ["k", "sigma"] and both[0].of("bar")
    with pytest.raises(ww.InputError, match="1 axes for the 2 figures belief-k, belief-sigma"):
        fit_of("joint").plot("posterior", ax=Axes())
    with pytest.raises(ww.InputError, match="ax: int is no axes of matplotlib"):
        fit_of("weibull").plot("probability", ax=3)


def test_numbers_of_axes():
    assert [marks_module.number_text(each) for each in (0, 0.05, 1e-6, 2e7, 12345)] == ["0", "0.05", "10⁻⁶", "2×10⁷", "12345"]
    linear = marks_module.Axis("", False, 0.0, 10.3, None, True)
    assert [at for at, _ in marks_module.ticks_of(linear)] == [0, 2, 4, 6, 8, 10]
    assert [label for _, label in marks_module.ticks_of(linear._replace(logarithmic=True, low=0.9, high=1100.0))] == ["1", "10", "100", "1000"]


# ---- Lives.

def draws(fit):
    return fit.draws["characteristic"].to_numpy(), fit.draws["slope"].to_numpy()


def agrees(found, values):
    """Within five standard errors of the mean over independent draws."""
    return abs(found - values.mean()) < 5 * values.std() / math.sqrt(len(values))


def test_survival_hazard_and_percentiles_are_of_the_posterior():
    fit = fit_of("weibull")
    scale, shape = draws(fit)
    survival = fit.survival_function([100, "1 d", 500])
    assert survival.index.name == "hours" and list(survival.index) == [100, "1 d", 500]
    for at, hours in ((100, 100), ("1 d", 24), (500, 500)):
        share = np.exp(-(hours / scale)**shape)
        assert agrees(survival.loc[at, "predictive"], share)
        assert abs(survival.loc[at, "q05"] - np.quantile(share, 0.05)) < 0.03
    hazard = fit.hazard(300)
    assert hazard.attrs["unit"] == "1/h"
    assert abs(hazard.loc[300, "q50"] / np.median(shape / scale * (300 / scale)**(shape - 1)) - 1) < 0.05
    lives = fit.percentile([10, "0.1 %"])
    assert list(lives.index) == [10, 0.1] and lives.attrs["unit"] == "h"
    tenth = scale * (-np.log(0.9))**(1 / shape)
    assert abs(lives.loc[10, "q50"] / np.median(tenth) - 1) < 0.03 and lives.loc[10, "q05"] < lives.loc[10, "bound"] < lives.loc[10, "q50"]
    # Of the next item a tenth fails by then.
    assert abs(fit.survival_function(lives.loc[10, "predictive"]).iloc[0]["predictive"] - 0.9) < 1e-5
    assert fit.percentile(10, confidence=0.5).iloc[0]["bound"] > lives.loc[10, "bound"]


def test_remaining_lives_and_mean_lives():
    fit = fit_of("weibull")
    found = fit.conditional(300, b=[10])
    assert list(found["unit"]) == ["%", "h", "h"]
    assert abs(found.loc["survival to 300 h", "predictive"] / 100 - fit.survival_function(300).iloc[0]["predictive"]) < 1e-6
    left = found.loc["B10 remaining useful life", "predictive"]
    both = fit.survival_function([300, 300 + left])["predictive"]
    assert abs(both.iloc[1] / both.iloc[0] - 0.9) < 1e-4


def test_groups_are_rows():
    fit = fit_of("groups")
    lives = fit.percentile([10, 50])
    assert lives.index.names == ["supplier", "p"] and list(lives.index.get_level_values(0).unique()) == ["A", "B"]
    assert lives.loc[("B", 10), "q50"] < lives.loc[("A", 10), "q50"]
    asked = fit.percentile(10, pd.DataFrame({"supplier": ["B", "A"]}))
    assert list(asked.index) == [("B", 10), ("A", 10)] and asked.loc[("B", 10)].equals(lives.loc[("B", 10)])
    assert fit.percentile(10, {"supplier": "B"}).loc[("B", 10)].equals(lives.loc[("B", 10)])
    for given, message in (({"supplier": "C"}, "supplier has no 'C' \\(A, B\\)"), ({"suplier": "A"}, "no condition 'suplier' \\(conditions: supplier\\)"),
                           ({"supplier": [None]}, "row 1: supplier has no value"), (pd.DataFrame({"supplier": []}), "has no rows")):
        with pytest.raises(ww.InputError, match=message):
            fit.percentile(10, given)


@pytest.mark.parametrize("p, message", [(0.1, "write '0.1 %'.*percentile of lifelines"), (0, "holds 0"), (100, "holds 100"), ("10", "holds '10'"),
                                        (True, "holds True"), ([], "p is empty")])
def test_percentages_that_may_be_fractions_are_refused(p, message):
    with pytest.raises(ww.InputError, match=message):
        fit_of("weibull").percentile(p)


def test_what_measures_no_lives_answers_none():
    with pytest.raises(ww.InputError, match="model formula"):
        fit_of("joint").survival_function(100)
    study = ww.Study("V = k*s", {"s": [1.0, 2.0, 3.0], "V": [1.1, 1.9, 3.2]}, priors={"k": ww.half_normal(5), "sigma": ww.half_normal(5)})
    fit = study.fit(seed=1, method="exact", draws=10, report=False)
    with pytest.raises(ww.InputError, match="this study measures V; .*fit.life"):
        fit.percentile(10)
    assert fit.predict({"s": [2.0]}).shape == (1, 3)  # as before


def test_predictions_of_lives():
    fit = fit_of("groups")
    mean = fit.predict(pd.DataFrame({"supplier": ["B"]}, index=["x"]))
    of_b = fit.parameters.loc["mean_life[B]"]
    assert list(mean.index) == ["x"] and mean.attrs["unit"] == "h"
    np.testing.assert_allclose(mean.loc["x", ["mean", "lower", "upper"]].astype(float), of_b[["mean", "q05", "q95"]].astype(float), rtol=1e-3)
    following = fit.predict({"supplier": ["B"]}, kind="next")
    assert following.loc[0, "mean"] == mean.loc["x", "mean"] and following.loc[0, "upper"] > mean.loc["x", "upper"]
    assert abs(fit.survival_function(following.loc[0, "lower"], {"supplier": "B"})["predictive"].iloc[0] - 0.95) < 1e-4
    with pytest.raises(ww.InputError, match="90 %"):
        fit.predict({"supplier": ["A"]}, level=0.5)
    with pytest.raises(ww.InputError, match="kind='next'"):
        fit.predict({"supplier": ["A"]}, kind="unit")


def test_comparisons_by_name():
    both = ww.compare({"weibull": fit_of("weibull"), "lognormal": fit_of("lognormal")})
    assert {each["study"] for each in both.summary["studies"]} == {"weibull", "lognormal"}
    assert fit_of("weibull").compare(fit_of("lognormal"), names=["weibull", "lognormal"]).summary == both.summary
    with pytest.raises(ww.InputError, match="leave names out"):
        ww.compare({"a": fit_of("weibull")}, names=["a"])


def test_summary_is_a_frame_of_one_screen():
    fit = fit_of("weibull")
    assert list(fit.summary.index) == ["characteristic", "slope"] and fit.summary["q50"].equals(fit.parameters["q50"])
    assert len(repr(fit)) < 120 and "prior" in fit.summary and fit.results["model"] == "formula"


def test_conditions_with_units_in_their_headings_are_those_in_their_units():
    tests = {"T [degC]": [80.0] * 4 + [120.0] * 4, "hours": [900, 1100, 1300, 1500, 300, 350, 420, 500]}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        fit = ww.life(tests, "hours", units={"hours": "h"}, stress={"T": "arrhenius"}, seed=1, method="exact", draws=100, report=False)
    found = fit.percentile(10, given=pd.DataFrame({"T [K]": [323.15, 373.15]}))
    assert found.index.names == ["T", "p"]
    assert np.allclose(found["predictive"], fit.percentile(10, given={"T": ["50 degC", "100 degC"]})["predictive"], rtol=1e-9)
    one, other = (fit.life(b=10, survived=each, given={"T": "80 degC"}) for each in (300, "300 h"))
    assert one.equals(other)


def test_conditions_that_differ_between_units_are_distributions():
    tests = {"T [degC]": [80.0] * 4 + [120.0] * 4, "hours": [900, 1100, 1300, 1500, 300, 350, 420, 500]}
    spread = {"T": {"distribution": "normal", "mean": "90 degC", "sd": "5 K"}}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        fit = ww.life(tests, "hours", units={"hours": "h"}, stress={"T": "arrhenius"}, given=spread, seed=1, method="exact", draws=100, report=False)
        at = ww.life(tests, "hours", units={"hours": "h"}, stress={"T": "arrhenius"}, given={"T": "90 degC"}, seed=1, method="exact", draws=100,
                     report=False)
    lives = [each.results["quantities"][0] for each in (fit, at)]
    assert "T ~ normal (mean 90, sd 5 degC)" in lives[0]["at"]
    assert lives[0]["b10"] < lives[1]["b10"] and lives[0]["q95"] > lives[1]["q95"]
    two = at.percentile(10, given={"T": {"values": ["90 degC", "90 degC"]}})
    assert np.allclose(two["predictive"], at.percentile(10, given={"T": "90 degC"})["predictive"], rtol=1e-3)
