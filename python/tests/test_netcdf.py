"""NetCDF as ArviZ reads it: groups, names and numbers, from the program and from a fit."""

import datetime
import os
import warnings

import numpy as np
import pytest

import wearwell as ww

xarray = pytest.importorskip("xarray")
netCDF4 = pytest.importorskip("netCDF4")


def groups_of(path):
    with netCDF4.Dataset(path) as file:
        names = list(file.groups)
    return {name: xarray.load_dataset(path, group=name) for name in names}


@pytest.fixture
def joint(examples):
    return os.path.join(examples, "joint", "study.toml")


@pytest.fixture
def written(joint, tmp_path):
    fit = ww.fit(joint, seed=3, report=False)
    fit.to_netcdf(tmp_path / "fit.nc")
    return fit, groups_of(tmp_path / "fit.nc")


def test_groups_and_dimensions_are_arvizs(written):
    fit, groups = written
    assert set(groups) == {"posterior", "sample_stats", "log_likelihood", "posterior_predictive", "observed_data",
                           "constant_data"}
    for name in ("posterior", "sample_stats", "log_likelihood", "posterior_predictive"):
        for variable in groups[name].data_vars.values():
            assert variable.dims[:2] == ("chain", "draw"), (name, variable.name)
        assert dict(groups[name].sizes)["chain"] == 4 and dict(groups[name].sizes)["draw"] == 1000
        assert groups[name]["draw"].to_numpy().tolist() == list(range(1000))
    for group in groups.values():
        assert group.attrs["inference_library"] == "wearwell"
        assert group.attrs["inference_library_version"] == ww.__version__
        made = datetime.datetime.fromisoformat(group.attrs["created_at"])
        assert abs(datetime.datetime.now(datetime.timezone.utc) - made).total_seconds() < 600
    assert groups["posterior"]["k"].attrs["units"] == "mm^3/(N m)"
    assert groups["posterior"].attrs["trusted"] == "yes"


def test_numbers_are_those_of_the_fit(written):
    fit, groups = written
    for name in ("k", "sigma"):
        assert (groups["posterior"][name].to_numpy().reshape(-1) == fit.draws[name].to_numpy()).all()
    names = {"lp": "lp", "acceptance_rate": "accept_stat", "step_size": "stepsize", "tree_depth": "treedepth",
             "n_steps": "n_leapfrog", "diverging": "divergent", "energy": "energy"}
    assert set(groups["sample_stats"].data_vars) == set(names)
    for theirs, ours in names.items():
        assert (groups["sample_stats"][theirs].to_numpy().reshape(-1) == fit.sample_stats[ours].to_numpy()).all()
    assert groups["sample_stats"]["diverging"].dtype == bool


def test_log_likelihood_is_the_law_written_out(written):
    """V is normal about k W with sd sigma, W = cycles x 5.966 N m; data in mm^3."""
    fit, groups = written
    volume = groups["observed_data"]["volume"].to_numpy()
    cycles = groups["constant_data"]["cycles"].to_numpy()
    mean = fit.draws["k"].to_numpy()[:, None] * cycles * 5.966
    sd = fit.draws["sigma"].to_numpy()[:, None]
    expected = -0.5 * np.log(2 * np.pi) - np.log(sd) - 0.5 * ((volume - mean) / sd) ** 2
    np.testing.assert_allclose(groups["log_likelihood"]["volume"].to_numpy().reshape(4000, -1), expected, rtol=1e-10)


def test_predictive_draws_are_of_the_predicted_law(written):
    fit, groups = written
    drawn = groups["posterior_predictive"]["volume"]
    assert drawn["volume_at"].to_numpy().tolist() == [20585]
    told = fit.predictions.iloc[0]
    below = (drawn.to_numpy() < told["pi05"]).mean(), (drawn.to_numpy() < told["pi95"]).mean()
    # 4000 draws with about 1000 effective ones: three standard errors of a share of 5 % are 0.02.
    assert abs(below[0] - 0.05) < 0.02 and abs(below[1] - 0.95) < 0.02


def test_the_program_writes_the_same(written, joint, wearwell, tmp_path):
    code, out, error = wearwell("fit", joint, "--seed", 3, "--no-report", "-o", tmp_path / "results", "--netcdf",
                                tmp_path / "there.nc")
    assert code == 0, error
    assert out.endswith(f"The draws for ArviZ are in {tmp_path / 'there.nc'}\n")
    there = groups_of(tmp_path / "there.nc")
    assert there.keys() == written[1].keys()
    for name, group in written[1].items():
        assert there[name].equals(group), name


def test_observations_that_were_seen_alike_stand_as_often(wearwell):
    """Sum over observations: the log-likelihood of the whole table, however its rows are counted."""
    table = {"V": [1.0, 2.0, 3.0], "x": [1.5, 2.5, 3.5], "count": [1, 3, 2]}
    text = ww.Study(formula="V = a*x", data=table, priors={"a": ww.half_normal(10), "sigma": ww.half_normal(1)})
    alike = {k: np.repeat(v, table["count"]) for k, v in table.items() if k != "count"}
    spread = ww.Study(formula="V = a*x", data=alike, priors={"a": ww.half_normal(10), "sigma": ww.half_normal(1)})
    sums = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        for study in (text, spread):
            tree = study.fit(seed=1, method="exact", draws=100, report=False).to_datatree()
            likelihood = tree["log_likelihood"]["V"].to_numpy()
            assert likelihood.shape == (4, 100, 6)
            sums.append(likelihood.sum(axis=-1))
    np.testing.assert_allclose(sums[0].mean(), sums[1].mean(), atol=0.5)  # draws differ, the posterior does not


def test_every_kind_of_study_is_written(examples, tmp_path):
    for study in ("bearing/study.toml", "fatigue/study.toml", "formula/study.toml", "life/study.toml", "accelerated/study.toml"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ww.CheckWarning)
            fit = ww.fit(os.path.join(examples, study), seed=1, chains=2, draws=50, warmup=100, report=False)
        fit.to_netcdf(tmp_path / "fit.nc")
        groups = groups_of(tmp_path / "fit.nc")
        assert len(groups["posterior"].data_vars) == len(fit.parameters), study
        likelihood = next(iter(groups["log_likelihood"].data_vars.values()))
        assert likelihood.shape[-1] == fit.results["loo"]["observations"], study
        assert np.isfinite(likelihood.to_numpy()).all(), study
        assert groups["observed_data"].data_vars, study


def test_what_cannot_be_written_leaves_nothing(examples, joint, wearwell, tmp_path):
    code, _, error = wearwell("fit", os.path.join(examples, "clutch", "study.toml"), "--netcdf", tmp_path / "fit.nc", "-o",
                              tmp_path / "results")
    assert code == 2 and "no posterior" in error
    code, _, error = wearwell("fit", joint, "--netcdf", joint, "-o", tmp_path / "results")
    assert code == 2 and "--netcdf" in error
    code, _, error = wearwell("fit", joint, "--netcdf", "/proc/none/fit.nc", "-o", tmp_path / "results")
    assert code == 2 and "fit.nc" in error
    assert os.listdir(tmp_path) == []
