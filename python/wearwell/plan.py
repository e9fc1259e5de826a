"""Plans of tests and inspections to come: which test next, how many specimens, for how long, when to inspect.

Each function answers what ``wearwell plan`` answers, with the same numbers to the bit, and returns a ``wearwell.Plan``. Quantities are
texts with their units ("1e6 cycles"), pint quantities, or numbers where there is no unit; shares and risks are numbers between 0 and
1, or texts ("90 %").
"""

import os

from ._impl.errors import InputError
from ._impl.fit import Fit
from ._impl.plan import answer
from ._impl.question import files_and_tables
from ._impl.plan_lives import accelerate, demonstrate
from ._impl.study import Study

for _each in (accelerate, demonstrate):
    _each.__module__ = __name__


def _require(about, name, kinds, what):
    if not isinstance(about, (*kinds, str, os.PathLike)):
        raise InputError(f"{name} is {type(about).__name__}; it is {what}")


def next(fit, goal, *, candidates=None, grid=None, specimens=None, cost=None, specimen_cost=None, use_cost=None, measure=None,
         by="variance", value=None, budget=None, batch=1, until=None, tests=None, samples=256, nodes=800, seed=1, failure_cost=None,
         replacement_cost=None, fleet_use=None, threads=0, progress=None):
    """Rank the tests that could be done next by how much they are expected to narrow a goal.

    Expectations are over the posterior of the fit and the outcomes that it predicts. One specimen is computed by
    quadrature, several by nested Monte Carlo with stated errors. The interpreter's lock is released.

    Parameters
    ----------
    fit : Fit, str or path
        A fit, or the folder of its result.
    goal : str
        What the tests are to determine: "B10 at NAME", a quantity, a prediction or a parameter of the study. An unknown
        goal is refused with the list of the known ones. Of a clutch: "wear rate at slip_speed = 1700 rpm, torque = 50 N m,
        temperature = 170 degC, closing_time = 2.15 s", or "life at ...".
    candidates : table, str or path, optional
        A row for each test: a column for each condition of the study, and optionally ``specimens``, ``stop`` (time at
        which a specimen that has not failed is taken off), ``name`` and a column of costs.
    grid : str or dict, optional
        Instead of candidates, all combinations: "alternating_stress = 200 to 500 by 25 MPa; stop = 1e6 cycles", or a dict
        ``{"alternating_stress": "200 to 500 by 25 MPa", "stop": [1e6, 5e6]}``.
    specimens : int, str or sequence of int, optional
        Numbers of specimens of each candidate without that column; default 1.
    cost : str, optional
        Column of candidates with the cost of all specimens; its heading may name the currency, "cost [EUR]".
    specimen_cost : float, optional
        Instead of a column: the cost of each specimen.
    use_cost : float, optional
        And of each unit of its expected time on test.
    measure : str, optional
        Column that the test measures, where the study has several.
    by : {"variance", "information", "loss"}
        What ranks: the expected variance of the goal (of its logarithm, where it is positive), the information about all
        parameters, or the expected saving of age replacement, whose life the goal names.
    value : float, optional
        Worth of one per cent of narrowing, in units of cost: says whether a test is worth its cost.
    budget : float, optional
        Cost of a batch at most.
    batch : int
        At most so many candidates are chosen together, 1 to 100.
    until : str, optional
        Target: "width <= factor 1.5" or "width <= 20 MPa". Says whether it is reached, and how many tests it needs.
    tests : table or sequence of tables, optional
        Tests done since the fit, in the columns of the study's data: data frames and their like, or paths of files.
    samples : int
        Samples of the nested Monte Carlo, 16 to 100000.
    nodes : int
        Nodes of the posterior at most, 50 to 20000.
    seed : int
        Seed of the nested Monte Carlo.
    failure_cost, replacement_cost : str or float, optional
        Of ``by="loss"``: costs of a failure in service and of a replacement before it, "12000 EUR".
    fleet_use : str or pint quantity, optional
        And the use of all units that the decision is for, "1e9 cycles": savings in money, and whether a test is worth its cost.
    threads : int
        Threads, 0 for all. No number depends on it.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds). An exception in it stops the work.

    Returns
    -------
    Plan
        The candidates, best first.

    Raises
    ------
    InputError
        If the goal, a column or an argument is unknown or out of its range, or a candidate cannot be tested; the message
        names argument, row and column.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> fit = ww.fit("examples/spring/sensible.toml", seed=1, method="exact", draws=100, report=False)
    >>> grid = {"alternating_stress_MPa": [240, 260, 280], "mean_stress_MPa": 1050, "stop": "1e6 cycles"}
    >>> plan = ww.plan.next(fit, "B10 at softer spring", grid=grid)
    >>> best = plan.summary["candidates"][0]
    >>> best["conditions"]["alternating_stress"]
    240.0
    >>> all(each["narrowing"] <= best["narrowing"] for each in plan.summary["candidates"])
    True
    >>> len(plan.tables["candidates"])
    3
    >>> ww.plan.next(fit, "B10 at hanger", grid=grid)
    Traceback (most recent call last):
        ...
    wearwell.InputError: goal: the study has no ...
    """
    _require(fit, "fit", (Fit,), "a fit, or the folder of a result")
    files, tests = files_and_tables(tests)
    return answer("next", {
        "goal": goal, "grid": grid, "specimens": specimens, "cost": cost, "specimen_cost": specimen_cost, "use_cost": use_cost,
        "measure": measure, "by": by, "value": value, "budget": budget, "batch": batch, "until": until, "samples": samples,
        "nodes": nodes, "seed": seed, "failure_cost": failure_cost, "replacement_cost": replacement_cost, "fleet_use": fleet_use,
        "tests": files or None,
    }, fit, "fit", {"candidates": candidates, "tests": tests}, threads, progress)


