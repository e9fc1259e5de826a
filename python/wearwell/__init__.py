"""Wear and fatigue-life parameters from few noisy measurements, with honest uncertainty.

``fit`` fits a study file, ``Study`` makes a study of a formula, data and priors; both lead to a ``Fit`` with its checks. ``compare``
ranks fits, ``select`` finds the terms of a regression, ``rainflow`` counts cycles; ``bearing`` and ``clutch`` have the formulas of
these parts. Numbers are those of the program ``wearwell``, to the bit.

Examples
--------
>>> import wearwell as ww
>>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
>>> fit.trusted
True
>>> print(f"{fit.parameters.loc['k', 'mean']:.2e} {fit.parameters.loc['k', 'unit']}")
7.76e-04 mm^3/(N m)
"""

from . import _errors
from ._errors import CheckWarning, InputError, MachineError, MissingFileError, NotTrusted
from . import _core
from . import bearing, clutch, plan
from ._arrow import ArrowTable, arrow
from ._check import Check
from ._data import table
from ._fit import Fit
from ._bearing_study import bearing as _fit_bearings
from ._callable_module import make_callable as _make_callable
from ._clutch_study import clutch as _fit_clutch
from ._degradation_study import degradation
from ._fatigue_study import sn, staircase
from ._joint_study import joint
from ._life_study import life
from ._plan import Plan
from ._plots import Plot
from ._positive_priors import exponential, gamma, half_cauchy, half_normal, inverse_gamma, jeffreys
from ._priors import beta, default, flat, lognormal, normal, prior, student_t, uniform
from ._study import Study, fit
from ._tools import Comparison, Selection, compare, rainflow, select

__version__ = _core.version

_make_callable(bearing.__name__, _fit_bearings)
_make_callable(clutch.__name__, _fit_clutch)

__all__ = [
    "ArrowTable", "Check", "CheckWarning", "Comparison", "Fit", "InputError", "MachineError", "NotTrusted", "Plan", "Selection", "Study",
    "arrow", "bearing", "beta", "clutch", "compare", "default", "exponential", "fit", "flat", "gamma", "half_cauchy", "half_normal",
    "inverse_gamma", "jeffreys", "lognormal", "normal", "plan", "prior", "rainflow", "select", "student_t", "table", "uniform",
]
