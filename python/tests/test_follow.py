"""Units of a fit followed by their readings: the numbers of ``wearwell monitor``, ``backtest`` and ``export`` to the bit."""

import copy
import json
import math
import os
import pickle
import re
import subprocess
import warnings

import pandas as pd
import pytest

import wearwell as ww
from conftest import binary, source
from test_same_numbers import files_below


@pytest.fixture(scope="module")
def fit():
    """The machines of the example; the error of a reading is known, which halves the time of the fit."""
    folder = os.path.join(source, "examples", "fleet")
    with open(os.path.join(folder, "study.toml")) as file:
        text = re.sub(r"(?m)^error .*\n", "", file.read()) + '\n[constants]\nerror = "2 um"\n'
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return ww.Study.from_toml(text, folder=folder).fit(seed=1, method="exact", draws=100, report=False)


@pytest.fixture(scope="module")
def joint():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return ww.fit(os.path.join(source, "examples", "joint", "study.toml"), seed=1, method="exact", draws=100, report=False)


@pytest.fixture(scope="module")
def fleet(fit, tmp_path_factory):
    """The folder of the example with the result of this fit and its readings."""
    folder = tmp_path_factory.mktemp("fleet") / "fleet"
    subprocess.run([binary, "new", "fleet", folder], check=True, capture_output=True)
    fit.write(folder / "study-results")
    return folder


def messages_of(fleet, names):
    rows = [json.loads(line) for line in (fleet / "readings.jsonl").read_text().splitlines()]
    return [row for row in rows if row["machine"] in names]


def in_time(rows):
    """One of each, by time: no late ones."""
    return sorted({row["time"]: row for row in rows}.values(), key=lambda row: row["time"])


def test_tracker_is_the_monitor(fit, fleet, tmp_path):
    names = ["M042", "M067", "M003"]
    rows = {name: in_time(messages_of(fleet, [name])) for name in names}
    config = (fleet / "monitor.toml").read_text().replace("study-results", str(fleet / "study-results"))
    (tmp_path / "monitor.toml").write_text(config)
    lines = "\n".join(json.dumps(row) for name in names for row in rows[name])
    done = subprocess.run([binary, "monitor", tmp_path / "monitor.toml", "--once", "--json"], input=lines, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    units = {each["unit"]: each for each in json.loads(done.stdout)["list"]}
    assert set(units) == set(names)
    for name in names:
        frame = pd.DataFrame(rows[name])
        tracker = fit.track(name, new=True)
        for start in range(0, len(frame), 7):  # in parts
            assert tracker.update(frame[["machine", "use_h", "wear_um"]].iloc[start:start + 7]) is tracker
        found, wanted = tracker.summary, units[name]
        for key in ("at", "level", "remaining", "b10", "numerical_error", "passed", "known", "rate_change", "doubt", "beyond"):
            assert found[key] == wanted[key], key
        assert found["quality"]["readings"] == wanted["quality"]["readings"]
        assert tracker.risk("500 h") == wanted["risk"] == tracker.risk(500)
        assert tracker.rul == (*wanted["remaining"].values(), "h")


def test_a_rate_that_changes_is_found():
    fit = ww.fit(os.path.join(source, "examples", "fleet", "rate_change.toml"), seed=1, method="exact", draws=100, report=False)
    tracker = fit.track("new", new=True)
    assert tracker.rate_change["probability"] == 0 and tracker.rate_change["since"]["q50"] is None
    use = [300 * i for i in range(1, 11)]
    tracker.update({"use_h": use, "wear_um": [0.02 * u + (0.04 * (u - 1800) if u > 1800 else 0) for u in use[:9]] + [103.0]})
    change = tracker.rate_change
    assert change["probability"] > 0.99
    assert change["since"]["q05"] < 1800 < change["since"]["q95"]
    assert change["factor"]["q05"] < 3 < change["factor"]["q95"]


def test_of_a_unit_of_the_study_its_readings_are_known(fit):
    data = pd.read_csv(os.path.join(source, "examples", "fleet", "learned.csv"))
    tracker = fit.track("L1")
    assert not tracker.is_new and tracker.summary["at"] == data[data.machine == "L1"].use_h.max()
    before = tracker.rul
    tracker.update({"use_h": 3600, "wear_um": 89.0})
    assert tracker.rul.q95 < before.q95 and tracker.rul.unit == "h"
    assert tracker.level.q05 < tracker.level.q50 < tracker.level.q95
    path = tracker.path()
    assert path.index[0] == 3600 and (path["q05"] <= path["q50"]).all() and path["q50"].iloc[-1] > 100
    assert repr(tracker).startswith("<wearwell.UnitTracker of machine 'L1': 1 new reading, remaining useful life")
    assert fit.track("L1").rul == before, "trackers of a fit do not share their readings"


def test_units_and_names_of_columns(fit):
    by = [{"use": 1000, "wear": 21.0}, {"use_h": 1000, "wear_um": 21.0}, {"use [h]": 1000.0, "wear [mm]": 0.021},
          pd.DataFrame({"use": [1000], "wear": [21.0]})]
    all_of_them = [fit.track("M", new=True).update(each).rul for each in by]
    for each in all_of_them:
        assert each.unit == "h" and each[:3] == pytest.approx(all_of_them[0][:3], rel=1e-12)
    with pytest.raises(ww.InputError, match="wear"):
        fit.track("M", new=True).update({"use": 1000, "wear [kg]": 21.0})


def test_rows_are_taken_all_or_none(fit):
    tracker = fit.track("M7", new=True)
    with pytest.raises(ww.InputError, match="row 2"):
        tracker.update({"use": [500, float("nan")], "wear": [10.0, 21.0]})
    with pytest.raises(ww.InputError, match="row 1, column 'machine': it is a reading of machine 'M8', and 'M7' is tracked"):
        tracker.update({"machine": ["M8"], "use": [500], "wear": [10.0]})
    with pytest.raises(ww.InputError, match="no column 'wear'"):
        tracker.update({"use": [500]})
    assert tracker.summary["quality"]["readings"] == 0 and tracker.outcomes.empty
    tracker.update({"use": [500, 500], "wear": [10.0, 10.0]})
    assert tracker.outcomes["repeated"].tolist() == [False, True] and tracker.summary["quality"]["readings"] == 1


def test_what_is_hardly_possible_is_a_warning_and_a_doubt(fit):
    tracker = fit.track("M7", new=True).update({"use": [500, 1000, 1500, 2000], "wear": [10.0, 20.5, 30.0, 41.0]})
    assert tracker.doubt is None
    with pytest.warns(ww.CheckWarning, match="^row 1 contradicts the earlier readings of machine 'M7'"):
        tracker.update({"use": 2100, "wear": 0.042})
    for use in (2200, 2300):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ww.CheckWarning)
            tracker.update({"use": use, "wear": 0.044})
    assert tracker.doubt and "in doubt" in repr(tracker)


