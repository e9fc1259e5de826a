"""New rows for a fit: byte for byte what ``wearwell update`` writes, and the updated fit answers as any other."""

import os
import pickle
import warnings

import pandas as pd
import pytest

import wearwell as ww
from test_same_numbers import files_below

few = {"seed": 7, "method": "exact", "draws": 100, "report": False}
quick = ("--seed", 7, "--method", "exact", "--draws", 100, "--no-report", "--quiet")
june = pd.DataFrame({"cycles": [15000, 18000], "volume": [69.0, 83.5]})
july = pd.DataFrame({"cycles": [20000], "volume": [92.0]})


def quietly(work, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        return work(*arguments, **options)


@pytest.fixture
def study(examples):
    return os.path.join(examples, "joint", "study.toml")


@pytest.fixture
def fit(study):
    return quietly(ww.fit, study, **few)


def columns_of(study):
    """Headings of the example's data, by name."""
    data = pd.read_csv(os.path.join(os.path.dirname(study), "joint_wear.csv"), comment="#")
    return list(data.columns)


def rows(frame, study):
    headings = columns_of(study)
    named = {name: next(h for h in headings if name in h) for name in frame}
    return frame.rename(columns=named)[[h for h in headings if h in named.values()]]


def test_files_are_those_of_the_program_for_a_chain_of_updates(study, fit, wearwell, tmp_path):
    assert wearwell("fit", study, *quick, "-o", tmp_path / "fit")[0] <= 1
    there, here = tmp_path / "fit", fit
    for name, frame in (("june", june), ("july", july)):
        file = tmp_path / f"{name}.csv"
        rows(frame, study).to_csv(file, index=False)
        code, _, error = wearwell("update", there, file, "-o", tmp_path / name, "--no-report", "--quiet")
        assert code <= 1, error
        there, here = tmp_path / name, quietly(here.update, file, report=False)
        here.write(tmp_path / f"here-{name}")
        a, b = files_below(tmp_path / f"here-{name}"), files_below(there)
        assert a.keys() == b.keys()
        assert not [each for each in a if a[each] != b[each]]
        assert here.results["update"]["counted"] == len(frame)
    assert here.results["update"]["rows_before"] == 12 + len(june)  # of the file, before data.sql


def test_a_frame_is_a_file(study, fit, tmp_path):
    file = tmp_path / "june.csv"
    rows(june, study).to_csv(file, index=False)
    frame, of_file, function = (quietly(*work, report=False) for work in (
        (fit.update, rows(june, study)), (fit.update, file), (ww.update, fit, rows(june, study))))
    assert frame.draws.equals(of_file.draws) and frame.draws.equals(function.draws)
    assert frame.results["update"].pop("files") == "data" and of_file.results["update"].pop("files") == "june.csv"
    assert frame.results["update"] == of_file.results["update"]


def test_of_a_folder(study, fit, tmp_path):
    fit.write(tmp_path / "results")
    of_folder = quietly(ww.update, tmp_path / "results", rows(june, study), report=False)
    assert of_folder.draws.equals(quietly(fit.update, rows(june, study), report=False).draws)
    with pytest.raises(FileNotFoundError, match="no such file or folder"):
        ww.update(tmp_path / "nothing", june)


def test_the_updated_fit_answers_as_any_fit(study, fit, tmp_path):
    later = quietly(fit.update, rows(june, study))
    assert isinstance(later, ww.Fit) and later.trusted and later.seed == 7
    assert len(later.draws) == 400
    assert later.ask({"cycles": [30_000]})["predictions"][0]["pi95"] > 0
    assert later.lives.loc[0, "q50"] > 0 and later.plots[0] == "curve"
    assert "new-data" in [check.name for check in later.checks]
    later.report(tmp_path / "page.html")
    again = pickle.loads(pickle.dumps(later))
    assert again.results == later.results and again.draws.equals(later.draws)
    assert again.ask({"cycles": [30_000]}) == later.ask({"cycles": [30_000]})
    assert quietly(again.update, rows(july, study), report=False).draws.equals(quietly(later.update, rows(july, study), report=False).draws)


def test_a_repeated_reading_counts_once_and_order_does_not_matter(study, fit):
    both = quietly(fit.update, rows(pd.concat([june, july, june]), study), report=False)
    parts = quietly(fit.update, [rows(july, study), rows(june, study)], report=False)
    assert both.draws.equals(parts.draws)
    assert both.results["update"]["repeated"] == 2 and both.results["update"]["counted"] == 3


def test_a_contradiction_is_a_warning(study, fit):
    with pytest.warns(ww.CheckWarning, match="new-data warns"):
        fit.update(rows(pd.DataFrame({"cycles": [20000], "volume": [920.0]}), study), report=False)


def test_errors_name_arguments(study, fit, examples):
    with pytest.raises(ww.InputError, match="^repeated is 'twice'; it is 'once' or 'another'"):
        fit.update(june, repeated="twice")
    with pytest.raises(ww.InputError, match="^data has no column"):
        fit.update({"cycles": [1000]})
    with pytest.raises(ww.InputError, match="^data is missing"):
        fit.update([])
    with pytest.raises(ww.InputError, match="^threads is -1"):
        fit.update(june, threads=-1)
    with pytest.raises(ww.InputError, match="^fit is int; it is a fit, or the folder of a result"):
        ww.update(3, june)


def test_a_test_that_may_be_a_repeat_is_refused(examples):
    pumps = {"hours": [312, 480, 510, 640, 700, 150], "failed": [1, 1, 1, 1, 0, 1]}
    fit = quietly(ww.life, pumps, "hours", event="failed", units={"hours": "h"}, **few)
    same = {"hours": [312], "failed": [1]}
    with pytest.raises(ww.InputError, match='add repeated="once" or repeated="another"'):
        fit.update(same)
    once, another = (quietly(fit.update, same, repeated=each, report=False) for each in ("once", "another"))
    assert once.results["data"]["rows"] == 6 and another.results["data"]["rows"] == 7
    whole = quietly(ww.Study.from_toml(fit.study.toml, {"data": {"hours": [*pumps["hours"], 312], "failed": [*pumps["failed"], 1]}}).fit, **few)
    assert another.parameters["mean"].to_numpy() == pytest.approx(whole.parameters["mean"].to_numpy(), rel=1e-10)  # rows in another order
    assert once.parameters["mean"].to_numpy() == pytest.approx(fit.parameters["mean"].to_numpy(), rel=1e-10)


def test_a_mode_that_no_earlier_row_has_is_named(tmp_path):
    pumps = pd.DataFrame({"hours": [312, 480, 510, 640, 700, 150, 210, 260, 330, 420],
                          "cause": ["seal", "wear", "wear", "seal", "censored", "seal", "wear", "seal", "wear", "wear"]})
    fit = quietly(ww.life, pumps, "hours", mode="cause", family="exponential", units={"hours": "h"}, **few)
    new = pd.DataFrame({"hours [h]": [400, 555], "cause": ["wear", "seel"]})
    with pytest.warns(ww.CheckWarning, match=r"new-data warns: .*data, row 2, column 'cause': no earlier row has 'seel', which adds mean_life\[seel\]; "
                                             r"did you mean 'seal'\?"):
        later = fit.update(new, report=False)
    assert [each["place"] for each in later.results["update"]["contradictions"]] == ["data, row 2, column 'cause'"]
    known = quietly(fit.update, new.assign(cause=["wear", "seal"]), report=False)
    assert not known.results["update"]["contradictions"]


def test_what_became_of_the_rows_is_told_of_an_improper_posterior_too(tmp_path):
    """Two inspections with flat priors leave k and sigma open; the row is known already."""
    (tmp_path / "two.csv").write_text("cycles,volume [mm^3]\n1000,8.1\n2000,17.0\n")
    study = ww.Study.from_toml(
        'model = "archard-joint"\n[data]\nfile = "two.csv"\n[data.columns]\ncycles = "cycles"\nvolume = "volume [mm^3]"\n'
        '[conditions]\nwork_per_cycle = "5.966 N m"\n[likelihood]\nfamily = "normal"\n[prior]\n'
        'k = { distribution = "flat", lower = "0 mm^3/(N m)" }\nsigma = { distribution = "flat", lower = "0 mm^3" }\n', folder=tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        before = study.fit(seed=1, method="exact", draws=100, report=False)
        later = before.update(pd.DataFrame({"cycles": [2000], "volume [mm^3]": [17.0]}), repeated="once")
    assert [c.verdict for c in later.checks if c.name == "proper-posterior"] == ["fail"]
    assert later.results["update"]["repeated"] == 1 and later.results["update"]["counted"] == 0
    assert later.results["update"]["rows_before"] == 2