def size(study, goal, *, width, tests, assurance=0.8, level=0.9, measure=None, most=1000, simulations=200, seed=1, threads=0,
         progress=None):
    """Find the smallest number of specimens, before any test, with which a goal is known well enough.

    Parameters are drawn from the priors, campaigns are simulated, and each is fitted by quadrature. The interpreter's
    lock is released.

    Parameters
    ----------
    study : Study, str or path
        A study with proper priors, or its file. Its data are not used; those of a file need not exist.
    goal : str
        What the tests are to determine: "B10 at NAME", a quantity, a prediction or a parameter of the study.
    width : str
        Largest width of the goal's interval: "factor 2" (upper over lower end), or a difference, "30 um".
    tests : table, str or path
        A row for each kind of test: a column for each condition of the study, and optionally ``specimens`` (numbers or
        proportions), ``stop`` and ``name``.
    assurance : float or str
        Probability that the interval is so narrow.
    level : float or str
        Level of the interval.
    measure : str, optional
        Column that the tests measure, where the study has several.
    most : int
        Largest number of specimens tried, 1 to 100000.
    simulations : int
        Number of simulated campaigns, 20 to 100000.
    seed : int
        Seed of the simulation.
    threads : int
        Threads, 0 for all. No number depends on it.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds). An exception in it stops the work.

    Returns
    -------
    Plan
        The number of specimens, and the assurance of other numbers.

    Raises
    ------
    InputError
        If a prior is improper, or an argument, a column or the goal is unknown or wrong; the message names it.

    Examples
    --------
    >>> import wearwell as ww
    >>> study = ww.Study(formula="V = k*F*s", data={"F": [100], "s": [4e4], "V": [0.4]}, units={"F": "N", "s": "m", "V": "mm^3"},
    ...                  priors={"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=1), "sigma": ww.lognormal("0.1 mm^3", log_sd=0.3)})
    >>> tests = {"F [N]": [100, 200], "s [m]": [4e4, 4e4]}
    >>> plan = ww.plan.size(study, "k", width="factor 1.5", tests=tests, most=40, simulations=20)
    >>> plan.summary["reached"], plan.summary["specimens"] <= 40
    (True, True)
    """
    _require(study, "study", (Study,), "a study, or the path of a study file")
    return answer("size", {
        "goal": goal, "width": width, "assurance": assurance, "level": level, "measure": measure, "most": most,
        "simulations": simulations, "seed": seed,
    }, study, "study", {"tests": tests}, threads, progress)


