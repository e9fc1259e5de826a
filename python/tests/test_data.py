"""Tables of every kind give the same fit; what is none is refused by column and row."""

import os
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from arrow_stream import Stream

# Wear of six joints, simulated: 1e-7 mm^3/(N m) in the median joint, 30 % scatter, readings good to 0.1 mm^3.
_rng = np.random.default_rng(1)
_rate = dict(zip([f"J{i}" for i in range(1, 7)], 1e-7 * np.exp(0.3 * _rng.normal(size=6))))
_rows = [(j, float(force), 1e4 * (3 + i), _rate[j] * force * 1e4 * (3 + i) + 0.1 * _rng.normal())
         for j in _rate for i, force in enumerate((100, 200, 300))]
frame = pd.DataFrame(_rows, columns=["joint", "F", "s", "V"])
units = {"F": "N", "s": "m", "V": "mm^3"}
priors = {"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3")}


def study(data, **options):
    return ww.Study(**{**dict(formula="V = k*F*s", data=data, units=units, priors=priors, unit="joint"), **options})


def fitted(data, **options):
    """All joints alike: two parameters, and so quick."""
    options = {"unit": None, **options}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return study(data, **options).fit(seed=1, method="exact", draws=100, report=False)


@pytest.fixture(scope="module")
def usual():
    return fitted(frame)


@pytest.fixture(scope="module")
def varying():
    return fitted(frame, unit="joint")


def test_finds_what_the_data_were_made_with(varying):
    k = varying.parameters.loc["k"]
    assert k["unit"] == "mm^3/(N m)" and k["exact"]
    middle = np.exp(np.mean(np.log(list(_rate.values()))))
    assert k["q05"] < middle < k["q95"]
    assert 0.04 < varying.parameters.loc["sigma", "mean"] < 0.2
    assert list(varying.parameters.index) == ["k", "sigma", "k_scatter"]


def test_is_the_program_with_the_same_table(usual, wearwell, tmp_path):
    """The study's own text beside a CSV file of the same numbers: summary.json to the bit, but for the file's name."""
    frame.to_csv(tmp_path / "data.csv", index=False)
    text = usual.study.toml.replace('file = "data"', 'file = "data.csv"')
    (tmp_path / "study.toml").write_text(text)
    code, out, error = wearwell("fit", tmp_path / "study.toml", "--seed", 1, "--method", "exact", "--draws", 100, "--no-report",
                                "--json", "-o", tmp_path / "results")
    assert code <= 1, error
    assert out.replace("data.csv", "data") == usual._summary_text


def kinds():
    columns = {name: frame[name].to_numpy() for name in frame}
    structured = np.empty(len(frame), dtype=[("joint", "U2"), ("F", "f8"), ("s", "f8"), ("V", "f8")])
    for name in columns:
        structured[name] = columns[name]
    wide = np.zeros((len(frame), 6))
    wide[:, ::2] = frame[["F", "s", "V"]].to_numpy()
    yield "dict of arrays", columns
    yield "dict of lists", {name: values.tolist() for name, values in columns.items()}
    yield "structured array", structured
    yield "strided views", {"joint": columns["joint"], "F": wide[:, 0], "s": wide[:, 2], "V": wide[:, 4]}
    yield "whole numbers and half precision", {**columns, "F": columns["F"].astype("int16"), "s": columns["s"].astype("uint64")}
    yield "big-endian", {**columns, "V": columns["V"].astype(">f8")}
    yield "categories", frame.assign(joint=frame["joint"].astype("category"))
    yield "nullable", frame.assign(F=frame["F"].astype("Int64"), joint=frame["joint"].astype("string"))
    yield "masked", {**columns, "F": np.ma.masked_array(columns["F"], mask=False)}
    yield "DuckDB relation", type("Relation", (), {"fetchnumpy": lambda self: {
        n: np.ma.masked_array(v, mask=False) for n, v in columns.items()}})()
    yield "other columns beside", frame.assign(when=pd.Timestamp("2026-01-01"), note=None)
    yield "units in headings", frame.rename(columns={"F": "F [N]", "s": "s [m]", "V": "V [mm^3]"})
    yield "Arrow", Stream([(n, "u" if n == "joint" else "g", frame[n].tolist()) for n in frame], [10, 0, 8])


