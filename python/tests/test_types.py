"""The stubs are those of the module: mypy's stubtest; and a program that uses them is checked."""

import os
import subprocess
import sys

import pytest

import wearwell

pytest.importorskip("mypy")
config = os.path.join(os.path.dirname(__file__), "mypy.ini")
package = os.path.dirname(os.path.dirname(wearwell.__file__))


def mypy(module, *arguments, folder):
    return subprocess.run([sys.executable, "-m", module, *arguments], cwd=folder, capture_output=True, text=True,
                          env={**os.environ, "MYPYPATH": package, "MYPY_CACHE_DIR": str(folder / "cache")})


def test_stubs_are_the_modules(tmp_path):
    # What is not public, and what mypy 1.0 cannot compare: functools.cached_property beside @property.
    (tmp_path / "allowed").write_text(
        "wearwell\\._.*\n"
        "wearwell\\.Fit\\.(draws|lives|parameters|predictions|quantities|sample_stats|summary|tables)\n"
        "wearwell\\.Plan\\.tables\n"
        # Modules that can be called: their stubs are classes with the signature.
        "wearwell\\.(bearing|clutch)\n")
    done = mypy("mypy.stubtest", "wearwell", "--mypy-config-file", config, "--allowlist", "allowed",
                "--ignore-unused-allowlist", folder=tmp_path)
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


def test_everything_public_is_documented():
    for name in wearwell.__all__:
        each = getattr(wearwell, name)
        assert each.__doc__, name
        for member, value in vars(each).items() if isinstance(each, type) else ():
            if not member.startswith("_") and callable(value):
                assert value.__doc__, f"{name}.{member}"