def test_names_of_units(fit):
    with pytest.raises(ww.InputError, match=r"^unit: the study has no machine 'L9'"):
        fit.track("L9")
    with pytest.raises(ww.InputError, match=r"^unit: machine 'L1' is one of the study, so it is not new"):
        fit.track("L1", new=True)
    with pytest.raises(ww.InputError, match=r"^unit is missing"):
        fit.track()
    with pytest.raises(ww.InputError, match=r"^new is 'M7'; it is True or False"):
        fit.track("M7", new="M7")
    with pytest.raises(ww.InputError, match=r"^within"):
        fit.track("L1").risk("3 kg")


def test_studies_without_units_to_follow_are_refused():
    pumps = {"hours": [312, 480, 510, 640, 700, 150], "failed": [1, 1, 1, 1, 0, 1]}
    lives = ww.life(pumps, "hours", event="failed", method="exact", draws=100, report=False)
    with pytest.raises(ww.InputError, match="single units of this study .* cannot be followed"):
        lives.track("A")


def test_folder_copies_and_pickles(fit, fleet, joint):
    assert ww.track(fleet / "study-results", "L1").rul == fit.track("L1").rul
    assert copy.copy(fit).track("L1").rul == fit.track("L1").rul
    assert pickle.loads(pickle.dumps(joint)).track().rul == joint.track().rul


