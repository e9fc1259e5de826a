"""Lives at any level, remaining useful lives, and measurements of items that were seen: against sums over the draws by numpy."""

import math
import os
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import source
from test_data import _rate, frame, study, units

_normal_below = np.vectorize(lambda z: 0.5 * math.erfc(-z / math.sqrt(2)))


@pytest.fixture(scope="module")
def fit():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return study(frame).fit(seed=1, method="exact", draws=500, report=False)


@pytest.fixture(scope="module")
def of_unit(fit):
    """Of each draw a grid of k of joint J5 with its weights given all that was read of it."""
    own = frame[frame["joint"] == "J5"]
    work, wear = (own["F"] * own["s"]).to_numpy(), own["V"].to_numpy()
    draws = fit.draws[["k", "sigma", "k_scatter"]].to_numpy()[:, :, None]
    rate = (work * wear).sum() / (work**2).sum() * np.exp(np.linspace(-0.2, 0.2, 401))
    log = -0.5 * (np.log(rate / draws[:, 0]) / draws[:, 2]) ** 2
    for w, v in zip(work, wear):
        log = log - 0.5 * ((v - rate * w) / draws[:, 1]) ** 2
    weight = np.exp(log - log.max(axis=1, keepdims=True))
    return rate, weight / weight.sum(axis=1, keepdims=True) / len(draws), draws


asked = dict(limit="10 mm^3", along="s", given={"F": "200 N"})


def test_b_lives_of_a_new_joint(fit):
    """Life is limit/(k F), lognormal over joints: B-lives of all joints by each draw, and of the next one mixed over them."""
    levels = [1, 10, 5, 0.1]
    found = fit.life(**asked, b=levels, confidence=0.95)
    assert list(found["name"]) == ["life", *(f"B{b:g} life" for b in levels)]
    middle = 10 / (fit.draws["k"] * 200)
    for b in levels:
        row = found[found["name"] == f"B{b:g} life"].iloc[0]
        assert row["predictive"] == found.loc[0, f"b{b:g}"]
        below = _normal_below(np.log(row["predictive"] / middle) / fit.draws["k_scatter"]).mean()
        assert below == pytest.approx(b / 100, rel=0.15)  # 2000 draws
        low, high = -10.0, 0.0
        for _ in range(60):
            low, high = ((low + high) / 2, high) if _normal_below((low + high) / 2) < b / 100 else (low, (low + high) / 2)
        of_all = middle * np.exp(fit.draws["k_scatter"] * low)
        assert row["q50"] == pytest.approx(of_all.quantile(0.5), rel=0.03)
        assert row["bound"] == pytest.approx(of_all.quantile(0.05), rel=0.1)  # an error of about 4 % of 2000 draws
        assert row["q05"] == row["bound"]  # exceeded with 95 %
    half = fit.life(**asked, b=10, confidence=0.5)
    assert half.loc[1, "bound"] == half.loc[1, "q50"] and list(half.columns[-3:]) == ["b10", "predictive", "bound"]


def test_remaining_life_of_a_joint_that_was_seen(fit, of_unit):
    rate, weight, _ = of_unit
    left = 10 / (200 * rate) - 75e3  # what it has worn at 300 N in 50 km, it would have at 200 N in 75
    order = np.argsort(left)
    below = np.cumsum(weight.sum(axis=0)[order])
    found = fit.life(**asked, b=[5, 40], confidence=0.9, unit="J5").iloc[0]
    assert found["of"] == "joint J5" and found["at"].endswith("from 50000 m on")
    width = found["q95"] - found["q05"]
    for p, value in ((0.05, found["q05"]), (0.5, found["q50"]), (0.4, found["b40"]), (0.1, found["bound"])):
        assert value == pytest.approx(np.interp(p, below, left[order]), abs=0.04 * width)
    # Given that it has come to the middle of that.
    place = 50e3 + found["q50"]
    survived = fit.life(**asked, b=[10], unit="J5", survived=f"{place} m")
    assert survived.loc[0, "q50"] == pytest.approx(np.interp(0.75, below, left[order]) - found["q50"], abs=0.04 * width)
    assert survived.loc[0, "b10"] == pytest.approx(np.interp(0.55, below, left[order]) - found["q50"], abs=0.04 * width)
    assert survived.loc[1, "name"].startswith("survival to ") and survived.loc[1, "q50"] == pytest.approx(50, abs=1e-6)


