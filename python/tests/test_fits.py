"""What a fit is: verdict, frames, exceptions, Ctrl-C, progress, copies, threads, forks, memory."""

import copy
import json
import multiprocessing
import os
import pickle
import re
import resource
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings
from concurrent.futures import ThreadPoolExecutor

import pytest

import wearwell as ww
from conftest import source


@pytest.fixture
def joint(examples):
    return os.path.join(examples, "joint", "study.toml")


@pytest.fixture(scope="module")
def fit():
    """One for all tests: a fit does not change."""
    return ww.fit(os.path.join(source, "examples", "joint", "study.toml"), seed=3)


def test_parameters_are_the_summarys_by_quadrature(fit):
    k = fit.results["parameters"]["k"]
    assert fit.parameters.loc["k", "mean"] == k["mean"]
    assert fit.parameters.loc["k", "unit"] == "mm^3/(N m)"
    # Table 5 of An et al. (2011): 7.76e-4 +- 0.92e-4, sigma 5.63.
    assert abs(fit.parameters.loc["k", "mean"] - 7.76e-4) < 0.005e-4
    assert abs(fit.parameters.loc["sigma", "mean"] - 5.63) < 0.005
    assert fit.predictions.loc[0, "pi95"] == fit.results["predictions"][0]["pi95"]
    assert fit.lives.loc[0, "b10"] == fit.results["life"]["b10"]
    assert fit.lives.loc[0, "q50"] == fit.results["life"]["b50"]
    assert len(fit.draws) == 4000 and list(fit.draws.columns) == ["k", "sigma"]
    assert fit.sample_stats["divergent"].dtype == bool
    assert fit.tables["parameters"].shape[0] == 2


def test_draws_are_of_the_posterior(fit):
    standard_error = fit.parameters.loc["k", "mcse"]
    assert abs(fit.draws["k"].mean() - fit.parameters.loc["k", "mean"]) < 5 * standard_error


def test_trusted_and_not(fit, examples):
    assert fit.require_trusted() is fit and fit.trusted
    with pytest.warns(ww.CheckWarning, match="proper-posterior fails"):
        improper = ww.fit(os.path.join(examples, "joint", "improper_normal.toml"), seed=1, report=False)
    assert not improper.trusted
    with pytest.raises(ww.NotTrusted, match="proper-posterior"):
        improper.require_trusted()


def test_warning_names_the_callers_line(examples):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ww.fit(os.path.join(examples, "joint", "improper_normal.toml"), seed=1, report=False)
    assert caught and all(w.filename == __file__ for w in caught)


def test_errors_have_the_words_of_the_program(tmp_path, joint, wearwell):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(open(joint).read().replace("[likelihood]", "[likelyhood]"))
    for study in (wrong, tmp_path / "none.toml"):
        _, _, said = wearwell("fit", study)
        with pytest.raises(ww.InputError) as error:
            ww.fit(study)
        assert isinstance(error.value, ValueError)
        assert said == f"wearwell: {error.value}\n"
    fit = ww.fit(joint, seed=1, report=False)
    (tmp_path / "file").write_text("")
    with pytest.raises(ww.InputError, match="file"):
        fit.write(tmp_path / "file")
    with pytest.raises(ww.InputError, match="report=False"):
        fit.report(tmp_path / "page.html")
    with pytest.raises(ww.MachineError) as machine:
        fit.to_netcdf("/dev/full")
    assert isinstance(machine.value, OSError) and isinstance(machine.value, RuntimeError)
    again = pickle.loads(pickle.dumps(machine.value))
    assert type(again) is ww.MachineError and str(again) == str(machine.value)


@pytest.mark.parametrize("options, message", [
    ({"seed": -1}, "seed is -1"), ({"seed": 1.5}, "seed is 1.5"), ({"chains": 0}, "chains is 0"), ({"draws": 5}, "draws is 5"),
    ({"method": "gibbs"}, "method is 'gibbs'"), ({"threads": -1}, "threads is -1"), ({"progress": 3}, "progress is 3")])
