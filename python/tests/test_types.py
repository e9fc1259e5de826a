"""The stubs are those of the module: mypy's stubtest; and a program that uses them is checked."""

import ast
import functools
import glob
import importlib.util
import inspect
import json
import os
import re
import shutil
import subprocess
import sys

import pytest

import wearwell
from conftest import source

pytest.importorskip("mypy")
config = os.path.join(os.path.dirname(__file__), "mypy.ini")
package = os.path.dirname(os.path.dirname(wearwell.__file__))


def mypy(module, *arguments, folder, path=package):
    return subprocess.run([sys.executable, "-m", module, *arguments], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "MYPYPATH": str(path), "MYPY_CACHE_DIR": str(folder.parent / "mypy")})


def test_stubs_are_the_modules(tmp_path):
    # Stubs alone, so that mypy does not read the implementation. What is not public, and what mypy 1.0 cannot compare:
    # functools.cached_property beside @property.
    (tmp_path / "stubs" / "wearwell").mkdir(parents=True)
    for stub in glob.glob(os.path.join(package, "wearwell", "*.pyi")):
        shutil.copy(stub, tmp_path / "stubs" / "wearwell")
    (tmp_path / "allowed").write_text(
        "wearwell\\._.*\n"
        + "".join(f"wearwell\\.{name}\\.{member}\n" for name in wearwell.__all__ for member, value in inspect.getmembers(getattr(wearwell, name))
                  if isinstance(value, functools.cached_property)) +
        # Modules that can be called: their stubs are classes with the signature.
        "wearwell\\.(bearing|clutch)\n")
    done = mypy("mypy.stubtest", "wearwell", "--mypy-config-file", config, "--allowlist", "allowed",
                "--ignore-unused-allowlist", folder=tmp_path, path=tmp_path / "stubs")
    assert done.returncode == 0, done.stdout + done.stderr


def test_use_is_checked(tmp_path):
    (tmp_path / "use.py").write_text(
        "import wearwell as ww\n"
        "fit = ww.fit('study.toml', seed=1)\n"
        "reveal_type(fit.trusted)\n"
        "fit.life(limit='100 mm^3', b=[1, 10], unit='J7')\n"
        "fit.trustet\n"
        "ww.half_normal()\n"
        "reveal_type(ww.plan.next(fit, 'k', grid='F = 200').trusted)\n"
        "ww.plan.size(fit, 'k', width='factor 2')\n"
        "reveal_type(ww.life({}, 'hours', event='failed', stress={'T': 'arrhenius'}).percentile(10))\n"
        "ww.bearing({}, 'd', contact='journal', radius='10 mm', clearance='20 um').plot('life')\n"
        "ww.fit('study.toml', chain=4)\n")
    said = mypy("mypy", "--config-file", config, "use.py", folder=tmp_path).stdout
    assert 'Revealed type is "builtins.bool"' in said
    assert 'use.py:5: error: "Fit" has no attribute "trustet"' in said
    assert "use.py:6: error" in said and "use.py:4: error" not in said
    assert 'use.py:11: error: Unexpected keyword argument "chain" for "fit"' in said
    assert 'use.py:9: note: Revealed type is "Any"' in said or 'DataFrame"' in said
    assert "use.py:10: error" not in said
    assert "use.py:8: error" in said and "use.py:7: error" not in said


def blocks_of(path):
    """The blocks of Python of a page, or the cells of a notebook."""
    with open(path) as file:
        text = file.read()
    if not path.endswith(".ipynb"):
        return re.findall(r"```python\n(.*?)```", text, re.S)
    return ["".join(cell["source"]) for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]


def imports_what_is_missing(block):
    names = [name.name for node in ast.walk(ast.parse(block)) if isinstance(node, ast.Import) for name in node.names]
    names += [node.module for node in ast.walk(ast.parse(block)) if isinstance(node, ast.ImportFrom) and node.module]
    return any(importlib.util.find_spec(name.split(".")[0]) is None for name in names)


def test_examples_are_typed(tmp_path):
    """Pages and notebooks as a user's editor checks them; blocks with packages that are not installed are left out."""
    pages = [os.path.join(source, *page.split("/")) for page in ("docs/how-to/coming-from-lifelines.md", "docs/how-to/coming-from-reliability.md",
                                                                 "docs/how-to/failure-modes.md", "docs/reference/python.md", "README.md")]
    names = []
    for path in pages + sorted(glob.glob(os.path.join(source, "examples", "notebooks", "*.ipynb"))):
        blocks = [block for block in blocks_of(path) if not imports_what_is_missing(block)]
        assert blocks, path
        names.append(re.sub(r"\W", "_", os.path.basename(path)) + ".py")
        (tmp_path / names[-1]).write_text("\n".join(blocks))
    # One that is wrong shows that the others were read.
    (tmp_path / "wrong.py").write_text("import wearwell as ww\nww.life({}, 'hours', **{'method': 'exact'})\n")
    done = mypy("mypy", "--strict", "--config-file", config, *names, "wrong.py", folder=tmp_path)
    faults = [line for line in done.stdout.splitlines() if " error: " in line]
    assert faults and all(line.startswith("wrong.py:2: ") for line in faults), done.stdout + done.stderr


def test_everything_public_is_documented():
    for name in wearwell.__all__:
        each = getattr(wearwell, name)
        assert each.__doc__, name
        for member, value in vars(each).items() if isinstance(each, type) else ():
            if not member.startswith("_") and callable(value):
                assert value.__doc__, f"{name}.{member}"