def test_next_joint_given_that_it_came_so_far(fit):
    found = fit.life(**asked, b=[10], survived="400 km")
    middle, scatter = 10 / (fit.draws["k"] * 200), fit.draws["k_scatter"]

    def outlasts(life):
        return _normal_below(-np.log(life / middle) / scatter)

    left = found[found["name"] == "remaining useful life"].iloc[0]
    for p, value in ((0.1, left["b10"]), (0.5, left["q50"]), (0.95, left["q95"])):
        assert outlasts(4e5 + value).mean() / outlasts(4e5).mean() == pytest.approx(1 - p, abs=0.02)
    survival = found[found["name"] == "survival to 400 km"].iloc[0]
    assert survival["q50"] == pytest.approx(100 * outlasts(4e5).mean(), abs=2)


def test_measurements_of_a_joint_that_was_seen(fit, of_unit):
    rate, weight, draws = of_unit
    new = pd.DataFrame({"joint": ["J5", None], "F": [300.0, 300.0], "s": [6e4, 6e4]}, index=["seen", "new"])
    found = fit.predict(new, kind="unit", along="s")
    work = 300 * 6e4
    mean = (weight.sum(axis=0) * rate).sum() * work
    assert found.loc["seen", "mean"] == pytest.approx(mean, rel=2e-3)
    for end, p in (("lower", 0.05), ("upper", 0.95)):
        below = (weight * _normal_below((found.loc["seen", end] - work * rate) / draws[:, 1])).sum()
        assert below == pytest.approx(p, abs=0.01)
    assert found.loc["new"].equals(fit.predict(new, kind="next", along="s").loc["new"])
    half = fit.predict(new, level=0.5, kind="unit", along="s").loc["seen"]
    assert found.loc["seen", "lower"] < half["lower"] < half["upper"] < found.loc["seen", "upper"]
    # Under another force beyond its last row the path goes on from where it stands: 75 km at 200 N.
    on = fit.predict({"joint": ["J5"], "F": [200.0], "s": [6e4]}, kind="unit", along="s")
    assert on.loc[0, "mean"] == pytest.approx(mean / work * 200 * 85e3, rel=2e-3)
    # And before it the formula is that of the data.
    past = fit.predict({"joint": ["J5"], "F": [100.0], "s": [3e4]}, kind="unit", along="s")
    assert past.loc[0, "mean"] == pytest.approx(mean / work * 100 * 3e4, rel=2e-3)


def test_units_lie_as_their_data_do(fit):
    found = fit.predict(frame, kind="unit", along="s")
    assert ((found["lower"] < frame["V"]) & (frame["V"] < found["upper"])).mean() > 0.8
    best = frame.assign(V=found["mean"]).groupby("joint").last()
    np.testing.assert_allclose(best["V"] / (best["F"] * best["s"]), [_rate[j] for j in best.index], rtol=0.1)


@pytest.mark.parametrize("options, message", [
    ({"unit": "J99"}, "no item 'J99' \\(items: J1"), ({"b": [0]}, "b holds 0"), ({"b": [100]}, "b holds 100"), ({"b": []}, "b is empty"),
    ({"b": "B10"}, "b holds 'B10'"), ({"confidence": 95}, "confidence is 95"), ({"along": None}, "along is missing"),
    ({"unit": "J5", "survived": "30 km"}, "the last row of J5 is at 50000 m"), ({"survived": 5}, "survived: 5 has no unit"),
    ({"unit": "J5", "survived": "3000 km"}, "J5 survives to 3000 km with a probability of 0 %"), ({"limit": None, "unit": "J5"}, "unit needs a limit"),
    ({"survived": "3 N"}, "survived")])
def test_lives_that_cannot_be_had_are_refused(fit, options, message):
    with pytest.raises(ValueError, match=message):
        fit.life(**{**asked, **options})


def test_columns_that_a_prediction_does_not_need_are_ignored(fit):
    new = pd.DataFrame({"F": [150.0, 250.0], "s": [5e4, 6e4]})
    expected = fit.predict(new)
    pd.testing.assert_frame_equal(fit.predict(new.assign(note=[[1], [2]], day="Monday", V=1.0)), expected)
    of_headings = pd.DataFrame({"F [kN]": [0.15, 0.25], "s [m]": [5e4, 6e4]})
    pd.testing.assert_frame_equal(fit.predict(of_headings, along="s"), expected)
    for wrong, message in (new[["s"]].assign(note="x"), r"^new has no column 'F' \(its columns: s, note\)$"), \
            (new.rename(columns={"s": "path"}), "^new has no column 's'"), (new.set_index("F"), r"^new has no column 'F'; .* new.reset_index\(\)"):
        with pytest.raises(ww.InputError, match=message):
            fit.predict(wrong)


