import os
import re
import shutil
import subprocess

import pytest

source = os.environ.get("WEARWELL_SOURCE") or os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
binary = os.environ.get("WEARWELL_BINARY") or os.path.join(source, "build", "release", "bin", "wearwell")


def clutch_study(folder, repetitions=0):
    """A copy of examples/clutch with nine pairs of exponents to try and few repetitions: the search of the example takes long."""
    shutil.copytree(os.path.join(source, "examples", "clutch"), folder)
    few = {"lowest": 0.4, "highest": 1.2, "step": 0.4, "replicates": repetitions}
    text, changed = re.subn(r"(?m)^(lowest|highest|step|replicates) = [0-9.]+", lambda line: f"{line[1]} = {few[line[1]]}",
                            (folder / "study.toml").read_text())
    assert changed == len(few)
    (folder / "study.toml").write_text(text)
    return folder / "study.toml"


@pytest.fixture
def examples():
    return os.path.join(source, "examples")


@pytest.fixture
def wearwell():
    """Runs the program; gives exit code, standard output and standard error."""

    def run(*arguments):
        done = subprocess.run([binary, *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    return run
