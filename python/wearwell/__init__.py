"""wearwell: wear and fatigue-life parameters from few noisy measurements, with honest uncertainty.

    import wearwell as ww
    fit = ww.fit("study.toml", seed=1)
    fit.trusted, fit.parameters, fit.report("report.html")

docs/python.md has the rest.
"""

from . import _errors
from ._errors import CheckWarning, InputError, MachineError, NotTrusted
from . import _core
from . import bearing, clutch
from ._arrow import ArrowTable, arrow
from ._fit import Check, Fit
from ._priors import (
    beta,
    default,
    exponential,
    flat,
    gamma,
    half_cauchy,
    half_normal,
    inverse_gamma,
    jeffreys,
    lognormal,
    normal,
    prior,
    student_t,
    uniform,
)
from ._study import Study, fit, table
from ._tools import Comparison, Selection, compare, rainflow, select

__version__ = _core.version

__all__ = [
    "ArrowTable", "Check", "CheckWarning", "Comparison", "Fit", "InputError", "MachineError", "NotTrusted", "Selection", "Study",
    "arrow", "bearing", "beta", "clutch", "compare", "default", "exponential", "fit", "flat", "gamma", "half_cauchy", "half_normal",
    "inverse_gamma", "jeffreys", "lognormal", "normal", "prior", "rainflow", "select", "student_t", "table", "uniform",
]