@pytest.mark.parametrize("new, options, message", [
    ({"F": [300.0], "s": [6e4]}, {}, "no column 'joint'"),
    ({"joint": ["J9"], "F": [300.0], "s": [6e4]}, {}, "column 'joint': the data have no joint 'J9' \\(J1, .*empty cell"),
    ({"joint": ["J5"], "F": [300.0], "s": [np.nan]}, {}, "row 1, column 's': a value is missing"),
    ({"joint": ["J5"], "F": [np.inf], "s": [6e4]}, {}, "row 1, column 'F': inf is not a finite number"),
    ({"joint": ["J5"], "F": [300.0], "s": [6e4]}, {"along": None}, "along is missing: the column along which it wears \\(F, s\\)"),
    ({"joint": ["J5"], "F": [300.0], "s": [6e4]}, {"kind": "units"}, "'mean', 'next' or 'unit'"),
])
def test_measurements_that_cannot_be_had_are_refused(fit, new, options, message):
    with pytest.raises(ValueError, match=message):
        fit.predict(new, **{"kind": "unit", "along": "s", **options})


def test_kind_unit_where_nothing_differs():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        alike = study(frame, unit=None).fit(seed=1, method="exact", draws=100, report=False)
    with pytest.raises(ValueError, match="needs a study with random effects"):
        alike.predict({"F": [1.0], "s": [1.0]}, kind="unit")
    one = alike.life(limit="10 mm^3", along="s", given={"F": "200 N"}, b=[20], confidence=0.8)
    assert len(one) == 1 and one.loc[0, "bound"] == one.loc[0, "b20"]  # of one thing these are one number
    assert one.loc[0, "q50"] == pytest.approx(10 / (200 * alike.parameters.loc["k", "q50"]), rel=1e-3)


def test_several_measured_columns_and_places():
    """Each row has its own numbers, whatever the order of columns and rows."""
    data = frame.assign(h=frame["V"] / 40)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        two = ww.Study(formula={"worn": "k*F*s"}, data=data, units={**units, "h": "mm"}, constants={"A": "40 mm^2"}, priors={
            "k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3"), "delta": ww.half_normal("1 mm")},
            likelihood={"V": {"family": "normal", "mean": "worn", "sd": "sigma"},
                        "h": {"family": "normal", "mean": "worn/A", "sd": "delta"}}).fit(seed=1, method="exact", draws=100, report=False)
    found = two.predict({"F": [100.0, 100.0, 200.0], "s": [3e4, 6e4, 3e4]})
    np.testing.assert_allclose(found["V mean"] / found["V mean"][0], [1, 2, 2], rtol=1e-3)
    np.testing.assert_allclose(found["h mean"] * 40, found["V mean"], rtol=1e-3)


def test_program_and_python_agree(fit, wearwell, tmp_path):
    """The same numbers from the study file with the documented keys."""
    frame.to_csv(tmp_path / "data.csv", index=False)
    text = fit.study.toml.replace('file = "data"', 'file = "data.csv"') + (
        '[predict]\nalong = "s"\nlimit = { "k*F*s" = "10 mm^3" }\ngiven = { F = "200 N" }\nb_lives = [5, 0.1]\n'
        'credible_level = 0.95\nsurvived = "400 km"\nat = "60 km"\nunits = ["J5"]\n')
    (tmp_path / "study.toml").write_text(text)
    code, out, error = wearwell("fit", tmp_path / "study.toml", "--seed", 1, "--method", "exact", "--draws", 500, "--no-report",
                                "--json", "-o", tmp_path / "results")
    assert code <= 1, error
    import json

    said = json.loads(out)
    told = {(q["name"], q["of"]): q for q in said["quantities"]}
    here = fit.life(**asked, b=[5, 0.1], confidence=0.95, unit="J5", survived="400 km")
    assert told["B5 remaining useful life", "joint J5"]["predictive"] == here.loc[0, "b5"]
    assert told["B0.1 remaining useful life", "joint J5"]["bound"] == here.loc[0, "bound"]
    of_new = fit.life(**asked, b=[5, 0.1], confidence=0.95, survived="400 km").set_index("name")
    assert told["B5 remaining useful life", "joint"]["bound"] == of_new.loc["B5 remaining useful life", "bound"]
    unit = [p for p in said["predictions"] if p.get("mean_of") == "joint J5"]
    row = fit.predict({"joint": ["J5"], "F": [200.0], "s": [6e4]}, kind="unit", along="s").loc[0]
    assert (unit[0]["mean"], unit[0]["pi95"]) == (row["mean"], row["upper"])
    # Every row of a table says whose it is.
    written = pd.read_csv(tmp_path / "results" / "predictions.csv", float_precision="round_trip")
    assert written["of"].tolist() == ["new joint", "joint J5"] and written["mean"][1] == row["mean"]
    again = ww.fit(tmp_path / "study.toml", seed=1, method="exact", draws=500)
    assert again.tables["predictions"]["Of"].tolist() == ["median joint, readings of a new joint", "joint J5"]
    assert "joint J5, 90 %" in str(again) and "reading of joint J5, 90 %" in str(again)


