"""Wear and fatigue-life parameters from few noisy measurements, with honest uncertainty.

A table goes in, a fit comes out, and ``help`` of each name has its arguments and examples: ``help(wearwell.life)``.

One line for a table, with default priors that ``fit.study.toml`` states:

======================  ======================================================================================
``life``                lives, censored or not: a distribution, by group, under stress, failure modes
``degradation``         paths of wear or of another loss to a failure threshold, unit by unit
``sn``, ``staircase``   S-N curves with run-outs; fatigue limits of up-and-down tests
``joint``, ``bearing``  wear coefficients of joints and of journal bearings from inspections
``clutch``              the wear model of a dry clutch from a campaign
``repairable``          failures of units that are repaired: power law, renewal, phases of a growth test
``returns``             warranty returns: a returns triangle, or units with their dates
``Study``, ``fit``      your own formula, data and priors; a study file of the program
======================  ======================================================================================

What a ``Fit`` answers:

=====================================================  =======================================================
``trusted``, ``checks``, ``require_trusted``           whether its numbers can be used, and why not
``parameters``, ``summary``, ``lives``                 estimates with 90 % intervals; B-lives with lower bounds
``life``, ``percentile``, ``conditional``              lives at any level, of one unit, of survivors
``survival_function``, ``hazard``, ``predict``         curves and predictions under conditions
``plot``, ``report``, ``write``, ``to_datatree``       pictures, a page, the folder of the program, ArviZ
``compare``, ``against``, ``update``, ``track``        other models, another fit's life, new rows, one unit
=====================================================  =======================================================

Further work:

=====================================================  =======================================================
``compare``, ``backtest``                              rank models by prediction; check forecasts of lives
``unit_life``                                          the life of a new unit, the rest of a unit's life
``decide``, ``plan``                                   when to replace or inspect; which tests to run
``rainflow``, ``spectrum``, ``damage``, ``design``     load cycles, damage along an S-N curve, design curves
``select``                                             the terms of a regression
``export_c``, ``export_sql``, ``Monitor``              one unit in C, a formula in SQL, a running monitor
``lognormal``, ``normal``, ``flat``, ...               priors
=====================================================  =======================================================

``bearing`` and ``clutch`` also hold the formulas of these parts. Numbers are those of the program ``wearwell``, to the bit.

Examples
--------
>>> import wearwell as ww
>>> pumps = {"hours": [312, 480, 510, 640, 700, 700], "failed": [True, True, True, True, False, False]}
>>> fit = ww.life(pumps, "hours", event="failed", units={"hours": "h"}, seed=1)
>>> print(f"{fit.lives.loc[0, 'b10']:.0f} {fit.lives.loc[0, 'unit']}")
219 h
>>> fit.plot("probability")
<wearwell.Plot 'probability': probability-paper>
"""

from ._impl.errors import CheckWarning, InputError, MachineError, MissingFileError, NotTrusted
from ._impl._core import version as __version__
from . import bearing, clutch, plan
from ._impl.against import LivesAgainst
from ._impl.arrow import ArrowTable, arrow
from ._impl.backtest import Backtest, backtest
from ._impl.bearing_study import bearing as _fit_bearings
from ._impl.callable_module import make_callable as _make_callable
from ._impl.check import Check
from ._impl.clutch_study import clutch as _fit_clutch
from ._impl.compare import Comparison, compare
from ._impl.data import table
from ._impl.decide import decide
from ._impl.degradation_study import degradation
from ._impl.export import export_c, export_sql
from ._impl.fatigue_study import sn, staircase
from ._impl.fit import Fit
from ._impl.joint_study import joint
from ._impl.life_study import life
from ._impl.monitor import Monitor
from ._impl.plan import Plan
from ._impl.plots import Plot
from ._impl.positive_priors import exponential, gamma, half_cauchy, half_normal, inverse_gamma, jeffreys
from ._impl.priors import beta, default, flat, lognormal, normal, prior, student_t, uniform
from ._impl.repairable_study import repairable
from ._impl.returns_study import returns
from ._impl.spectra import Damage, DesignCurves, LoadSpectrum, damage, design, spectrum
from ._impl.study import Study, fit
from ._impl.tools import Selection, rainflow, select
from ._impl.track import Quantiles, UnitTracker, track
from ._impl.unit_life import unit_life
from ._impl.update import update

_make_callable(bearing.__name__, _fit_bearings)
_make_callable(clutch.__name__, _fit_clutch)

__all__ = [
    # One line for a table.
    "life", "degradation", "sn", "staircase", "joint", "bearing", "clutch", "repairable", "returns",
    "Study", "fit", "Fit", "Check", "Plot",
    # Of fits.
    "compare", "Comparison", "update", "track", "UnitTracker", "Quantiles", "backtest", "Backtest", "LivesAgainst", "unit_life", "decide", "plan", "Plan",
    "export_c", "export_sql", "Monitor",
    # Tools.
    "rainflow", "spectrum", "LoadSpectrum", "damage", "Damage", "design", "DesignCurves", "select", "Selection",
    "table", "arrow", "ArrowTable",
    # Priors.
    "lognormal", "normal", "half_normal", "uniform", "flat", "half_cauchy", "exponential", "gamma", "inverse_gamma", "student_t", "beta",
    "jeffreys", "prior", "default",
    # Errors and warnings.
    "InputError", "MissingFileError", "MachineError", "NotTrusted", "CheckWarning",
]

# What functions and fits return; help(fit.plot("life")) documents one. dir(), completion and help(wearwell) show what people call or catch.
_answers = {"Check", "Plot", "Comparison", "UnitTracker", "Quantiles", "Backtest", "LivesAgainst", "Plan", "LoadSpectrum", "Damage", "DesignCurves",
            "Selection", "ArrowTable"}

# Names are those that people import, in help, in messages of Python and in pickles.
for _name in __all__:
    for _each in getattr(globals()[_name], "__mro__", (globals()[_name],)):
        if hasattr(_each, "__qualname__") and _each.__module__.startswith("wearwell._impl."):
            _each.__module__ = __name__


def __dir__():
    return sorted({*__all__, *(name for name in globals() if name.startswith("__") and name.endswith("__"))} - _answers)
