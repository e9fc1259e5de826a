"""The wheel: what it says of itself, what it holds, and that it works where nothing of the build is."""

import glob
import os
import re
import subprocess
import sys
import sysconfig
import zipfile

import pytest

import wearwell as ww
from conftest import source

build = os.environ.get("WEARWELL_BUILD") or os.path.dirname(os.path.dirname(os.path.dirname(ww.__file__)))


def test_wheel_holds_what_it_needs(tmp_path):
    pytest.importorskip("xarray")
    python = os.path.join(source, "python")
    done = subprocess.run([sys.executable, "-m", "pip", "wheel", python, "--no-build-isolation", "--no-deps", "-q", "-w", tmp_path],
                          env={**os.environ, "WEARWELL_BUILD": build}, capture_output=True, text=True)
    for rest in ("build", "wearwell.egg-info"):  # what setuptools leaves beside its sources
        subprocess.run(["rm", "-rf", os.path.join(python, rest)])
    assert done.returncode == 0, done.stderr
    wheel, = glob.glob(str(tmp_path / "*.whl"))
    tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    assert os.path.basename(wheel) == f"wearwell-{ww.__version__}-{tag}-{tag}-{platform}.whl"
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        about = archive.read(f"wearwell-{ww.__version__}.dist-info/METADATA").decode()
        kind = archive.read(f"wearwell-{ww.__version__}.dist-info/WHEEL").decode()
    for name in ("__init__.py", "__init__.pyi", "py.typed", "_impl/libduckdb.so", "_impl/life_study.py"):
        assert f"wearwell/{name}" in names
    assert "Requires-Python: >=3.9" in about and "Requires-Dist: numpy" in about and "License: Apache-2.0" in about
    assert "Root-Is-Purelib: false" in kind
    here = tmp_path / "installed"
    done = subprocess.run([sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "-q", "--target", here, wheel],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    module, = glob.glob(str(here / "wearwell" / "_impl" / "_core*.so"))
    linked = subprocess.run(["ldd", module], capture_output=True, text=True).stdout
    assert str(here / "wearwell" / "_impl" / "libduckdb.so") in linked and "not found" not in linked and "netcdf" not in linked
    # The way that docs/reference/python.md shows, with what was installed.
    with open(os.path.join(source, "docs", "reference", "python.md")) as file:
        way = re.search(r"## From nothing to NetCDF.*?```python\n(.*?)```", file.read(), re.S)[1]
    os.symlink(os.path.join(source, "examples"), tmp_path / "examples")
    run = subprocess.run([sys.executable, "-c", way + "print(ww.__file__, posterior['k'].dims, posterior['k'].attrs['units'])"],
                         cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(here)}, capture_output=True, text=True)
    assert run.stdout == f"{here}/wearwell/__init__.py ('chain', 'draw') mm^3/(N m)\n", run.stderr