def inspect(lives, *, at=None, risk=None, total_risk=None, warning=None, until=None, step=None, unit=None, new=False,
            inspection_cost=None, failure_cost=None, replacement_cost=None, downtime_cost=None, visit_cost=None, given=None,
            in_service=None, threads=0, progress=None):
    """Plan the inspections ahead that keep the risk below a bound with the fewest inspections, or the cheapest ones.

    For one unit, or for all running units of a fleet with common visits. The interpreter's lock is released.

    Parameters
    ----------
    lives : Fit, table, str or path
        A fit of lives, of a formula with a failure threshold, of bearings, or of S-N parts; the folder of its result; or a
        table of lives with the column "life [h]" and optionally weight, unit and population, or its file.
    at : str, optional
        Which life of [predict], for a fit of lives that has several.
    risk : float or str, optional
        Of each interval at most, that a unit reaches its threshold between two inspections; 1 % if neither this,
        ``total_risk`` nor costs are given.
    total_risk : float or str, optional
        At most, of a failure that no inspection foresees, for each unit; needs ``warning``.
    warning : str or pint quantity, optional
        An inspection shows a failure that comes within this use after it, "100 h".
    until : str or pint quantity, optional
        End of the plan; by default the time by which half of the units reach their threshold.
    step : str or pint quantity, optional
        Inspections at multiples of it.
    unit : str, optional
        One running unit.
    new : bool
        A new unit; also if there is no running one.
    inspection_cost, failure_cost, replacement_cost : float or str, optional
        Cost of an inspection, of a failure in service with its replacement, and of a preventive replacement, "60 EUR".
        With costs the cheapest plan is found.
    downtime_cost : str, optional
        Cost of an undetected failure, "5 EUR/h": failures are hidden until an inspection.
    visit_cost : float or str, optional
        Cost of a visit, whatever the number of units inspected.
    given : dict or sequence of str, optional
        Conditions of the next reading of ``unit``, ``{"force": "20 N"}``.
    in_service : table, str or path, optional
        Running units, for a fit of lives: columns unit, "age [h]", and in_study (yes where the study has the unit as a
        run-out of this age).
    threads : int
        Threads, 0 for all. No number depends on it.
    progress : bool or callable, optional
        True for a bar, or a function of (what, done, total, seconds). An exception in it stops the work.

    Returns
    -------
    Plan
        The inspection times, with the risk of each interval and expected costs.

    Raises
    ------
    InputError
        If an argument, a unit or a cell of the table is wrong, or no plan keeps the bound; the message names the argument.

    Warns
    -----
    CheckWarning
        If the fit is not trusted.

    Examples
    --------
    >>> import wearwell as ww
    >>> plan = ww.plan.inspect("examples/decide/lives.csv", unit="P4", risk=0.1, until="800 h", step="10 h")
    >>> plan.summary["aim"]
    'fewest'
    >>> all(each["risk"] <= 0.1 for each in plan.summary["units"][0]["inspections"])
    True

    Lives in memory, and the cheapest inspections:

    >>> lives = {"life [h]": [1200, 1500, 1900, 2300, 2600, 3100, 3600]}
    >>> plan = ww.plan.inspect(lives, until="3000 h", inspection_cost="60 EUR", failure_cost="2000 EUR", downtime_cost="2 EUR/h")
    >>> plan.summary["aim"], plan.summary["currency"]
    ('cheapest', 'EUR')
    """
    if isinstance(lives, Study):
        raise InputError("lives is Study; it is a fit, the folder of a result, or a table of lives")
    return answer("inspect", {
        "at": at, "risk": risk, "total_risk": total_risk, "warning": warning, "until": until, "step": step, "unit": unit, "new": new,
        "inspection_cost": inspection_cost, "failure_cost": failure_cost, "replacement_cost": replacement_cost,
        "downtime_cost": downtime_cost, "visit_cost": visit_cost, "given": given,
    }, lives, "lives", {"in_service": in_service}, threads, progress)
