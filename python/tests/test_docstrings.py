"""Docstrings are in the form of numpydoc: each argument, what is returned and raised, and examples that run."""

import inspect
import pydoc
import re
import subprocess
import sys

import pytest

import wearwell as ww
from public_names import docstrings, public_names, sections

names = public_names()
texts = docstrings()
of_damage = {f"{name}.{each}" for name in ("Damage", "DesignCurves", "LivesAgainst", "LoadSpectrum") for each in ("report", "write", "tables")}
return_nothing = {each for each in of_damage if not each.endswith("tables")} | {"Comparison.report", "Fit.report", "Fit.to_netcdf", "Fit.write", "Plan.report", "Plan.write", "Selection.report"}
raise_nothing = {each for each in of_damage if each.endswith("tables")} | {"Damage", "Damage.damage", "Damage.life", "Damage.lives", "Damage.sources", "DesignCurves",
                 "DesignCurves.curves", "DesignCurves.models", "LoadSpectrum", "LivesAgainst", "LivesAgainst.differences", "LivesAgainst.outlives", "UnitTracker.passed", "Backtest", "Backtest.coverage", "Backtest.forecasts", "Quantiles", "UnitTracker", "UnitTracker.doubt", "UnitTracker.level",
                 "UnitTracker.outcomes", "UnitTracker.path", "UnitTracker.rate_change", "UnitTracker.rul", "UnitTracker.summary", "Plot", "Plot.to_dict", "Plot.to_html", "ArrowTable", "ArrowTable.columns", "Check", "Comparison", "Comparison.lives", "Fit", "Fit.quantities", "Fit.tables", "Plan", "Plan.tables",
                 "Selection", "Selection.models", "Study.description", "clutch.CycleSum.plates", "clutch.CycleSum.summary", "default"}


def is_exception(each):
    return isinstance(each, type) and issubclass(each, Exception)


def arguments(each):
    if not callable(each) or is_exception(each):
        return set()
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    found = inspect.signature(each).parameters.values()
    return {stars.get(p.kind, "") + p.name for p in found if p.name not in ("self", "cls")}


def described(lines):
    return {name for line in lines if line and not line.startswith(" ") for name in line.split(" : ")[0].split(", ")}


def test_names_of_all_kinds_are_found():
    assert {"fit", "Fit.life", "Fit.parameters", "Study.from_file", "bearing.rate", "clutch.CycleSum.add", "InputError"} <= set(names)
    assert len(names) > 60


@pytest.mark.parametrize("name", names)
def test_sections(name):
    each, found = names[name], sections(texts[name])
    first = texts[name].split("\n")
    assert first[0].endswith((".", ":")) and (len(first) == 1 or not first[1]), "a summary of one line comes first"
    own = [*found.get("Parameters", []), *(found.get("Attributes", []) if isinstance(each, type) else [])]
    assert arguments(each) - described(own) == set(), "arguments without a description"
    if "Parameters" in found:
        assert described(found["Parameters"]) <= arguments(each), "descriptions of no argument"
    if not isinstance(each, type) and name not in return_nothing:
        assert "Returns" in found
    assert ("Raises" in found) == (name not in raise_nothing and not is_exception(each))
    assert any(line.startswith(">>> ") for line in found["Examples"])


def test_attributes_are_described():
    fit = described(sections(texts["Fit"])["Attributes"])
    assert fit == {"study", "seed", "trusted", "checks", "results"}
    assert described(sections(texts["Check"])["Attributes"]) == set(ww.Check._fields)


@pytest.mark.parametrize("name", texts)
def test_docstrings_stand_alone(name):
    """They say what is so, and point to no file of the project's documents."""
    assert not re.search(r"docs/|\.md\b", texts[name])


def test_without_docstrings_the_module_is_there():
    done = subprocess.run([sys.executable, "-OO", "-c", "import wearwell; print(wearwell.life.__doc__)"], capture_output=True, text=True)
    assert done.stdout.strip() == "None", done.stderr


def test_help_of_the_package_has_what_people_call_and_catch():
    """Classes that functions return have help of their own, and do not stand before the functions."""
    text = pydoc.render_doc(ww, renderer=pydoc.plaintext)
    classes = re.findall(r"(?m)^    class (\w+)\(", text)
    assert classes == [name for name in sorted(ww.__all__) if name in {"Fit", "Study", "Monitor"} or is_exception(getattr(ww, name))]
    assert len(text.split("\n")) < 4500
    assert re.search(r"PACKAGE CONTENTS\n((?: +\w+\n)+)", text)[1].split() == ["bearing", "clutch", "plan"]
    assert "_impl" not in text
    functions = {name for name in ww.__all__ if inspect.isfunction(getattr(ww, name))}
    assert functions == {name for name in functions if re.search(rf"(?m)^    {name}\(", text)}
    assert functions < set(dir(ww)) <= {*ww.__all__, *vars(ww)}