@pytest.mark.parametrize("data", [pytest.param(d, id=n) for n, d in kinds()])
def test_any_kind_of_table_gives_the_same_bits(data, usual):
    named = isinstance(data, pd.DataFrame) and "F [N]" in data
    assert fitted(data, units=None if named else units).results == usual.results


def test_pint_quantities_bring_their_units(usual):
    pint = pytest.importorskip("pint")
    ureg = pint.UnitRegistry()
    data = {"joint": frame["joint"], "F": frame["F"].to_numpy() * ureg.newton, "s": frame["s"].to_numpy() * ureg.metre,
            "V": frame["V"].to_numpy() * ureg.mm**3}
    found = fitted(data, units=None, priors={"k": ww.lognormal(1e-7 * ureg.mm**3 / (ureg.newton * ureg.metre), log_sd=3),
                                             "sigma": ww.half_normal(5 * ureg.mm**3)})
    np.testing.assert_allclose(found.parameters["mean"].to_numpy(), usual.parameters["mean"].to_numpy(), rtol=1e-9)


def test_units_as_units_of_another_size(usual):
    data = frame.assign(F=frame["F"] / 1000)
    found = fitted(data, units={**units, "F": "kN"})
    np.testing.assert_allclose(found.parameters["mean"].to_numpy(), usual.parameters["mean"].to_numpy(), rtol=1e-9)


def test_parquet_and_csv_files(usual, tmp_path):
    path = tmp_path / "wear.csv"
    frame.to_csv(path, index=False)
    found = fitted(path)
    np.testing.assert_array_equal(found.parameters["mean"].to_numpy(), usual.parameters["mean"].to_numpy())


