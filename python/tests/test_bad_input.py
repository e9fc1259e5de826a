"""Columns of every kind, in every argument that names one: an answer, or a refusal that names the argument or the column."""

import datetime
import decimal
import fractions
import itertools
import re

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from arrow_stream import Stream

hours = [120.0, 340.0, 560.0, 230.0, 450.0, 610.0, 80.0, 150.0]
event = [1, 1, 1, 1, 0, 1, 1, 0]
group = ["a", "b"] * 4
stress = [300.0, 320.0] * 4

# name: a column made from the values of a good one
kinds = {
    "as it is": list,
    "float32": lambda v: np.asarray(v, dtype="float32") if not isinstance(v[0], str) else v,
    "objects": lambda v: pd.Series(v, dtype=object),
    "categories": pd.Categorical,
    "texts": lambda v: [str(each) for each in v],
    "decimals": lambda v: [decimal.Decimal(str(each)) for each in v] if not isinstance(v[0], str) else v,
    "fractions": lambda v: [fractions.Fraction(each) for each in v] if not isinstance(v[0], str) else v,
    "nullable": lambda v: pd.array(v[:-1] + [None]),
    "a None": lambda v: v[:2] + [None] + v[3:],
    "a NaN": lambda v: v[:2] + [np.nan] + v[3:],
    "infinite": lambda v: v[:2] + [np.inf] + v[3:],
    "minus infinity": lambda v: v[:2] + [-np.inf] + v[3:],
    "negative": lambda v: v[:2] + [-7.0] + v[3:],
    "zero": lambda v: [0] * len(v),
    "alike": lambda v: [v[0]] * len(v),
    "booleans": lambda v: [True, False] * (len(v) // 2),
    "complex": lambda v: np.ones(len(v), dtype=complex),
    "bytes": lambda v: [b"x"] * len(v),
    "dates": lambda v: pd.date_range("2020-01-01", periods=len(v)),
    "dates as objects": lambda v: [datetime.date(2020, 1, 1)] * len(v),
    "durations": lambda v: pd.to_timedelta(range(len(v)), unit="h"),
    "periods": lambda v: pd.period_range("2020-01", periods=len(v), freq="M"),
    "intervals": lambda v: pd.interval_range(0, len(v)),
    "lists": lambda v: [[1, 2]] * len(v),
    "dicts": lambda v: [{}] * len(v),
    "arrays": lambda v: [np.ones(2)] * len(v),
    "mixed": lambda v: v[:3] + ["seven"] + v[4:],
    "blanks": lambda v: [" "] * len(v),
    "beyond 2^53": lambda v: np.full(len(v), 2**60 + 1, dtype="uint64"),
    "huge": lambda v: [1e300] * len(v) if not isinstance(v[0], str) else v,
    "tiny": lambda v: [1e-300] * len(v) if not isinstance(v[0], str) else v,
    "signs and lines": lambda v: ['"];\n#'] * len(v),
}


@pytest.fixture
def life(monkeypatch):
    """ww.life up to the fit: a study, read and checked."""
    monkeypatch.setattr(ww.Study, "fit", lambda study, *_, **__: study)
    return lambda frame: ww.life(frame, "hours", event="event", by="group", stress={"T": "arrhenius"}, units={"T": "K", "hours": "h"})


@pytest.mark.parametrize("column, kind", itertools.product(["hours", "event", "group", "T"], kinds))
def test_a_column_of_each_kind_is_read_or_refused_by_name(life, column, kind):
    columns = {"hours": hours, "event": event, "group": group, "T": stress}
    columns[column] = kinds[kind](columns[column])
    try:
        assert life(pd.DataFrame(columns)).description()
    except ww.InputError as error:
        assert re.search(rf"\b({column}|stress|by|event)\b", str(error)), error


def test_columns_of_booleans_are_no_measurements_in_any_table(tmp_path):
    """As in frames: of a table that was made before, of an Arrow stream, and of files, where they are texts."""
    frame = pd.DataFrame({"hours": hours, "event": event, "flag": [True, False] * 4, "load": stress})
    packed = ww.table(frame)
    arrow = ww.table(Stream([("hours", "g", [float(each) for each in hours]), ("flag", "b", [True, False] * 4)], [8]))
    frame.to_csv(tmp_path / "lives.csv", index=False)
    for table in packed, arrow:
        for argument in "count", "entry":
            with pytest.raises(ww.InputError, match=f"^{argument}: column 'flag' holds True and False"):
                ww.life(table, "hours", unused=["event"] if table is packed else None, **{argument: "flag"})
        with pytest.raises(ww.InputError, match="^y: column 'flag' holds True and False"):
            ww.degradation(table, "flag", "hours", unit=False)
    file = str(tmp_path / "lives.csv")
    for argument in "count", "entry":
        with pytest.raises(ww.InputError, match="row 1, column 'flag': 'True' is not a number"):
            ww.life(file, "hours", event="event", **{argument: "flag"})
    with pytest.raises(ww.InputError, match="^x: column 'flag' holds no numbers, but texts such as 'True'"):
        ww.degradation(file, "hours", "flag", unit=False)


def test_levels_of_an_index_and_of_headings_are_refused_by_name(life):
    frame = pd.DataFrame({"hours": hours, "event": event, "group": group, "T": stress})
    assert life(frame.set_index(pd.MultiIndex.from_product([[1, 2], range(4)]))).toml == life(frame).toml
    with pytest.raises(ww.InputError, match=r"by: data has no column 'group'; it is a level of the index, and data.reset_index\(\)"):
        life(frame.set_index(["group", frame.index]))
    levels = frame.set_axis(pd.MultiIndex.from_product([["x"], frame.columns]), axis=1)
    with pytest.raises(ww.InputError, match=r"the heading \('x', 'hours'\) has 2 levels; columns have one name each"):
        life(levels)


def test_a_table_without_rows_or_columns_is_refused(life):
    frame = pd.DataFrame({"hours": hours, "event": event, "group": group, "T": stress})
    with pytest.raises(ww.InputError, match="data has no rows"):
        life(frame.iloc[:0])
    with pytest.raises(ww.InputError, match="column 'event' has 1 rows, and 'hours' has 8"):
        life({"hours": hours, "event": [1], "group": group, "T": stress})
    with pytest.raises(ww.InputError, match="data has no column"):
        life(pd.DataFrame())


# Of the other functions: a table of each, and the names that refusals may have beside the column's.
tests = {"S": stress, "N": [1e5, 9e4] * 4, "end": ["failed"] * 7 + ["runout"]}
others = {
    "repairable": ({"age": [100.0, 250, 400, 90, 300, 500, 40, 420], "unit": list("AAABBBCC"), "event": ["failure", "failure", "end"] * 2 + ["failure", "end"]},
                   lambda frame: ww.repairable(frame, "age", unit="unit", event="event", units={"age": "h"})),
    "staircase": ({"S": stress, "end": event, "k": [1] * 8}, lambda frame: ww.staircase(frame, "S", "end", count="k", units={"S": "MPa"})),
    "triangle": ({"shipped": ["Jan 2010", "Feb 2010", "Mar 2010", "Apr 2010"], "quantity": [100, 140, 150, 120], "Feb 2010": [3, np.nan, np.nan, np.nan],
                  "Mar 2010": [3, 2, np.nan, np.nan], "Apr 2010": [5, 4, 4, np.nan], "May 2010": [6.0, 5, 4, 3]}, lambda frame: ww.returns(frame)),
    "returned": ({"sold": ["2024-01", "2024-02", "2024-03", "2024-04"] * 2, "back": ["2024-05", "", "2024-08", ""] * 2},
                 lambda frame: ww.returns(frame, sold="sold", returned="back", until="2024-12")),
    "decide": ({"life [h]": hours, "weight": [1.0] * 8}, lambda frame: ww.decide(frame, failure_cost="12000 EUR", replacement_cost="900 EUR")),
    "spectrum": ({"stress": [0.0, 500, -100, 400, -300, 200, 50, 300]}, lambda frame: ww.spectrum(frame, column="stress", units={"stress": "MPa"})),
    "degradation": ({"w": hours, "km": [10.0, 20, 30, 40] * 2, "m": list("AAAABBBB")}, lambda frame: ww.degradation(frame, "w", "km", unit="m")),
    "bearing": ({"d": hours, "t": [10.0, 20, 30, 40] * 2, "v": [60.0] * 8, "u": list("AAAABBBB")},
                lambda frame: ww.bearing(frame, "d", contact="journal", radius="10 mm", clearance="20 um", time="t", speed="v", pressure="1 MPa", unit="u",
                                         units={"d": "um", "t": "h", "v": "rpm"})),
}


@pytest.mark.parametrize("name", others)
def test_columns_of_each_kind_of_other_functions(monkeypatch, name):
    monkeypatch.setattr(ww.Study, "fit", lambda study, *_, **__: study.description())
    good, call = others[name]
    assert call(pd.DataFrame(good))
    for column, kind in itertools.product(good, kinds):
        if kind == "fractions" and any(each != each for each in good[column]):
            continue  # there is no fraction of NaN
        values = kinds[kind](list(good[column]))
        try:
            assert call(pd.DataFrame({**good, column: values}))
        except ww.InputError as error:
            named = "|".join(re.sub(r" \[.*", "", each) for each in good)
            assert re.search(rf"(?<!\w)({named}|status|sold|lives|bearing|measured depth|prior, data and model)(?!\w)", str(error)), (column, kind, error)
            assert "[data" not in str(error) and "data.returns" not in str(error), (column, kind, error)


@pytest.mark.parametrize("truths", [[True] * 8, pd.array([True] * 8, dtype="boolean"), pd.Series([True] * 8, dtype=object), pd.Categorical([True] * 8)])
def test_truths_are_no_lives(truths):
    """They would be read as lives of 1."""
    with pytest.raises(ww.InputError, match="life: column 'h' holds True and False; it is a number in each row"):
        ww.life(pd.DataFrame({"h": truths}), "h")
    with pytest.raises(ww.InputError, match="stress: column 'S' holds True and False"):
        ww.sn(pd.DataFrame({"S": truths, "N": hours}), "S", "N", units={"S": "MPa"})


@pytest.mark.parametrize("family", ["lognormal", "wiener-process", "gamma-process", "inverse-gaussian-process"])
def test_readings_where_paths_of_a_family_begin(family):
    of = lambda x, y: ww.degradation({"km": x, "wear": y}, "wear", "km", family=family)
    with pytest.raises(ww.InputError, match="row 1, column 'km': 0; a path of the family '.*' begins at 0, so a reading there says nothing: leave out"):
        of([0, 1, 2], [0, 1.1, 2])
    with pytest.raises(ww.InputError, match="row 1, column 'km': -1 must be positive: a path of the family '.*' begins at 0"):
        of([-1, 1, 2], [0.1, 1.1, 2])
    if family != "wiener-process":
        with pytest.raises(ww.InputError, match="row 2, column 'wear': 0 must be positive for the family '.*'; family='normal' takes"):
            of([1, 2, 3], [1.1, 0, 3.1])
        with pytest.raises(ww.InputError, match="row 3, column 'wear': 0 must be positive"):
            of([1, 2, 3, 4], [1.1, np.nan, 0, 3.1])


def test_numbers_of_categories_with_missing_cells():
    sold = {"shipped": ["Jan 2010", "Feb 2010"], "quantity": [100, 140], "Feb 2010": pd.Categorical([3, None]), "Mar 2010": pd.Categorical([3, 2])}
    as_numbers = {**sold, "Feb 2010": [3, np.nan], "Mar 2010": [3, 2]}
    first, second = (ww.returns(pd.DataFrame(each), method="exact", draws=100, seed=1, report=False) for each in (sold, as_numbers))
    assert first.parameters.equals(second.parameters)


def test_what_is_no_table_of_lives():
    costs = {"failure_cost": "12000 EUR", "replacement_cost": "900 EUR"}
    with pytest.raises(ww.InputError, match="lives is None; it is a fit"):
        ww.decide(None, **costs)
    with pytest.raises(ww.InputError, match="lives, row 3, column 'weight': inf must be finite"):
        ww.decide({"life [h]": hours, "weight": [1, 1, np.inf, 1, 1, 1, 1, 1]}, **costs)
