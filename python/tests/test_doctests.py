"""The examples of all docstrings run, each by itself, where the examples are."""

import doctest
import json
import os
import shutil
import subprocess
import warnings

import numpy as np
import pytest

import wearwell as ww
from conftest import binary, clutch_study, source
from monitored import monitored
from public_names import docstrings

parser = doctest.DocTestParser()
examples = {name: parser.get_doctest(text, {}, name, name, 0) for name, text in docstrings().items()}
options = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("doctests")
    os.symlink(os.path.join(source, "examples"), folder / "examples")
    return folder


@pytest.fixture(scope="module")
def clutch_results(folder):
    """The results of the clutch's study, with few exponents tried and no repetitions: that is fast."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        ww.fit(clutch_study(folder / "clutch"), report=False).write(folder / "clutch-results")
    return folder / "clutch-results"


@pytest.fixture(scope="module")
def campaign(folder):
    """A simulated campaign of the clutch, as files."""
    design, truth = (os.path.join(source, "examples", "clutch", name) for name in ("design.csv", "truth.toml"))
    subprocess.run([binary, "clutch", "simulate", "--design", design, "--truth", truth, "-o", folder / "campaign"], check=True, capture_output=True)
    shutil.copy(design, folder / "campaign")


@pytest.fixture(scope="module")
def fits():
    """Fits of study files by their arguments: many examples begin with the same one, and a fit does not change."""
    fitted = {}

    def fit(study, seed=None, **options):
        key = (study, seed, *sorted(options.items()))
        if key not in fitted:
            fitted[key] = original(study, seed, **options)
        return fitted[key]

    original = ww.fit
    return fit


@pytest.fixture(scope="module")
def sums_of_damage():
    """Sums of damage by their arguments: each takes seconds."""
    made = {}

    def once(kind, arguments, about=None, name="", tables=None, *others, **options):
        if kind != "damage" or tables:
            return original(kind, arguments, about, name, tables, *others, **options)
        key = (id(about), str(arguments))
        if key not in made:
            made[key] = original(kind, arguments, about, name, tables, *others, **options)
        return made[key]

    original = ww._impl.spectra.found
    return once


@pytest.fixture(scope="module")
def monitor(folder, fits):
    """The address of a monitor that follows two machines."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        fits("examples/fleet/study.toml", seed=1, method="exact", draws=100, report=False).write(folder / "fleet-results")
    (folder / "monitor").mkdir()
    lines = [{"time": f"2026-01-{day:02}T12:00:00Z", "machine": machine, "use_h": day * 20.0, "wear_um": day * rate}
             for machine, rate in (("M042", 0.4), ("M067", 0.5)) for day in (5, 10, 15)]
    with monitored(folder / "monitor", folder / "fleet-results", lines) as url:
        while sum(ww.Monitor(url).units()["readings"]) < len(lines):
            pass
        yield url


@pytest.mark.parametrize("name", [name for name, test in examples.items() if test.examples])
def test_examples_run(name, folder, monkeypatch, request):
    if name.startswith("clutch."):
        request.getfixturevalue("clutch_results")
    if name == "clutch":
        request.getfixturevalue("campaign")
    if name.startswith("Monitor"):
        examples[name].globs["url"] = request.getfixturevalue("monitor")
    if name not in ("CheckWarning", "MissingFileError", "fit"):
        monkeypatch.setattr(ww, "fit", request.getfixturevalue("fits"))
    monkeypatch.setattr(ww._impl.spectra, "found", request.getfixturevalue("sums_of_damage"))
    monkeypatch.chdir(folder)
    said = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        result = doctest.DocTestRunner(optionflags=options).run(examples[name], out=said.append)
    assert result.failed == 0, "".join(said)


def test_there_are_examples():
    assert sum(len(test.examples) for test in examples.values()) > 150


def leaves(value, at=""):
    if isinstance(value, dict):
        return [leaf for key, each in value.items() for leaf in leaves(each, f"{at}.{key}")]
    if isinstance(value, list):
        return [leaf for i, each in enumerate(value) for leaf in leaves(each, f"{at}[{i}]")]
    return [(at, value)]


def test_wear_model_of_the_r_package_is_this_one(clutch_results):
    """The example of its help page comes with the package."""
    with open(clutch_results / "model.json") as here, open(os.path.join(source, "r", "inst", "extdata", "clutch_model.json")) as there:
        here, there = leaves(json.load(here)), leaves(json.load(there))
    assert [at for at, _ in here] == [at for at, _ in there]
    for (at, a), (_, b) in zip(here, there):
        assert a == b if isinstance(a, str) else np.isclose(a, b, rtol=1e-6, atol=0), at
