"""The client of a monitor: a monitor runs, takes readings, and answers what it would tell its page."""

import json
import time
import urllib.request

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from monitored import monitored
from wearwell._impl.monitor import _plain
from test_follow import fit, fleet, in_time, messages_of  # noqa: F401  (fixtures)

token = "0123456789abcdef0123"


@pytest.fixture(scope="module")
def lines(fleet):  # noqa: F811
    return in_time(messages_of(fleet, ["M042", "M067"]))[:12]


@pytest.fixture
def url(fleet, lines, tmp_path):  # noqa: F811
    with monitored(tmp_path, fleet / "study-results", lines) as address:
        yield address


def answered(url, path):
    with urllib.request.urlopen(url + path) as answer:
        return json.load(answer)


def until(work):
    for _ in range(100):
        if work():
            return True
        time.sleep(0.05)
    return False


def test_answers_are_those_of_the_api(url, fit, lines):  # noqa: F811
    monitor = ww.Monitor(url)
    assert until(lambda: len(monitor.units()) == 2 and monitor.units()["readings"].sum() == 12)
    assert monitor.fleet()["limit"] == 100 and monitor.fleet()["units"] == answered(url, "/api/v1/fleet")["units"]
    units = monitor.units()
    for each in answered(url, "/api/v1/units")["units"]:
        row = units.loc[each["unit"]]
        assert [row[f"rul_{q}"] for q in ("q05", "q50", "q95")] == list(each["remaining"].values())
        assert row["risk"] == each["risk"] and row["alarm"] == each["alarm"] and row["at"] == each["at"]
        tracker = fit.track(each["unit"], new=True)
        tracker.update(pd.DataFrame([row for row in lines if row["machine"] == each["unit"]])[["use_h", "wear_um"]])
        assert tracker.rul == (row["rul_q05"], row["rul_q50"], row["rul_q95"], units.attrs["axis_unit"])
        assert len(monitor.unit(each["unit"])["moments"]) == each["quality"]["readings"]
    assert list(monitor.units("067").index) == ["M067"]


def test_readings_are_stored(url):
    monitor = ww.Monitor(url)
    sent = pd.DataFrame({"time": pd.to_datetime(["2026-05-05T12:00:00Z", "2026-05-06T12:00:00Z"]), "machine": "hall 2/pump",
                         "use_h": np.array([900.0, 950.0]), "wear_um": [17.5, 18.6], "remark": [None, float("nan")]})
    assert monitor.send(sent) == {"readings": 2, "repeated": 0, "refused": 0, "problem": ""}
    assert monitor.send(sent.to_dict("records"))["repeated"] == 2
    assert until(lambda: "hall 2/pump" in monitor.units().index)
    assert monitor.unit("hall 2/pump")["at"] == 950
    mixed = [{"time": "2026-05-07T12:00:00Z", "machine": "M1", "use_h": 10.0, "wear_um": 1.0}, {"machine": "M1", "use_h": 11.0}]
    found = monitor.send(mixed)
    assert found["readings"] == 1 and found["refused"] == 1 and found["problem"]


