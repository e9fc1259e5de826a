"""Damage, design curves and load spectra: the program's numbers to the last digit, tables of any kind, errors of arguments."""

import json
import os
import signal
import threading
import time
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww
from test_plan import files_below


@pytest.fixture(scope="module")
def fitted(tmp_path_factory):
    """The curve of examples/spectrum, and the folder of its result."""
    from conftest import source

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        fit = ww.fit(os.path.join(source, "examples", "spectrum", "study.toml"), seed=1, method="exact", draws=100, report=False)
    folder = tmp_path_factory.mktemp("spectra") / "curve"
    fit.write(folder)
    return fit, folder


@pytest.fixture
def same(wearwell, tmp_path):
    """Compares an answer with what the program answers to these arguments: JSON and tables to the byte, apart from ``keys``, and text."""

    def compare(answer, file, *arguments, keys=()):
        here, there = tmp_path / "here", tmp_path / "there"
        code, out, error = wearwell("fatigue", *arguments, "-o", there)
        assert code == 0, error
        answer.write(here)
        for name in (there / "tables").glob("*.parquet"):  # the program's alone
            name.unlink()
        here, there = files_below(here), files_below(there)
        given, wanted = json.loads(here[file]), json.loads(there[file])
        assert given == answer.summary
        for key in keys:
            assert given.pop(key) != wanted.pop(key)
        assert given == wanted
        if not keys:
            assert here[file] == there[file]
        tables = {name for name in there if name.startswith("tables/") and name.endswith(".csv")}
        assert tables and tables == {name for name in here if name.startswith("tables/")}
        assert not [name for name in tables if here[name] != there[name]]
        assert "--" not in str(answer).replace("---", "")
        return out

    return compare


@pytest.fixture
def loads(examples):
    return os.path.join(examples, "spectrum", "loads.csv")


@pytest.fixture(scope="module")
def counted(fitted):
    """Damage of counted cycles: a sum over 30 000 points of the posterior takes seconds, so tests share it."""
    cycles = pd.DataFrame({"range": [900, 480], "mean": [0, 50], "count": [2, 2000]})
    with pytest.warns(ww.CheckWarning, match="extrapolation warns: .* of the damage is due to amplitudes below the tested range") as caught:
        found = fitted[0].damage(cycles, units="MPa", block="100 h", b=[1, 5, 10], confidence=0.95)
    assert caught[0].filename == __file__
    return cycles, found


def test_damage_is_the_programs(same, fitted, counted, tmp_path):
    cycles, found = counted
    file = tmp_path / "cycles.csv"
    cycles.to_csv(file, index=False)
    out = same(found, "life.json", "life", fitted[1], file, "--unit", "MPa", "--block", "100 h", "--b-lives", 1, 5, 10, "--confidence", 95,
               keys=["history"])
    assert "B5 life [h]" in out and "B5 life [h]" in str(found)


def test_damage_in_frames(counted):
    found = counted[1]
    assert found.lives["percent"].tolist() == [1, 5, 10] and set(found.lives["unit"]) == {"h"}
    assert (found.lives["bound"] < found.lives["q50"]).all()
    assert found.life.q05 < found.life.q50 < found.life.q95 and found.life.unit == "h"
    assert found.life.q50 / 100 == pytest.approx(1 / found.damage.q50, rel=0.05)  # the median damage sum is 1
    assert found.sources["share"].sum() == pytest.approx(1, abs=0.01)
    assert list(found.tables) == ["lives", "contributions", "damage"]


def test_cycles_without_damage_have_no_end(fitted):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        found = fitted[0].damage({"range [MPa]": [100.0], "mean [MPa]": [0.0], "cycles": [1.0]}, rule="original", knee="400 MPa")
    assert np.isinf(found.lives["q50"]).all() and np.isinf(found.life.q50) and not len(found.sources)


def test_design_curves_are_the_programs(same, fitted, tmp_path):
    fit, folder = fitted
    out = same(ww.design(folder, stress=["300 MPa", "500 MPa"], stress_ratio=-1, reliability=0.99, confidence=0.95), "design.json", "design", folder,
               "--stress", "300 MPa", "--stress", "500 MPa", "--stress-ratio", -1, "--reliability", 99, "--confidence", 95)
    assert out.startswith("Design curves, life [cycles], at R = -1")