@pytest.mark.parametrize("change, message", [
    (lambda d: d.assign(F=[1j] * len(d)), "column 'F' holds complex numbers"),
    (lambda d: d.assign(F=pd.date_range("2026-01-01", periods=len(d))), "column 'F' holds dates or times"),
    (lambda d: d.assign(F=pd.date_range("2026-01-01", periods=len(d), tz="UTC")), "column 'F' holds dates, times or intervals \\(datetime64\\[ns, UTC"),
    (lambda d: d.assign(F=pd.Categorical(pd.date_range("2026-01-01", periods=len(d), tz="UTC"))), "column 'F' holds dates"),
    (lambda d: d.assign(F=pd.to_timedelta(range(len(d)), unit="h")),
     "column 'F' holds dates or times \\(timedelta64\\[ns\\]\\); divided by pandas.Timedelta\\('1h'\\) they are hours"),
    (lambda d: d.assign(F=pd.period_range("2026", periods=len(d))), "column 'F' holds dates, times or intervals \\(period"),
    (lambda d: d.assign(F=pd.interval_range(0, len(d))), "column 'F' holds dates, times or intervals \\(interval"),
    (lambda d: {**d, "F": [pd.Timestamp("2026-01-01")] * len(d)}, "row 1, column 'F': Timestamp; dates and times"),
    (lambda d: d.assign(F=[{}] * len(d)), "row 1, column 'F': dict in a column of objects"),
    (lambda d: d.assign(F=["a"] + [1.5] * (len(d) - 1)), "row 2, column 'F': 1.5 is float, and above there is str"),
    (lambda d: d.assign(F=[1.5] * 6 + ["x"] + [1.5] * (len(d) - 7)), "row 7, column 'F': 'x' is str, and above there is float"),
    (lambda d: d.assign(F=pd.Categorical([1, "a"] * (len(d) // 2))), "row 2, column 'F': 'a' is str"),
    (lambda d: {**d, "F": [1.5] * 6 + ["x"] + [1.5] * (len(d) - 7)}, "row 7, column 'F': 'x' is str"),
    (lambda d: d.assign(F=[[1.5]] * len(d)), "row 1, column 'F': list in a column of objects"),
    (lambda d: d.assign(F=d["F"].astype("Int64").where(d.index != 4)), "row 5, column 'F': no value"),
    (lambda d: d.assign(F=pd.array([2**60 + 1] * len(d), dtype="Int64")), "column 'F': the whole number .* beyond 2\\^53"),
    (lambda d: d.assign(F=pd.array([True, None] * (len(d) // 2), dtype="boolean")), "row 2, column 'F': no value"),
    (lambda d: {**d, "F": np.ma.masked_equal(d["F"].to_numpy(), 200.0)}, "row 2, column 'F': no value"),
    (lambda d: {**d, "F": np.ma.masked_array(np.full(len(d), 1j))}, "column 'F' holds complex numbers"),
    (lambda d: {**d, "F": np.ma.masked_array(np.full(len(d), np.datetime64("2026-01-01")))}, "column 'F' holds dates"),
    (lambda d: {**d, "F": np.ma.masked_array(np.full(len(d), 2**60 + 1), mask=[True] + [False] * (len(d) - 1))}, "beyond 2\\^53"),
    (lambda d: d.set_axis(pd.MultiIndex.from_product([["a"], d.columns]), axis=1), "heading \\('a', 'joint'\\) has 2 levels"),
    (lambda d: d.rename(columns={"F": None}), "the heading None is NoneType"),
    (lambda d: d.assign(x=1).rename(columns={"x": 3}), "the heading 3 is int; headings are texts"),
    (lambda d: d["F"], "data is Series"),
    (lambda d: d.groupby("joint"), "data is DataFrameGroupBy; it may be a data frame"),
    (lambda d: {}, "data has no columns"),
    (lambda d: d.assign(joint=d["joint"].astype("category").where(d.index != 4)), "row 5, column 'joint': no value"),
    (lambda d: d.assign(joint="\ud800"), "row 1, column 'joint': the text is not Unicode"),
    (lambda d: d.assign(F=d["F"].where(d.index != 4)), "row 5, column 'F': no value"),
    (lambda d: d.assign(F=d["F"].where(d.index != 4, np.inf)), "row 5, column 'F': .*(finite|inf)"),
    (lambda d: d.assign(joint=d["joint"].where(d.index != 4, None)), "row 5, column 'joint': no value"),
    (lambda d: d.assign(F=[2**60] * len(d)), "beyond 2\\^53"),
    (lambda d: pd.concat([d, d["F"]], axis=1), "two columns are called 'F'"),
    (lambda d: d.iloc[:0], "has no rows"),
    (lambda d: pd.DataFrame(), "data has no columns"),
    (lambda d: {**d, "F": d["F"].tolist()[:-1]}, "rows"),
    (lambda d: {**d, "F": np.ones((len(d), 2))}, "column 'F' has 2 dimensions"),
    (lambda d: {**d, "F": "100 N"}, "column 'F' is str"),
    (lambda d: {**d, "F": [b"1"] * len(d)}, "column 'F' holds bytes"),
    (lambda d: d.rename(columns={"F": 7}), "the heading 7 is int; headings are texts \\(frame.columns = frame.columns.map\\(str\\)\\)"),
    (lambda d: [1, 2, 3], "list.*path of a file \\(pandas.DataFrame\\(data\\)\\)"),
    (lambda d: 3.5, "float"),
])
def test_what_is_no_table_is_refused_in_words(change, message):
    with pytest.raises(ValueError, match=message):
        study(change(frame))


@pytest.mark.parametrize("options, message", [
    ({"formula": "V k*F*s"}, "is not an equation"),
    ({"formula": ""}, "the formula is empty"),
    ({"formula": "W = k*F*s"}, "no left side of the formula is a column"),
    ({"formula": "V = k*F*s\nV = k"}, "gives 'V' twice"),
    ({"formula": "V = k*F"}, "m"),  # the dimensions, in the library's words
    ({"units": {"G": "N"}}, "no column 'G'"),
    ({"units": {"F": "Nn"}}, "Nn"),
    ({"unit": "joints"}, "no column 'joints'"),
    ({"priors": {"k": 1}}, "k is int"),
    ({"priors": {"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3)}}, "sigma"),
    ({"priors": {**priors, "k": ww.lognormal("1e-7 mm^2/(N m)", log_sd=3)}}, "'k\\*F\\*s' is m\\^2, but must be m\\^3"),
    ({"formula": "V = (k + b)*F*s", "priors": {**priors, "b": ww.half_normal("1e-7 mm^3/(N m)")}}, "which of k, b differ"),
    ({"unit": None, "random_effects": ["k"]}, "random_effects needs unit"),
    ({"family": "gamma"}, "likelihood="),
])
def test_studies_that_are_none_are_refused_in_words(options, message):
    with pytest.raises(ValueError, match=message):
        study(frame, **options)


def test_law_of_several_lines_and_two_that_vary():
    found = study(frame, formula={"work": "F*s", "V": "k*work + b"},
                  priors={**priors, "b": ww.normal("0 mm^3", "1 mm^3"), "b_scatter": ww.half_normal("0.1 mm^3")},
                  random_effects=["k", "b"])
    assert "k of each of 6 joints is lognormal about k with log_sd k_scatter; b of each of 6 joints is normal about b" in (
        found.description())
    assert '[random_effects.joint]\nk = { distribution = "lognormal", log_sd = "k_scatter" }\nb = { distribution = "normal", sd = "b_scatter" }' in (
        found.toml)


def test_predictions_under_new_conditions(varying):
    new = pd.DataFrame({"F": [100.0, 250.0], "s": [5e4, 1e5]}, index=["x", "y"])
    mean = varying.predict(new)
    k = varying.parameters.loc["k"]
    # The true mean of the median joint is k F s: what holds of k holds of it.
    np.testing.assert_allclose(mean["mean"], k["mean"] * new["F"] * new["s"], rtol=1e-4)
    np.testing.assert_allclose(mean["upper"], k["q95"] * new["F"] * new["s"], rtol=1e-4)
    assert mean.attrs["unit"] == "mm^3" and list(mean.index) == ["x", "y"]
    following = varying.predict(new, kind="next")
    assert (following["lower"] < mean["lower"]).all() and (following["upper"] > mean["upper"]).all()
    half = varying.predict(new, level=0.5, kind="next")
    assert (half["upper"] < following["upper"]).all()
    with pytest.raises(ValueError, match="no column 's'"):
        varying.predict({"F": [1.0], "G": [1.0]})
    with pytest.raises(ValueError, match="level"):
        varying.predict(new, level=90)


def test_lives_to_a_limit(varying):
    new = varying.life(limit="10 mm^3", b=[1, 10], along="s", given={"F": "200 N"})
    remaining = varying.life(limit="10 mm^3", along="s", given={"F": "200 N"}, unit="J5")
    # The median life is that of the median joint: limit/(k F).
    assert abs(new.loc[0, "q50"] * varying.parameters.loc["k", "q50"] * 200 / 10 - 1) < 0.05
    assert new.loc[0, "b1"] < new.loc[0, "b10"] < new.loc[0, "q50"]
    own = frame[frame["joint"] == "J5"]
    work = own["F"] * own["s"]
    own = 10 / ((work * own["V"]).sum() / (work**2).sum() * 200) - 7.5e4  # by its own least squares alone; 50 km at 300 N are 75 at 200
    assert remaining.loc[0, "q05"] < own < remaining.loc[0, "q95"]
    assert remaining.loc[0, "q95"] - remaining.loc[0, "q05"] < new.loc[0, "q95"] - new.loc[0, "q05"]


def test_lives_that_are_measured(examples):
    fit = ww.fit(os.path.join(examples, "life", "study.toml"), seed=1, report=False)
    told = fit.life(b=[1, 10], confidence=0.9)
    assert any("B10" in name for name in told["name"])
    later = fit.life(b=[20])
    assert any("B20" in name for name in later["name"])


def test_text_with_tables_in_memory(examples, usual):
    quick = dict(seed=1, method="exact", draws=100, report=False)
    text = open(os.path.join(examples, "fatigue", "study.toml")).read()
    table = pd.read_csv(os.path.join(examples, "fatigue", "tests.csv"), float_precision="round_trip")
    one = ww.Study.from_toml(text, {"tests.csv": table}).fit(**quick)
    two = ww.fit(os.path.join(examples, "fatigue", "study.toml"), **quick)
    assert one.results == two.results
    bare = text.replace('{ column = "stress_amplitude_MPa", unit = "MPa" }', '"stress_amplitude_MPa"')
    assert bare != text
    three = ww.Study.from_toml(bare, {"tests.csv": table}, units={"tests.csv": {"stress_amplitude_MPa": "MPa"}}).fit(**quick)
    assert three.parameters.equals(two.parameters)
    with pytest.raises(ValueError, match="no such file"):
        ww.Study.from_toml(text, {"other": table})


def test_studies_can_be_pickled(usual):
    import pickle

    again = pickle.loads(pickle.dumps(study(frame, unit=None)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        assert again.fit(seed=1, method="exact", draws=100, report=False).results == usual.results
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(study(ww.table(frame)))


def test_arrow_of_every_type():
    half = [0x3C00, 0x4000, 0xC400]  # 1, 2, -4
    columns = [("a", "g", [1.0, None, -4.0]), ("f", "f", [1.0, 2.0, None]), ("e", "e", half), ("b", "b", [True, None, False]),
               ("t", "u", ["x", None, "zä"]), ("T", "U", ["x", "", "z"]), ("n", "n", [None] * 3), ("d", "c", [1, 0, 1])]
    columns += [(f"i{code}", code, [1, 2, 3]) for code in "cCsSiIlL"]
    for skip in (0, 3, 9):
        stream = Stream(columns, [1, 2], skip, {"d": ["zero", "one"]})
        table = ww.table(stream)
        assert table.rows == 3 and stream.released == stream.made
        assert table.headings() == [name for name, _, _ in columns]


@pytest.mark.parametrize("columns, options, message", [
    ([("t", "tdD", [1])], {}, "column 't': Arrow's type 'tdD' is neither"),
    ([("t", "+l", [1])], {}, "neither a number nor a text"),
    ([("t", "l", [2**60])], {}, "beyond 2\\^53"),
    ([("t", "g", [1.0])], {"fail": b"the wire broke"}, "the wire broke"),
    ([("t", "g", [1.0]), ("t", "g", [1.0])], {}, "two columns are called 't'"),
    ([("t", "g", [])], {"batches": []}, "has no rows"),
])
def test_arrow_that_is_no_table(columns, options, message):
    stream = Stream(columns, **{"batches": [1], **options})
    codes = [code for _, code, _ in columns]
    if any(code.startswith(("t", "+")) for code in codes):
        stream._array = lambda *_: pytest.fail("asked for rows")
    with pytest.raises(ValueError, match=message):
        ww.table(stream)
    assert stream.released == stream.made


def test_a_million_rows_are_not_copied_here():
    """A frame of a million rows: what Python allocates beside the library's own table is small."""
    import tracemalloc

    n = 1_000_000
    rng = np.random.default_rng(2)
    big = pd.DataFrame({"F": rng.uniform(100, 200, n), "s": rng.uniform(1e4, 2e4, n)})
    big["V"] = 1e-7 * big["F"] * big["s"] + 0.01 * rng.normal(size=n)
    tracemalloc.start()
    table = ww.table(big)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert table.rows == n
    assert peak < 1e6  # a column is 8 MB
