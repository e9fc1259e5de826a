"""Ctrl-C ends every long question, and what follows works as before."""

import os
import re
import signal
import threading
import time
import warnings

import numpy as np
import pandas as pd
import pytest

import wearwell as ww

costs = {"failure_cost": "12000 EUR", "replacement_cost": "900 EUR", "inspection_cost": "50 EUR"}


def liners(folder):
    """The example with a known scatter between machines, and no lives of machines: two parameters are fitted soon."""
    with open(os.path.join(folder, "study.toml"), encoding="utf-8") as file:
        text = file.read()
    for before, after in ((r"(?m)^at +=.*", "lives_of = []"), (r"(?m)^k_scatter .*", ""), ('"k_scatter"', "0.35"), ("k_scatter", "0.35")):
        text = re.sub(before, after, text)
    return ww.Study.from_toml(text, folder=folder).fit(seed=1, draws=100, method="exact", report=False)


@pytest.fixture(scope="module")
def subjects():
    """Fits whose questions take long, each made once."""
    examples = os.path.join(os.environ.get("WEARWELL_SOURCE", "."), "examples")
    lives = np.random.default_rng(1).weibull(2, 500_000) * 1000
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ww.CheckWarning)
        springs = ww.fit(os.path.join(examples, "spring", "sensible.toml"), seed=1, draws=100, method="exact", report=False)
    made = {"liners": liners(os.path.join(examples, "formula")), "springs": springs, "lives": pd.DataFrame({"life [h]": lives}),
            "hours": pd.DataFrame({"hours": lives}),
            "many": ww.life({"hours": lives[:200_000]}, "hours", units={"hours": "h"}, seed=1, draws=100, method="exact", report=False)}
    made.update(wide=linear(400, 40), terms=linear(400, 9), repairs=repairs(20_000))
    return made


def springs_to_test(n):
    return pd.DataFrame({"alternating_stress_MPa": np.linspace(240, 300, n), "mean_stress_MPa": 1000.0, "specimens": 3})


def linear(rows, columns):
    """A response that six of the columns make, with noise."""
    random = np.random.default_rng(3)
    x = random.normal(size=(rows, columns))
    frame = pd.DataFrame(x, columns=[f"x{k}" for k in range(columns)])
    return frame.assign(y=x[:, :6].sum(axis=1) + random.normal(size=rows))


def repairs(units):
    """Ten failures of each unit, and the end of its observation."""
    ages = np.tile(np.arange(1, 12) * 100.0, units) + np.random.default_rng(4).uniform(0, 50, 11 * units)
    return pd.DataFrame({"unit": np.repeat(np.arange(units).astype(str), 11), "age": ages, "event": (["failure"] * 10 + ["end"]) * units})


def readings(n):
    return pd.DataFrame({"s": np.linspace(1, 100, n), "F": 20.0, "machine": ""})


# Each takes 1.6 s of the processor or more, so that the bound below shows whether it was ended.
calls = {
    "decide, a table": lambda s: ww.decide(s["lives"], **costs),
    "plan next, independent tests": lambda s: ww.plan.next(s["springs"], goal="B10 at softer spring", candidates=springs_to_test(400)),
    "plan next, units that differ": lambda s: ww.plan.next(s["liners"], goal="k", candidates=readings(100)),
    "ask": lambda s: s["liners"].ask({"along": "distance", "at": [f"{k} km" for k in range(1, 400)], "given": {"force": "20 N"}}),
    "update": lambda s: s["liners"].update(pd.DataFrame({"h_um": [50.0], "F": [20.0], "s": [30.0], "machine": ["1"]})),
    "select": lambda s: ww.select(s["wide"], "y", inputs=[f"x{k}" for k in range(40)], degree=1),
    "select, nested": lambda s: ww.select(s["terms"], "y", inputs=[f"x{k}" for k in range(9)], degree=2, nested=10),
    "repairable": lambda s: ww.repairable(s["repairs"], "age", unit="unit", event="event", units={"age": "h"}),
    "compare families": lambda s: s["many"].compare(families="all"),
    "residuals": lambda s: s["many"].residuals(),
    "life of a large table": lambda s: ww.life(s["hours"], "hours", units={"hours": "h"}, seed=1, report=False),
}


@pytest.mark.parametrize("name", calls)
def test_ctrl_c_ends_a_question(subjects, name):
    """The processor's time is counted: other work on the machine does not matter. It is 0.2 s at most where nothing else runs."""
    sent = []

    def interrupt():
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.1, interrupt)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            calls[name](subjects)
            timer.cancel()
    finally:
        timer.join()
    assert time.process_time() - sent[0] < 0.6


def test_the_next_question_is_answered(subjects):
    """A request to stop one question reaches no other."""
    for name in ("decide, a table", "plan next, independent tests"):
        test_ctrl_c_ends_a_question(subjects, name)
        lives = {"life [h]": [1200, 1500, 1900, 2300, 2600, 3100, 3600]}
        assert ww.decide(lives, **costs).summary["unit"] == "h"
