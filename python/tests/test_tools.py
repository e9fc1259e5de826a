"""Selections, comparisons, bearings and clutch cycles: the answers of the program."""

import json
import os
import pickle
import subprocess
import sys
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from conftest import clutch_study


def test_selection_is_the_programs(examples, wearwell, tmp_path):
    table = os.path.join(examples, "select", "wear.csv")
    _, out, _ = wearwell("select", table, "--response", "w", "--inputs", "Td,n,Mz", "--degree", 2, "--json")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        of_file = ww.select(table, "w", inputs=["Td", "n", "Mz"], degree=2)
        frame = pd.read_csv(table, float_precision="round_trip")
        of_frame = ww.select(frame, "w", inputs=["Td", "n", "Mz"], degree=2, report=True)
    there = json.loads(out)
    for found in (of_file, of_frame):
        here = dict(found.summary)
        assert found.trusted
        for each in (here, there):
            each.pop("seconds", None), each.pop("nodes", None)
            each["data"].pop("files", None), each["data"].pop("file", None), each["data"].pop("sha1", None)
        assert here == there
    assert len(of_frame.models) == 10
    of_frame.report(tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 10_000
    with pytest.raises(ww.InputError, match="report=True"):
        of_file.report(tmp_path / "none.html")


@pytest.mark.parametrize("options, message", [
    ({"inputs": ["a"]}, "has no column 'a'|a"), ({"inputs": []}, "inputs"), ({"inputs": ["Td"], "criterion": "x"}, "x"),
    ({"inputs": ["w"]}, "cannot be a term"), ({"inputs": ["Td"], "degree": 0}, "degree")])
def test_selections_that_are_refused(examples, options, message):
    frame = pd.read_csv(os.path.join(examples, "select", "wear.csv"))
    with pytest.raises(ValueError, match=message):
        ww.select(frame, "w", **options)


def test_interrupted_selection_stops(tmp_path):
    """64 terms of noise: a search of years."""
    code = """
import os, signal, threading
import numpy as np
import wearwell as ww
rng = np.random.default_rng(1)
data = {f"x{i}": rng.normal(size=80) for i in range(60)}
data["w"] = rng.normal(size=80)
threading.Timer(2.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    ww.select(data, "w", terms=[f"x{i}" for i in range(60)])
except KeyboardInterrupt:
    print("stopped")
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.stdout == "stopped\n", done.stderr


def test_comparison_is_the_programs(examples, wearwell, tmp_path):
    folder = os.path.join(examples, "joint")
    fits = {}
    for name in ("normal_flat", "lognormal_flat"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ww.CheckWarning)
            fits[name] = ww.fit(os.path.join(folder, f"{name}.toml"), seed=1, report=False)
        fits[name].write(tmp_path / name)
    _, out, _ = wearwell("compare", tmp_path / "normal_flat", tmp_path / "lognormal_flat", "--json")
    both = ww.compare(*fits.values(), names=[str(tmp_path / name) for name in fits])
    assert both.summary == json.loads(out)
    mixed = ww.compare(tmp_path / "normal_flat", fits["lognormal_flat"])
    assert {s["study"] for s in mixed.summary["studies"]} == {str(tmp_path / "normal_flat"), "b"}
    with pytest.raises(ww.InputError, match="two fits"):
        ww.compare(fits["normal_flat"])
    with pytest.raises(ww.InputError, match="no such folder"):
        ww.compare(tmp_path / "nowhere", fits["normal_flat"])


lives = {"hours": [312, 480, 510, 640, 700, 700, 150, 260, 420], "failed": [1, 1, 1, 1, 0, 0, 1, 1, 1]}


@pytest.fixture(scope="module")
def pumps():
    return ww.life(lives, "hours", event="failed", units={"hours": "h"}, b=[10, 50], method="exact", draws=100, report=False)


def test_families_are_the_programs(pumps, wearwell, tmp_path):
    (tmp_path / "study.toml").write_text(pumps.study.toml.replace('file = "data"', 'file = "data.csv"'))
    rows = [f"{hours},{failed}" for hours, failed in zip(*lives.values())]
    (tmp_path / "data.csv").write_text("\n".join(["hours,failed", *rows, ""]))
    _, out, _ = wearwell("compare", tmp_path / "study.toml", "--families", "weibull,lognormal", "--json")
    said = json.loads(out)
    for each in said["studies"]:
        each["data"]["file"] = "data"
    ranked = pumps.compare(families=["weibull", "lognormal"])
    assert ranked.summary == said
    assert ww.compare(pumps.study, families="weibull,lognormal").summary == ranked.summary
    assert ww.compare(tmp_path / "study.toml", families=("weibull", "lognormal")).summary == json.loads(out)
    assert ranked.close == said["close"] and set(ranked.close) == {"weibull", "lognormal"}
    assert list(ranked.lives["family"]) == [each for each in [s["study"] for s in ranked.summary["studies"]] for _ in range(2)]
    assert list(ranked.lives.loc[ranked.lives["family"] == "weibull", "q50"]) == [pumps.quantities.set_index("name").loc[each, "q50"] for each in ("B10 life", "B50 life")]
    assert "The choice" in str(ranked) or "One of them" in str(ranked) or "differ" in str(ranked)


def test_families_of_an_updated_and_a_copied_fit(pumps):
    again = pickle.loads(pickle.dumps(pumps))
    assert again.compare(families="weibull,lognormal").summary == pumps.compare(families="weibull,lognormal").summary
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        more = pumps.update({"hours": [55.0], "failed": [1]})
        assert len(more.compare(families="weibull,lognormal").summary["studies"]) == 2


@pytest.mark.parametrize("arguments, message", [
    ({"families": ["weibull"]}, "families: needs two families"), ({"families": []}, "list of names"), ({"families": 3}, "list of names"),
    ({"families": "weibull,wei"}, "'wei' cannot be ranked"), ({"families": ["gamma", "gamma"]}, "'gamma' twice"),
    ({"families": "all", "names": ["a"]}, "names: "), ({"families": "all", "threads": -1}, "threads is -1")])
def test_families_that_cannot_be_ranked(pumps, arguments, message):
    with pytest.raises(ww.InputError, match=message):
        ww.compare(pumps, **arguments)


def test_studies_whose_families_cannot_be_ranked(pumps, examples, tmp_path):
    with pytest.raises(ww.InputError, match="2 are given"):
        ww.compare(pumps, pumps, families="all")
    with pytest.raises(ww.InputError, match="of a table: wearwell.life"):
        ww.compare(lives, families="all")
    with pytest.raises(ww.InputError, match="but got"):
        ww.compare(tmp_path, families="all")
    with pytest.raises(FileNotFoundError):
        ww.compare("no.toml", families="all")
    with pytest.raises(ww.InputError, match='model "formula"'):
        ww.compare(os.path.join(examples, "joint", "study.toml"), families="all")


def test_bearings_are_the_programs(wearwell):
    inputs = {"radius": "10 mm", "clearance": "20 um", "rate": "1e-16 m^3/(N m) +- 10 %", "pressure": "2 MPa"}
    for command, more in (("life", {"depth": "50 +- 5 um", "speed": "60 rpm"}), ("depth", {"revolutions": "1e6"}),
                          ("pressure", {"depth": "50 um", "revolutions": 1_000_000})):
        given = {**inputs, **more}
        if command == "pressure":
            del given["pressure"]
        options = [x for k, v in given.items() for x in ("--" + k, v)]
        code, out, error = wearwell("bearing", command, "--contact", "journal", *options, "--json", "--seed", 4)
        assert code == 0, error
        assert getattr(ww.bearing, command)("journal", seed=4, **given) == json.loads(out)
    limited = ww.bearing.depth("journal", revolutions=1e6, limit="1 mm", **inputs)
    assert "below the limit of 1 mm" in limited["margin"]
    with pytest.raises(ww.InputError, match="did you mean 'radius'"):
        ww.bearing.life("journal", radios="1 mm")
    with pytest.raises(ww.InputError, match="^contact: 'shaft'"):
        ww.bearing.life("shaft", radius="1 mm")
    with pytest.raises(ww.InputError, match="pressure is given"):
        ww.bearing.pressure("journal", depth="50 um", revolutions="1e6", **inputs)


@pytest.fixture(scope="module")
def clutch(tmp_path_factory):
    """The model of the clutch example, and cycles for it."""
    folder = tmp_path_factory.mktemp("clutch")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        ww.fit(clutch_study(folder / "study", repetitions=5), report=False).write(folder / "results")
    rng = np.random.default_rng(1)
    with open(folder / "results" / "model.json") as file:
        model = json.load(file)
    return folder, model, rng


def cycles_of(model, rng, n, plate="A"):
    low, high = ([model["validity"][end][name] for name in ("slip_speed", "torque", "temperature", "closing_time")]
                 for end in ("lowest", "highest"))
    columns = {name: rng.uniform(a, b, n) for name, a, b in
               zip(("slip_speed [rad/s]", "torque [N m]", "temperature [degC]", "closing_time [s]"), low, high)}
    energy = 0.5 * columns["slip_speed [rad/s]"] * columns["torque [N m]"] * columns["closing_time [s]"]
    return pd.DataFrame({"plate": plate, "cycle": np.arange(1, n + 1), **columns, "energy [J]": energy * rng.uniform(0.9, 1.1, n)})


def test_clutch_cycles_are_the_programs(clutch, wearwell):
    folder, model, rng = clutch
    table = pd.concat([cycles_of(model, rng, 200, "A"), cycles_of(model, rng, 100, "B")])
    table.to_csv(folder / "cycles.csv", index=False)
    code, out, error = wearwell("clutch", "predict", folder / "results" / "model.json", folder / "cycles.csv", "--json")
    assert code == 0, error
    model_file = folder / "results" / "model.json"
    of_file = ww.clutch.CycleSum(model_file).add(folder / "cycles.csv")
    whole = ww.clutch.CycleSum(model_file).add(table)
    parts = ww.clutch.CycleSum(model_file)
    for start in range(0, len(table), 70):
        parts.add(table.iloc[start:start + 70])
    for found in (of_file, whole, parts):
        assert found.summary == json.loads(out)
    assert list(whole.plates.index) == ["A", "B"]
    before = whole.summary
    bad = table.iloc[:5].assign(cycle=[500, 501, 502, 7, 503])
    with pytest.raises(ww.InputError, match="cycle"):
        whole.add(bad)
    assert whole.summary == before  # all of them or none
    with pytest.raises(ww.InputError, match="row 2, column 'torque"):
        whole.add(table.iloc[:3].assign(**{"torque [N m]": [1, -1, 1]}))


def test_rainflow_is_that_of_the_standard():
    """ASTM E1049-85, figure 6: half cycles of 3, 4, 6, 8 (twice), 9 in all, and one cycle of 4."""
    found = ww.rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2], method="three-point")
    counts = found.groupby("range")["count"].sum().to_dict()
    assert counts == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
    assert ww.rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2]).groupby("range")["count"].sum().to_dict() == counts
    assert (ww.rainflow([0, 3, 1, 2, 0], residual="repeat")["count"] == 1).all()
    assert len(ww.rainflow([1.0, 1.0])) == 0
    for wrong, message in (([1.0, np.nan], "row 2"), (["a"], "no numbers"), (np.ones((2, 2)), "2 dimensions")):
        with pytest.raises(ValueError, match=message):
            ww.rainflow(wrong)
    with pytest.raises(ValueError, match="method"):
        ww.rainflow([1, 2], method="five-point")