def test_options_are_checked(joint, options, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        ww.fit(joint, **options)


def test_progress_is_reported_and_its_exception_stops(joint):
    reported = []
    ww.fit(joint, seed=1, draws=15_000, report=False, progress=lambda *step: reported.append(step))
    # A part that ends within a tenth of a second may not be seen.
    parts = {what for what, *_ in reported}
    assert "iterations" in parts and parts <= {"evaluations of the density", "iterations", "curves", "leave-one-out", "predictions and checks", "data sets"}
    assert all(0 <= done <= total for _, done, total, _ in reported if total)

    def stop(*_):
        raise LookupError("enough")

    start = time.monotonic()
    with pytest.raises(LookupError, match="enough"):
        ww.fit(joint, seed=1, draws=5_000_000, report=False, progress=stop)
    assert ww.fit(joint, seed=3, report=False).trusted  # the next one is as any
    assert time.monotonic() - start < 600


def test_interrupt_stops_and_leaves_nothing(joint, tmp_path):
    """Within 0.2 s of the processor's time: other work on the machine does not count."""
    code = textwrap.dedent(f"""
        import os, signal, threading, time, sys
        import wearwell as ww

        def interrupt():
            global asked
            asked = time.process_time()
            os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.5, interrupt).start()
        try:
            ww.fit({joint!r}, seed=1, draws=9_000_000, report=False, threads=1).write("results")
        except KeyboardInterrupt:
            print("stopped", threading.active_count(), os.listdir("."), time.process_time() - asked < 0.2)
        print(ww.fit({joint!r}, seed=3, report=False).trusted)
    """)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.stdout == "stopped 1 [] True\nTrue\n", done.stderr


def test_other_threads_go_on_meanwhile(joint):
    counted = []

    def count():
        while not done.is_set():
            counted.append(1)
            time.sleep(0.001)

    done = threading.Event()
    counter = threading.Thread(target=count)
    counter.start()
    ww.fit(joint, seed=1, draws=10_000, report=False)
    done.set()
    counter.join()
    assert len(counted) > 20


def test_threads_fit_at_once_the_same_bits(joint, examples):
    studies = [joint, os.path.join(examples, "life", "study.toml")] * 2
    options = {"seed": 4, "report": False, "warmup": 200, "draws": 100}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        alone = [ww.fit(s, **options).results for s in studies[:2]] * 2
        with ThreadPoolExecutor(4) as pool:
            together = list(pool.map(lambda s: ww.fit(s, **options).results, studies))
    assert together == alone


def test_fits_of_two_threads_run_side_by_side(joint):
    """Each goes on to its end while the other one waits within a step of its own: neither holds a lock of the interpreter or the library."""
    both = threading.Barrier(2, timeout=120)

    def one(seed):
        met = []

        def meet(*_):
            if not met:
                met.append(both.wait())  # passes only if the other fit is under way, too

        return ww.fit(joint, seed=seed, draws=10_000, chains=2, threads=1, report=False, progress=meet).seed

    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(one, [1, 2])) == [1, 2]


def _in_child(study, queue):
    queue.put(ww.fit(study, seed=4, report=False).results)


@pytest.mark.parametrize("how", ["fork", "spawn"])
def test_forked_and_spawned_children_fit_too(joint, how):
    here = ww.fit(joint, seed=4, report=False).results  # starts threads, of which a forked child has none
    context = multiprocessing.get_context(how)
    queue = context.Queue()
    children = [context.Process(target=_in_child, args=(joint, queue)) for _ in range(2)]
    for child in children:
        child.start()
    found = [queue.get(timeout=300) for _ in children]
    for child in children:
        child.join(timeout=60)
        assert child.exitcode == 0
    assert found == [here, here]


def test_workers_of_joblib_fit_too(joint):
    joblib = pytest.importorskip("joblib")
    here = ww.fit(joint, seed=4, report=False).parameters
    for backend in ("loky", "threading"):
        found = joblib.Parallel(n_jobs=2, backend=backend)(joblib.delayed(ww.fit)(joint, seed=4, report=False) for _ in range(2))
        assert all(each.parameters.equals(here) for each in found)


