"""The lines of Python that the page of ``wearwell open`` shows: each runs as it stands, and gives what the page shows."""

import contextlib
import json
import subprocess
import sys
import threading
import time
import urllib.request

import pytest
from conftest import binary

lives = [212.5, 305, 371, 418.5, 466, 509, 540, 588, 633, 702, 749, 1800, 1800, 1800, 1800]
table = "hours [h],status\n" + "".join(f"{each},{'failure' if each < 1800 else 'running'}\n" for each in lives)


@contextlib.contextmanager
def opened(folder):
    """Asks the program that serves this folder, as the page does."""
    process = subprocess.Popen([binary, "open", folder, "--no-browser"], stdout=subprocess.PIPE, text=True)
    try:
        line = process.stdout.readline()
        base, token = line[line.index("http"):].strip().split("/#")

        def ask(path, body=None):
            request = urllib.request.Request(base + path, data=None if body is None else json.dumps(body).encode(),
                                             headers={"Authorization": f"Bearer {token}", "Content-Type": "application/json"})
            with urllib.request.urlopen(request, timeout=300) as answer:
                return json.load(answer)

        ended = threading.Event()

        def stay():  # the program ends a minute after its page is closed
            while not ended.wait(10):
                ask("/api/session")

        page = threading.Thread(target=stay, daemon=True)
        page.start()
        yield ask
        ended.set()
        page.join()
    finally:
        process.terminate()
        process.wait(30)


def run(line, folder):
    """What the line prints, in another folder than that of the page."""
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", line], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"{line}\n{done.stderr}"
    return done.stdout.strip()


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    # A path with what Python and shells read in their own way.
    folder = tmp_path_factory.mktemp("page") / "Jürgen's \"rig\" \\ $1"
    folder.mkdir()
    (folder / "pumps.csv").write_text(table)
    with opened(folder) as ask:
        ask("/api/open", {"file": "pumps.csv"})
        for _ in range(1200):  # a table is read beside the answers
            session = ask("/api/session")
            if session["reading"]["state"] != "running":
                break
            time.sleep(0.05)
        assert session["reading"]["state"] == "done", session["reading"]
        study = ask("/api/guess", {"file": "pumps.csv", "number": session["table_number"]})["readings"][0]["text"]
        for name, family in (("pumps", "weibull"), ("other", "gamma")):
            text = study.replace('family = "weibull"', f'family = "{family}"')
            ask("/api/save", {"file": f"{name}.toml", "text": text, "before": None})
            ask("/api/fit", {"file": f"{name}.toml", "text": text})
            for _ in range(1200):
                fit = ask("/api/session")["fit"]
                if fit["state"] != "running":
                    break
                time.sleep(0.05)
            assert fit["state"] == "done", fit
        yield ask, folder


@pytest.mark.parametrize("path, question, function", [
    ("life", {}, "unit_life"),
    ("life", {"survived": "400 h", "horizon": "100 h", "risk": "1 %", "level": "95 %", "sides": "lower"}, "unit_life"),
    ("decide", {"failure_cost": "800 EUR", "replacement_cost": "120 EUR", "claims": "2 %", "inspection_cost": "10 EUR"}, "decide"),
])
def test_the_line_of_a_question_prints_the_answer(served, tmp_path, path, question, function):
    ask, _ = served
    ask("/api/open", {"file": "pumps-results"})
    found = ask(f"/api/{path}", {"result": "pumps-results", **question})
    assert f"ww.{function}(" in found["python"]
    assert run(found["python"], tmp_path) == found["text"].strip()
    # The same numbers as those from which the page draws.
    summary = found["python"].replace("print(", "import json; print(json.dumps(").removesuffix(")") + ".summary))"
    assert json.loads(run(summary, tmp_path)) == found["answer"]


def test_the_line_of_a_comparison_prints_the_comparison(served, tmp_path):
    ask, _ = served
    found = ask("/api/compare", {"results": ["pumps-results", "other-results"]})
    assert run(found["python"], tmp_path) == found["text"].strip()


def test_the_line_of_a_fit_writes_the_same_result(served, tmp_path):
    ask, folder = served
    ask("/api/open", {"file": "pumps-results"})
    line = ask("/api/result")["python"]
    assert run(line.replace("pumps-results", "again"), tmp_path) == ""
    for name in ("summary.json", "state.bin", "study.toml"):
        assert (folder / "again" / name).read_bytes() == (folder / "pumps-results" / name).read_bytes(), name
    # Of a result whose study has been changed since there is no such line.
    study = (folder / "pumps.toml").read_text()
    try:
        (folder / "pumps.toml").write_text(study + "# changed\n")
        assert "python" not in ask("/api/result") and "command" not in ask("/api/result")
    finally:
        (folder / "pumps.toml").write_text(study)
