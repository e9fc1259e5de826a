import os
import subprocess

import pytest

source = os.environ.get("WEARWELL_SOURCE") or os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
binary = os.environ.get("WEARWELL_BINARY") or os.path.join(source, "build", "release", "bin", "wearwell")


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