def test_design_curves_of_several_fits(same, fitted, examples, tmp_path):
    fit, folder = fitted
    text = open(os.path.join(examples, "spectrum", "study.toml"), encoding="utf-8").read()
    tests = pd.read_csv(os.path.join(examples, "spectrum", "tests.csv"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        other = ww.Study.from_toml(text.replace('"goodman"', '"gerber"'), {"tests.csv": tests}).fit(seed=1, method="exact", draws=100, report=False)
        other.write(tmp_path / "gerber")
        found = fit.design(other, names=["goodman", "gerber"], stress="400 MPa", stress_ratio=-1)
        by_folder = ww.design(folder, tmp_path / "gerber", stress="400 MPa", stress_ratio=-1)
    same(by_folder, "design.json", "design", folder, tmp_path / "gerber", "--stress", "400 MPa", "--stress-ratio", -1)
    assert sorted(found.models["study"]) == ["gerber", "goodman"] and found.models["weight"].sum() == pytest.approx(1)
    assert found.curves["curve"].tolist() == ["90/90", "B-basis", "A-basis", "97.7/90"]
    assert (found.curves["most_cautious"] <= found.curves["life"] * (1 + 1e-6)).all()
    assert found.curves["life"].tolist() == by_folder.curves["life"].tolist()


def test_spectra_are_the_programs(same, loads):
    given = {"column": "stress", "bins": 12, "residual": "repeat"}
    options = ["--column", "stress", "--bins", 12, "--residual", "repeat"]
    same(ww.spectrum(loads, **given), "rainflow.json", "rainflow", loads, *options)
    frame = pd.read_csv(loads)
    same(ww.spectrum(frame, **given, time="time [s]"), "rainflow.json", "rainflow", loads, *options, "--time", "time [s]", keys=["file"])
    stress = frame["stress [MPa]"]
    for signal in (stress, stress.to_numpy(), stress.tolist(), stress.to_numpy()[::-1][::-1]):
        found = ww.spectrum(signal, bins=12, residual="repeat", units=None if isinstance(signal, pd.Series) else "MPa")
        assert found.tables["cycles"].equals(ww.spectrum(loads, **given).tables["cycles"])


@pytest.mark.parametrize("given, message", [
    ({"loads": [0, 900, 100]}, "loads, column 'load' has no unit: give it in the heading, \"stress [MPa]\", or with units MPa"),
    ({"loads": [0, 900, float("nan")], "units": "MPa"}, "loads, row 3, column 'load': no value"),
    ({"loads": ["a", "b"], "units": "MPa"}, "loads has no numeric column that is a load"),
    ({"loads": [5.0, 5.0], "units": "MPa"}, "loads, column 'load' has 5 throughout and no cycle"),
    ({"loads": {"stress [MPa]": [1.0, 2.0], "cycles": [1, 1]}}, "column 'cycles' counts cycles"),
    ({"loads": {"a [MPa]": [1.0, 2.0], "b [MPa]": [1.0, 2.0]}}, "name the load with column"),
    ({"loads": {"stress [MPa]": [1.0, 2.0]}, "column": "strain"}, "strain"),
    ({"loads": {"stress [MPa]": ["x", "y"]}, "column": "stress"}, "column 'stress [MPa]' holds texts; a signal has numbers"),
    ({"loads": {"force [kN]": [1.0, 2.0]}}, "give the factor to stress: scale '0.35 MPa/kN'"),
    ({"rule": "haibch"}, "rule: 'haibch' is not one of original, elementary, haibach, liu-zenner; did you mean 'haibach'?"),
    ({"rule": "haibach"}, "knee '2e6 cycles'"),
    ({"knee": 150}, "knee: '150' may be a life or a stress"),
    ({"method": "two-point"}, "method: 'two-point' is not one of four-point, three-point"),
    ({"confidence": 90}, "confidence: 90 is not a share from 0.01 to 0.9999"),
    ({"b": [0]}, "b: 0 is not a percentage"),
    ({"b": []}, "b: no percentage is given"),
    ({"block": "350"}, "block: '350' must be a number with a unit"),
    ({"damage_sum": "1 x/ 0.5"}, "damage_sum: the factor 0.5 must be at least 1"),
])
def test_errors_of_damage_name_argument_or_cell(fitted, given, message):
    with pytest.raises(ww.InputError) as error:
        fitted[0].damage(**{"loads": {"stress [MPa]": [0.0, 900.0, 100.0, 800.0]}, **given})
    assert message in str(error.value)
    assert "--" not in str(error.value)


def test_errors_of_design_and_spectrum(fitted, tmp_path):
    fit, folder = fitted
    for given, message in [
        ({"stress": "400"}, "stress"), ({"stress": "-4 MPa"}, "stress"), ({"mean_stress": "0 MPa", "stress_ratio": -1}, "say the same in two ways"),
        ({"reliability": 99}, "reliability: 99 is not a share"), ({"confidence": "high"}, "confidence is a text; it is a number"),
        ({"stress_ratio": 1}, "stress_ratio 1: smallest over largest stress"), ({"names": ["a", "b"]}, "2 names are given for 1 fits"),
    ]:
        with pytest.raises(ww.InputError) as error:
            fit.design(**{"stress": "400 MPa", **({"stress_ratio": -1} if "mean_stress" not in given else {}), **given})
        assert message in str(error.value) and "--" not in str(error.value)
    with pytest.raises(ww.InputError, match="names: 'x' is given twice"):
        ww.design(fit, fit, names=["x", "x"])
    with pytest.raises(ww.InputError, match="at least"):
        ww.design()
    with pytest.raises(ww.InputError, match="bin_width is 0; it is above 0"):
        ww.spectrum([1.0, 2.0, 1.0], bin_width=0.0)
    with pytest.raises(ww.InputError, match="bins is 0; it is a whole number from 1 to 1024"):
        ww.spectrum([1.0, 2.0, 1.0], bins=0)
    with pytest.raises(FileNotFoundError):
        ww.spectrum(tmp_path / "nothing.csv")
    joint = ww.life({"hours": [1.0, 2.0, 3.0, 4.0]}, "hours", units={"hours": "h"}, seed=1, method="exact", draws=100, report=False)
    with pytest.raises(ww.InputError, match='its model is "formula"; an S-N curve is needed'):
        joint.damage([0.0, 1.0], units="MPa")
    with pytest.raises(ww.InputError, match='a: its model is "formula"; an S-N curve is needed'):
        joint.design()


def test_interrupt_stops_a_sum_of_damage(fitted):
    """The rest takes 1.2 s of processor or more; a stop 0.01 to 0.15, also beside other work."""
    sent = []

    def interrupt():
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.2, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        fitted[0].damage({"range [MPa]": [900.0], "mean [MPa]": [0.0], "cycles": [1.0]})
    assert time.process_time() - sent[0] < 0.8