def test_backtest_is_the_program(fit, fleet, wearwell, tmp_path):
    names = [f"M{i:03}" for i in range(40, 44)]
    rows = messages_of(fleet, names)
    file = tmp_path / "readings.jsonl"
    file.write_text("\n".join(json.dumps(row) for row in rows))
    given = ("backtest", fleet / "study-results", file, fleet / "truth.csv")
    code, out, error = wearwell(*given, "--json", "-o", tmp_path / "forecasts.csv")
    assert code == 0, error
    frame, truth = pd.DataFrame(rows), pd.read_csv(fleet / "truth.csv")
    for test in (fit.backtest(frame, truth), ww.backtest(fleet / "study-results", file, fleet / "truth.csv")):
        assert test.summary == json.loads(out) and test.trusted
        written = pd.read_csv(tmp_path / "forecasts.csv", float_precision="round_trip", dtype={"machine": str})
        pd.testing.assert_frame_equal(test.forecasts, written, check_exact=True)
    assert wearwell(*given)[1] == str(test)
    assert test.coverage.loc["all", "forecasts"] == len(test.forecasts)
    assert test.coverage.loc["all", "covered"] == ((written["q05 [h]"] <= written["life [h]"]) & (written["life [h]"] <= written["q95 [h]"])).sum()


def test_backtest_errors(fit):
    reading = {"machine": ["A"], "use": [500], "wear": [9.0]}
    with pytest.raises(ww.InputError, match="^lives: no unit of readings has a known end there"):
        fit.backtest(reading, {"machine": ["B"], "life": [5200]})
    with pytest.raises(ww.InputError, match="B has two lives"):
        fit.backtest(reading, {"machine": ["B", "B"], "life": [5200, 5300]})
    with pytest.raises(ww.InputError, match="no column 'machine'"):
        fit.backtest({"use": [500], "wear": [9.0]}, {"machine": ["B"], "life": [5200]})


def test_export_is_the_program(fit, fleet, wearwell, tmp_path):
    results = fleet / "study-results"
    code, out, error = wearwell("export", "c", results, "-o", tmp_path / "there", "--name", "pump", "--unit", "L2", "--lines", 64)
    assert code == 0, error
    text = fit.export_c(tmp_path / "here", name="pump", unit="L2", lines=64)
    assert files_below(tmp_path / "here") == files_below(tmp_path / "there")
    assert out.startswith(text)
    code, out, error = wearwell("export", "sql", results, "--dialect", "duckdb", "--table", "fleet.liners", "--columns", "use=hours:h", "--draws", 40,
                                "--keep", "site,hall")
    assert code == 0, error
    assert fit.export_sql("duckdb", "fleet.liners", columns={"use": "hours:h"}, draws=40, keep=["site", "hall"]) == out
    assert ww.export_sql(results, "duckdb", "fleet.liners", columns="use=hours:h", draws=40, keep=["site", "hall"]) == out


def test_export_errors(fit, joint, tmp_path):
    with pytest.raises(ww.InputError, match="^lines is 3; it is a whole number from 16 to 20000"):
        fit.export_c(tmp_path / "pump", lines=3)
    with pytest.raises(ww.InputError, match="^part is 'both'"):
        fit.export_sql("duckdb", "fleet.liners", part="both")
    with pytest.raises(ww.InputError, match="oracle"):
        fit.export_sql("oracle", "fleet.liners")
    assert not (tmp_path / "pump").exists()
    with pytest.raises(ww.InputError, match='C export needs a study of model "formula"'):
        joint.export_c(tmp_path / "pump")


def test_a_joint_is_its_only_unit(joint):
    tracker = joint.track()
    assert math.isfinite(tracker.rul.q50) and tracker.rul.unit == "cycles"


def test_a_tracker_is_pickled_with_its_readings(fit):
    tracker = fit.track("M7", new=True).update({"use": 500, "wear": 9.1}).update(pd.DataFrame({"use [h]": [900, 900], "wear [um]": [17.2, 17.2]}))
    again = pickle.loads(pickle.dumps(tracker))
    assert again.summary == tracker.summary and again.outcomes.equals(tracker.outcomes) and again.is_new
    here, there = (each.update({"use": 1300, "wear": 25.4}).rul for each in (tracker, again))
    assert here == there
    assert copy.deepcopy(tracker).rul == tracker.rul


def test_a_unit_beyond_its_threshold_says_so(fit):
    tracker = fit.track("M7", new=True).update({"use": 500, "wear": 9.1})
    assert tracker.passed < 0.01 and "passed" not in repr(tracker)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        tracker.update({"use": 5000, "wear": 100.0})
    assert 0.1 < tracker.passed < 1
    assert f"threshold passed with probability {100 * tracker.passed:.0f} %, if not remaining useful life" in repr(tracker)