@pytest.fixture(scope="module")
def joint():
    return ww.fit(os.path.join(source, "examples", "joint", "study.toml"), seed=3, report=False)


def test_life_of_the_worn_joint(joint):
    """Of one thing B-lives are quantiles of its life: by the draws limit/(k work a cycle)."""
    found = joint.life(limit="80 mm^3", b=[1, 5, 50], confidence=0.95)
    lives = 80 / (joint.draws["k"] * 5.966)
    assert len(found) == 1 and found.loc[0, "bound"] == pytest.approx(found.loc[0, "b5"], rel=1e-9) and found.loc[0, "b5"] == found.loc[0, "q05"]
    assert found.loc[0, "b50"] == pytest.approx(lives.quantile(0.5), rel=0.02)
    assert found.loc[0, "b5"] == pytest.approx(lives.quantile(0.05), rel=0.02)
    assert joint.life(b=[10]).loc[0, "b10"] == joint.lives.loc[0, "b10"]
    for options, message in (({"unit": "J1"}, "leave unit out"), ({"survived": 1000}, "inspect"), ({"along": "cycles"}, "leave along out")):
        with pytest.raises(ValueError, match=message):
            joint.life(**options)


def test_lives_of_bearings_and_sn_tests():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        bearing = ww.fit(os.path.join(source, "examples", "bearing", "study.toml"), seed=1, report=False)
        tests = ww.fit(os.path.join(source, "examples", "fatigue", "study.toml"), seed=1, method="exact", report=False)
    found = bearing.life(b=[10, 3], confidence=0.8).set_index(["name", "unit"])
    own = bearing.quantities[(bearing.quantities["of"] == "new bearing") & (bearing.quantities["unit"] == "revolutions")].iloc[0]
    assert found.loc[("B10 life", "revolutions"), "predictive"] == own["b10"] == found.loc[("life", "revolutions"), "b10"]
    # The 10 % quantile of all bearings: the median one's, with the wear rate 1.2816 log_sd faster.
    scatter = bearing.draws.iloc[:, list(bearing.draws.columns).index(next(c for c in bearing.draws if "scatter" in c))]
    ratio = (found.loc[("B3 life", "revolutions"), "q50"] / found.loc[("B10 life", "revolutions"), "q50"])
    assert ratio == pytest.approx(float(np.exp(-(1.8808 - 1.2816) * scatter.median())), rel=0.05)
    sn = tests.life(b=[0.1], confidence=0.95)
    sn = sn[sn["name"] == "B0.1 life"]
    np.testing.assert_allclose(sn["bound"], sn["q05"], rtol=1e-9)  # exceeded with 95 %
    assert len(sn) == 2
    with pytest.raises(ValueError, match="leave limit out"):
        tests.life(limit="3 mm")


def test_weibull_lives_given_that_they_were_reached():
    life = ww.fit(os.path.join(source, "examples", "life", "study.toml"), seed=1, method="exact", report=False)
    found = life.life(b=[10], confidence=0.95, survived="60e6 cycles").set_index("name")
    eta, beta = (life.draws[c] for c in life.draws.columns[:2])
    scale = 1e6 if life.parameters["unit"][0] == "cycles" else 1

    def outlasts(millions):
        return np.exp(-(millions * scale / eta) ** beta)

    for p, value in ((0.1, found.loc["remaining useful life", "b10"]), (0.5, found.loc["remaining useful life", "q50"])):
        assert (outlasts(60 + value).mean() / outlasts(60).mean()) == pytest.approx(1 - p, abs=0.01)
    with pytest.raises(ValueError, match="survived is 60 without a unit, and life is in '1e6 cycles'"):
        life.life(survived=60)
    # Where the library determines no life, the number is NaN or refused, never infinite; a little earlier it is determined.
    for place, determined in (("250e6 cycles", True), ("280e6 cycles", False), ("900e6 cycles", False)):
        later = life.ask({"survived": place})["quantities"]
        assert [each.get("undetermined", False) for each in later if "remaining" in each["name"]] == 3 * [not determined], place
        for ask in (life.life, life.conditional):
            if determined:
                assert np.isfinite(ask(survived=place)["q50"]).all()
                continue
            with pytest.raises(ValueError, match=f"survived: a new item survives to {place} with a probability of 0?.?[0-9e.-]+ %; lives from "
                                                 "there on need at least 0.1 %"):
                ask(survived=place)


def test_studies_of_other_models_are_refused_in_words():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        stairs = ww.fit(os.path.join(source, "examples", "staircase", "study.toml"), seed=1, method="exact", draws=100, report=False)
    with pytest.raises(ValueError, match="of the model staircase"):
        stairs.life(limit="1 mm")
