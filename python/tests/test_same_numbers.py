"""An example of each model and kind of file, fitted here and by the program with the same seed: byte for byte the same files."""

import os
import subprocess
import warnings

import pytest

import wearwell as ww
from wearwell._impl.messages import in_arguments
from conftest import binary, clutch_study

studies = ["accelerated/study", "bearing/study", "clutch/study", "degradation/steps", "fatigue/study", "joint/lognormal_flat", "joint/pointwise",
           "joint/study", "life/study", "messy/german_excel", "messy/logger", "spectrum/study", "spring/sensible", "staircase/study", "strain/study"]


def files_below(folder):
    found = {}
    for here, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(here, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


@pytest.mark.parametrize("name", studies)
def test_files_are_those_of_the_program(name, examples, tmp_path):
    study = os.path.join(examples, *f"{name}.toml".split("/"))
    if name == "clutch/study":
        study = clutch_study(tmp_path / "clutch", repetitions=5)
    seed = None if name == "clutch/study" else 7  # a campaign has its seeds in its file
    fewer = {"draws": 200, "warmup": 200} if seed else {}
    options = ("--seed", str(seed), "--draws", "200", "--warmup", "200") if seed else ()
    # Both at once: each has stretches that one core alone can do.
    program = subprocess.Popen([binary, "fit", study, *options, "--quiet", "--no-report", "-o", tmp_path / "there"],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ww.CheckWarning)
            fit = ww.fit(study, seed=seed, report=False, **fewer)
        fit.write(tmp_path / "here")
    finally:
        _, error = program.communicate()
    assert program.returncode <= 1, error
    assert fit.trusted == (program.returncode == 0)
    here, there = files_below(tmp_path / "here"), files_below(tmp_path / "there")
    assert here.keys() == there.keys()
    assert not [name for name in here if here[name] != there[name]]
    if name == "clutch/study":
        campaign_has_no_posterior(fit, tmp_path)


def campaign_has_no_posterior(fit, tmp_path):
    with pytest.raises(ww.InputError, match="no parameters"):
        fit.parameters
    with pytest.raises(ww.InputError, match="no posterior"):
        fit.to_netcdf(tmp_path / "nothing.nc")
    with pytest.raises(ww.InputError, match="posterior"):
        fit.residuals()
    assert not (tmp_path / "nothing.nc").exists()


def test_with_report_and_other_method(examples, wearwell, tmp_path):
    study = os.path.join(examples, "joint", "study.toml")
    options = ("--method", "metropolis", "--chains", 3, "--draws", 500, "--warmup", 200, "--seed", 11)
    code, out, _ = wearwell("fit", study, *options, "-o", tmp_path / "there")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        fit = ww.fit(study, seed=11, method="metropolis", chains=3, draws=500, warmup=200)
    fit.write(tmp_path / "here")
    here, there = files_below(tmp_path / "here"), files_below(tmp_path / "there")
    # The page tells the seconds that it took; the list has its sum.
    timed = {"report.html", "report.json", "results.sha1"}
    assert here.keys() == there.keys()
    assert {n for n in here if here[n] != there[n]} <= timed
    assert in_arguments(out).startswith(str(fit))
    assert abs(len(here["report.html"]) - len(there["report.html"])) < 40
    fit.report(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_bytes() == here["report.html"]


def test_number_of_threads_changes_nothing(examples):
    study = os.path.join(examples, "joint", "study.toml")
    one, all_of_them = (ww.fit(study, seed=2, threads=n, report=False) for n in (1, 0))
    assert one.results == all_of_them.results
    assert (one.draws == all_of_them.draws).all().all()


def test_draws_are_those_of_the_file(examples, tmp_path):
    import pandas

    fit = ww.fit(os.path.join(examples, "joint", "study.toml"), seed=5, report=False)
    fit.write(tmp_path / "results")
    for chain in range(4):
        written = pandas.read_csv(tmp_path / "results" / f"draws_{chain + 1}.csv", comment="#", float_precision="round_trip")
        assert (written[["k", "sigma"]].to_numpy() == fit.draws.loc[chain].to_numpy()).all()
        assert (written["energy__"].to_numpy() == fit.sample_stats.loc[chain]["energy"].to_numpy()).all()
        assert (written["treedepth__"].to_numpy() == fit.sample_stats.loc[chain]["treedepth"].to_numpy()).all()