def test_pickle_and_copy(fit, tmp_path):
    assert copy.copy(fit).results is fit.results and copy.deepcopy(fit).results is fit.results
    again = pickle.loads(pickle.dumps(fit))
    assert again.results == fit.results and again.checks == fit.checks and str(again) == str(fit)
    assert (again.draws == fit.draws).all().all() and (again.sample_stats == fit.sample_stats).all().all()
    for each, name in ((fit, "one"), (again, "two")):
        each.write(tmp_path / name)
    assert (tmp_path / "one" / "report.html").read_bytes() == (tmp_path / "two" / "report.html").read_bytes()
    assert (tmp_path / "one" / "results.sha1").read_bytes() == (tmp_path / "two" / "results.sha1").read_bytes()
    assert again.ask({"cycles": [30_000]}) == fit.ask({"cycles": [30_000]})


def test_pickled_fit_of_other_data_is_refused(joint, tmp_path):
    (tmp_path / "joint_wear.csv").write_text(open(os.path.join(os.path.dirname(joint), "joint_wear.csv")).read())
    (tmp_path / "study.toml").write_text(open(joint).read())
    fit = ww.fit(tmp_path / "study.toml", seed=1, report=False)
    kept = pickle.dumps(fit)
    table = (tmp_path / "joint_wear.csv").read_text()
    (tmp_path / "joint_wear.csv").write_text(table.replace("44.41", "45.41"))
    assert (tmp_path / "joint_wear.csv").read_text() != table
    again = pickle.loads(kept)
    assert again.parameters.equals(fit.parameters)
    with pytest.raises(ww.InputError, match="have changed since this fit"):
        again.to_netcdf(tmp_path / "fit.nc")


def test_asked_later_is_what_the_study_says(fit, joint):
    """Another [predict] of the same posterior: the numbers of a study that has it."""
    text = open(joint).read()
    later = fit.ask({"cycles": [30_000, 20_585]})
    study = ww.Study.from_toml(re.sub(r"cycles *= *\[20585[^\]]*\]", "cycles = [30000, 20585]", text), folder=os.path.dirname(joint))
    assert study.fit(seed=3, report=False).results["predictions"] == later["predictions"]
    assert later["predictions"][1] == fit.results["predictions"][0]
    narrow = fit.ask({"cycles": [20_585]}, level=0.5)["predictions"][0]
    wide = fit.results["predictions"][0]
    assert wide["pi05"] < narrow["pi05"] < narrow["mean"] < narrow["pi95"] < wide["pi95"]
    with pytest.raises(ww.InputError, match="cykles"):
        fit.ask({"cykles": [1]})


def test_forecasts_are_asked_later(examples):
    """What a study of a repairable system says of the failures to come, without its being fitted again."""
    study = os.path.join(examples, "repairable", "study.toml")
    fit = ww.fit(study, seed=1, method="exact", draws=100, report=False)
    other = re.sub(r"(?m)^next *=.*", 'next = ["200 day"]', open(study).read())
    whole = ww.Study.from_toml(other, folder=os.path.dirname(study)).fit(seed=1, method="exact", draws=100, report=False)
    later = fit.ask({"next": ["200 day"], "age": ["600 day"]})
    assert later["repairable"] == whole.results["repairable"]
    assert later["repairable"]["forecast"] != fit.results["repairable"]["forecast"]
    assert "repairable" not in fit.ask({"age": ["600 day"]})


def test_html_shows_verdict_and_parameters(fit):
    html = fit._repr_html_()
    assert "trusted" in html and "mm^3/(N m)" in html and "7.759e-04" in html.replace("0.0007759", "7.759e-04")
    assert "<script" not in html  # the page itself is data of a frame of its own
    assert "data:text/html;charset=utf-8;base64," in html


def test_an_interpreter_that_fitted_ends_well(joint):
    code = f"import wearwell as ww; ww.fit({joint!r}, seed=1, report=False)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_many_fits_leave_no_memory_behind():
    study = ww.Study(formula="hours = mean_life", family="exponential", data={"hours": [120.0, 340, 560, 230]}, priors={"mean_life": ww.lognormal(300, log_sd=1)})

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    def some(n):
        for seed in range(n):
            fit = study.fit(seed, method="exact", draws=100, report=False)
            json.dumps(fit.results)
            fit.draws

    some(30)
    before = resident()
    some(30)
    assert resident() - before < 1.2e6  # 40 kB each would be a leak of draws or nodes
