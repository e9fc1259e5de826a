"""README.md and pages of docs with Python: every block of Python, in its order, in one namespace, where the examples are."""

import os
import re
import warnings

import wearwell as ww
from conftest import source


def run_blocks(tmp_path, monkeypatch, *page):
    with open(os.path.join(source, *page)) as file:
        text = file.read()
    blocks = [(text[:m.start()].count("\n") + 2, m[1]) for m in re.finditer(r"```python\n(.*?)```", text, re.S)]
    os.symlink(os.path.join(source, "examples"), tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    space = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        for line, block in blocks:
            exec(compile("\n" * (line - 1) + block, "/".join(page), "exec"), space)
    return blocks, space


def test_every_block_runs(tmp_path, monkeypatch):
    blocks, space = run_blocks(tmp_path, monkeypatch, "docs", "reference", "python.md")
    assert len(blocks) >= 8
    assert sorted(os.listdir("joint-results"))[:2] == ["draws_1.csv", "draws_2.csv"]
    assert space["joint"].trusted and space["left"].loc[0, "of"] == "joint J5"


def test_page_for_users_of_lifelines(tmp_path, monkeypatch):
    """Its numbers are asserted in its blocks: those of peers/peers.csv."""
    blocks, space = run_blocks(tmp_path, monkeypatch, "docs", "how-to", "coming-from-lifelines.md")
    assert len(blocks) == 11 and list(space["groups"].summary.index) == ["characteristic[A]", "characteristic[B]", "slope"]


def test_page_of_failure_modes(tmp_path, monkeypatch):
    blocks, space = run_blocks(tmp_path, monkeypatch, "docs", "how-to", "failure-modes.md")
    assert len(blocks) == 1 and len(space["fit"].lives) == 3


def test_page_for_users_of_reliability(tmp_path, monkeypatch):
    """Its numbers are asserted in its blocks, as above."""
    blocks, space = run_blocks(tmp_path, monkeypatch, "docs", "how-to", "coming-from-reliability.md")
    assert len(blocks) == 9 and list(space["modes"].lives["at"]) == ["", "without wear", "without seal"]


def test_block_of_the_readme_runs(tmp_path, monkeypatch):
    blocks, space = run_blocks(tmp_path, monkeypatch, "README.md")
    assert len(blocks) == 1
    assert space["fit"].trusted


def test_readme_of_the_wheel():
    with open(os.path.join(source, "python", "README.md")) as file:
        assert "ww.fit" in file.read()
