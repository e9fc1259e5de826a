"""The notebooks of examples/notebooks run from the first cell to the last, and show the program's numbers."""

import glob
import json
import os
import shutil

import pytest

from conftest import clutch_study, source

nbformat = pytest.importorskip("nbformat")
preprocessors = pytest.importorskip("nbconvert.preprocessors")
pytest.importorskip("ipykernel")
notebooks = sorted(glob.glob(os.path.join(source, "examples", "notebooks", "*.ipynb")))


def test_there_is_one_for_each_preset_and_each_tutorial():
    assert [os.path.basename(n)[:-6] for n in notebooks] == ["bearing", "clutch", "fatigue", "fleet", "formula", "joint", "lasers", "life", "springs"]


def link_examples(folder):
    """The examples, with a clutch study that tries few exponents: what a notebook shows does not depend on the search."""
    folder.mkdir()
    for name in os.listdir(os.path.join(source, "examples")):
        if name != "clutch":
            os.symlink(os.path.join(source, "examples", name), folder / name)
    clutch_study(folder / "clutch")


@pytest.mark.parametrize("notebook", notebooks, ids=lambda n: os.path.basename(n)[:-6])
def test_notebook_runs(notebook, tmp_path, monkeypatch):
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))
    link_examples(tmp_path / "examples")
    with open(notebook) as file:
        text = nbformat.read(file, as_version=4)
    assert not any(cell.get("outputs") for cell in text.cells), "outputs are not kept"
    preprocessors.ExecutePreprocessor(timeout=600, kernel_name="python3").preprocess(text, {"metadata": {"path": str(tmp_path)}})
    shown = [output for cell in text.cells for output in cell.get("outputs", [])]
    assert any("trusted" in output.get("data", {}).get("text/html", "") for output in shown)


def test_joints_notebook_shows_the_programs_numbers(tmp_path, wearwell, examples):
    """The cell that asks for the life until 120 mm^3, against a study file that asks the same."""
    import wearwell as ww

    study = open(os.path.join(examples, "joint", "study.toml")).read().replace('"100 mm^3"', '"120 mm^3"')
    (tmp_path / "study.toml").write_text(study)
    shutil.copy(os.path.join(examples, "joint", "joint_wear.csv"), tmp_path)
    _, out, _ = wearwell("fit", tmp_path / "study.toml", "--seed", 1, "--json", "--no-report", "-o", tmp_path / "results")
    fit = ww.fit(os.path.join(examples, "joint", "study.toml"), seed=1, report=False)
    asked = fit.ask({"cycles": [25_000], "limit": "120 mm^3", "risk": "1 %"})["life"]
    assert asked == json.loads(out)["life"]
