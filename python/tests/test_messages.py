"""Messages, advice and reports name arguments and functions of Python, not options and commands."""

import pickle
import re
import subprocess
import sys

import pytest

import wearwell as ww
from conftest import source
from wearwell._impl.messages import in_arguments, in_python


@pytest.mark.parametrize("text, python", [
    ("Draw more (--draws, --warmup), or use --method exact.", 'Draw more (draws, warmup), or use method="exact".'),
    ("raise [sampler]\n    target_accept, or use --method\n    exact.", '''raise [sampler]\n    target_accept, or use\n    method="exact".'''),
    ("--scar-width: '--depth' must be positive", "scar_width: '--depth' must be positive"),
    ("add --repeated once or --repeated another", 'add repeated="once" or repeated="another"'),
    ("fitted with --no-report; fit it again", "fitted with report=False; fit it again"),
    ("fit them first: wearwell update springs TESTS -o NEW", "fit them first: wearwell.update(fit, tests)"),
    ("see wearwell plan inspect and wearwell decide --inspect-after", "see wearwell.plan.inspect and wearwell.decide(inspect_after=...)"),
    ("is not possible with `wearwell plan next`: more", "is not possible with wearwell.plan.next: more"),
    ("are for the command line (wearwell plan inspect, wearwell decide)", "are for the command line (wearwell plan inspect, wearwell decide)"),
    ("  with --rows here, or in tables/coverage.csv", "  in tables/coverage.csv"),
    ("44 more rows: -o writes all to tables/inspections.csv", '44 more rows: tables["inspections"] has all'),
    ("columns '--draws', a--draws and --draws=3 stay", "columns '--draws', a--draws and --draws=3 stay")])
def test_options_become_arguments(text, python):
    assert in_arguments(text) == python
    assert in_arguments(python) == python


@pytest.mark.parametrize("said, arguments, python", [
    ("predict.risk: needs predict.limit and predict.pressure: why", {"predict.limit": "limit", "predict.risk": "risk"},
     "risk: needs limit and predict={'pressure': ...}: why"),
    ("predict.at: needs predict.given.force: it varies", {}, "predict.at: needs predict={'given': {'force': ...}}: it varies"),
    ("predict.at: needs predict.given.force: it varies", {"predict.given": "given"}, "predict.at: needs given={'force': ...}: it varies"),
    ("life.points.launch.torque: unit", {"life.points": "points"}, "points.launch.torque: unit")])
def test_keys_become_arguments(said, arguments, python):
    assert in_python(said, arguments) == python


@pytest.mark.parametrize("call, begins", [
    (lambda: ww.bearing.life("", radius="1 mm"), "contact is missing"),
    (lambda: ww.bearing.depth("stationary", radius="-1 mm", clearance="30 um", rate="1e-15 m^3/(N m)", pressure="1 MPa", revolutions=9), "radius: '-1 mm'"),
    (lambda: ww.bearing.depth("stationary", radius="1 mm", clearance="3 um", rate="1e-15 m^3/(N m)", pressure="1 MPa", revolutions=9, limit="3 kg"),
     "limit: unit 'kg'"),
    (lambda: ww.select("examples/formula/wear.csv", "h_um"), "inputs (with degree) or terms is missing"),
    (lambda: ww.select("examples/formula/wear.csv", "h_um", terms=["F", "s"], degree=2), "degree applies to inputs"),
    (lambda: ww.fit("examples/clutch/study.toml", method="nuts"), "method, chains, draws, warmup and seed are for studies that sample")])
def test_refusals_name_arguments(call, begins, monkeypatch):
    monkeypatch.chdir(source)
    with pytest.raises(ww.InputError) as refused:
        call()
    assert str(refused.value).startswith(begins)
    assert str(pickle.loads(pickle.dumps(refused.value))) == str(refused.value)


def test_advice_names_arguments(examples):
    with pytest.warns(ww.CheckWarning) as warned:
        fit = ww.fit(f"{examples}/joint/study.toml", seed=1, method="nuts", draws=10, warmup=10, chains=2, report=False)
    advice = {check.name: check.advice for check in fit.checks}
    assert advice["convergence"] == 'Draw more (draws, warmup), or use method="exact".'
    assert any('method="exact"' in str(each.message) for each in warned)
    assert not re.search(r"--[a-z]", str(fit) + " ".join(advice.values()) + " ".join(str(each.message) for each in warned))
    assert '-> Draw more (draws, warmup), or use method="exact".' in str(fit)


def test_memory_that_lacks_is_a_machine_error():
    """A process that may take 16 MB more, and a table of 32 MB."""
    code = "import resource, numpy, wearwell as ww; a = numpy.ones(4_000_000); size = int(open('/proc/self/statm').read().split()[0]) * 4096; " \
           "resource.setrlimit(resource.RLIMIT_AS, (size + 2**24, -1))\ntry: ww.table({'a': a})\nexcept ww.MachineError as error: print(error)"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout == "out of memory\n"