def test_events_of_a_unit_are_reported(url):
    monitor = ww.Monitor(url)
    rows = [{"time": f"2026-05-0{day}T12:00:00Z", "machine": "M5", "use_h": 400.0 * day, "wear_um": 9.0 * day} for day in (1, 2, 3)]
    monitor.send(rows)
    assert until(lambda: "M5" in monitor.units().index and monitor.units().loc["M5", "readings"] == 3)
    before = monitor.unit("M5")
    keys = [each["key"] for each in before["moments"]]
    assert monitor.report("M5", "replaced", key=keys[2], use=1000.0, by="J. Doe", note="new guide")["events"] == 1
    assert until(lambda: monitor.unit("M5")["part"] == 2)
    assert monitor.unit("M5")["at"] == 200 and monitor.unit("M5")["quality"]["readings"] == 1
    event = monitor.unit("M5")["events"][0]
    assert (event["event"], event["use"], event["by"], event["note"]) == ("replaced", 1000, "J. Doe", "new guide")
    assert monitor.report("M5", "cancelled", number=event["number"], by="J. Doe")["events"] == 1
    assert until(lambda: monitor.unit("M5")["part"] == 1) and monitor.unit("M5")["risk"] == before["risk"]
    monitor.report("M5", "failed", key=keys[2], use=1210.0, by="J. Doe")
    assert until(lambda: monitor.units().loc["M5", "service"] == "failed")
    assert monitor.report("M77", "installed", key=keys[0], use=0.0, by="J. Doe")["events"] == 1
    with pytest.raises(ww.InputError, match="installed"):
        monitor.report("M78", "failed", key=keys[0], use=5.0, by="J. Doe")
    with pytest.raises(ww.InputError, match="restored is missing"):
        monitor.report("M5", "repaired", key=keys[2], by="J. Doe")
    assert monitor.report("M5", "repaired", key=keys[2], restored=3.5, by="J. Doe", note="ground")["events"] == 1
    assert until(lambda: monitor.unit("M5")["events"][-1]["event"] == "repaired")
    repaired = monitor.unit("M5")["events"][-1]
    assert (repaired["event"], repaired["restored"]) == ("repaired", pytest.approx(3.5))
    assert monitor.report("M5", "cancelled", number=repaired["number"], by="J. Doe")["events"] == 1
    with pytest.raises(ww.InputError, match="must be one of installed, replaced, repaired, removed"):
        monitor.report("M5", "mended", key=keys[0], by="x")
    with pytest.raises(ww.InputError, match="has no stored reading with key"):
        monitor.report("M5", "withdrawn", key=keys[2] + 5, by="x")
    with pytest.raises(ww.InputError, match="year 1970; it is a Unix time in milliseconds"):
        monitor.report("M5", "withdrawn", key=keys[2] // 1000, by="x")
    with pytest.raises(ww.InputError, match="is not a unit"):
        monitor.report("M55", "withdrawn", key=keys[2], by="x")


def test_events(url):
    monitor = ww.Monitor(url)
    events = monitor.events()
    assert next(events)["all"]
    monitor.send({"time": "2026-05-05T12:00:00Z", "machine": "M9", "use_h": 900.0, "wear_um": 17.5})
    assert any("M9" in each["changed"] or each["all"] for each in (next(events) for _ in range(3)))
    events.close()


def test_errors(url):
    monitor = ww.Monitor(url)
    with pytest.raises(ww.InputError, match='"M0" is not a unit'):
        monitor.unit("M0")
    with pytest.raises(ww.InputError, match="use|wear"):
        monitor.send({"machine": "M1", "time": "2026-05-05T12:00:00Z"})
    for wrong, message in (({"use_h": float("inf")}, "row 1, 'use_h' is inf; a number is finite"), ([], "readings has no rows"),
                           ("a.csv", "readings is str; it is a dict"), ({"use_h": [1]}, "row 1, 'use_h' is list")):
        with pytest.raises(ww.InputError, match=message):
            monitor.send(wrong)
    with pytest.raises(ww.MachineError, match="^http://127.0.0.1:9 cannot be reached"):
        ww.Monitor("http://127.0.0.1:9").fleet()
    with pytest.raises(ww.InputError, match="^url is 'monitor'; it is like"):
        ww.Monitor("monitor")
    with pytest.raises(ww.InputError, match="^token: http://plant.example is not encrypted"):
        ww.Monitor("http://plant.example", token=token)


def test_token(fleet, tmp_path):  # noqa: F811
    with monitored(tmp_path, fleet / "study-results", token=token) as address:
        with pytest.raises(ww.InputError, match=address):
            ww.Monitor(address).fleet()
        assert ww.Monitor(address, token=token).fleet()["units"]["all"] == 0


def test_times_of_numpy_are_times_and_durations_are_refused():
    for each in (np.datetime64("2026-05-05T12:00", "ns"), np.datetime64("2026-05-05T12:00", "s"), pd.Timestamp("2026-05-05T12:00")):
        assert _plain(each, "time", 1) == "2026-05-05T12:00:00"
    assert _plain(np.datetime64("NaT"), "time", 1) is None and _plain(np.int32(7), "hours", 1) == 7
    with pytest.raises(ww.InputError, match="readings, row 2, 'hours' is timedelta64; it is a number, a text or a time"):
        _plain(np.timedelta64(7, "ns"), "hours", 2)
