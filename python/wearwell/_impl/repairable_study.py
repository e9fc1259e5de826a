"""Units that are repaired, in one line: failures in the course of their age."""

import numbers

from . import toml
from .columns import repairs_of
from .errors import InputError
from .fit_options import fits
from .preset_study import Preset, classical_key, quantities

_processes = ("power_law", "renewal", "phases")


@fits
def repairable(data, age, *, unit, event=None, start=None, count=None, grouped=False, process="power_law", end=None, rounding=None, phase_ends=None, reference_age=None,
               mode=None, fixes=None, at=None, ahead=None, units=None, priors=None, classical=False, predict=None, unused=None, title=None, seed=None, method=None, chains=None,
               warmup=None, draws=None, threads=0, report=True, progress=None):
    """Fit the failures of units that are repaired: minimal repair (Crow-AMSAA), renewal, or phases of a growth test.

    Parameters
    ----------
    data : table
        A row for each failure and one for the end of observation of each unit: whatever ``wearwell.table`` takes.
    age : str
        Column of the unit's age at the event: a time, a distance or cycles, with its unit.
    unit : str
        Column of the units.
    event : str or dict, optional
        Column that says what happened: "failure" or "end", or True or 1 at a failure and False or 0 at the end of observation.
        A dict says what codes and words mean: ``{"column": "event", "failure": "repaired", "end": "today"}``. Needed unless
        ``grouped``, where the last row of a unit ends its observation.
    start : str, optional
        Column of the age at which observation of the unit began; by default 0.
    count : str, optional
        Column of the number of failures of the unit at that age; larger numbers than 1 need ``rounding``. In the row of an end
        it is 1, 0 or missing.
    grouped : bool
        Whether ``count`` is the number of failures since the row before of the unit, at unknown ages; 0 is a count.
    process : {"power_law", "renewal", "phases"}
        ``power_law``: minimal repair, a unit is as bad as old. ``renewal``: as good as new. ``phases``: a growth test whose
        intensity changes between phases.
    end : {"row", "last failure"}, optional
        Until when units without a row of their end were observed.
    rounding : str or pint quantity, optional
        Step to which ages are rounded, "1 day"; needed for two failures at one age.
    phase_ends : sequence of str, optional
        Of phases: the ages at which all phases but the last end.
    reference_age : str or pint quantity, optional
        Of a power law: age T of the parameter ``M_T``; by default the largest age.
    mode : str, optional
        Column of the failure mode of each failure of a growth test; needs ``fixes``.
    fixes : dict, optional
        The fix of each mode: "none" (A modes), "during" the test (BC), or, of a mode that is fixed after the test (BD), the share of
        its failure intensity that the fix removes, a number from 0 to 1 or a distribution:
        ``{"A": "none", "BC1": "during", "BD1": 0.7, "BD2": {"distribution": "beta", "alpha": 7, "beta": 3}}``. The projection is
        ``fit.results["repairable"]["projection"]``.
    at : str or sequence of str, optional
        Of a power law: ages at which the mean time between failures is asked for, "600 day".
    ahead : str or sequence of str, optional
        Times from the end of observation on, "100 day": failures to come, of all units and of each.
    units : dict, optional
        Unit of columns: ``{"age": "day"}``. A heading may have it.
    priors : dict of str to dict, optional
        Priors by parameter. By default ``beta`` is lognormal with median 1 and log_sd 0.7, ``M_T`` lognormal with median 1 and
        log_sd 3; ``eta`` (renewal) and ``MTBF_1``, ... (phases) are lognormal with log_sd 3 and a median from the size of the
        ages.
    classical : bool
        Whether ``fit.results["classical"]`` has maximum likelihood estimates with Fisher, likelihood-ratio and exact bounds
        (chi-square, Crow) beside the posterior.
    predict : dict, optional
        Further keys of ``[predict]`` of a repairable study.
    unused : str or sequence of str, optional
        Columns that look like a role and have none.
    <what all fits share>

    Examples
    --------
    >>> import wearwell as ww
    >>> history = {"pump": ["A", "A", "A", "B", "B", "B", "B"], "age": [410, 980, 1500, 300, 720, 1010, 1200],
    ...            "event": ["failure", "failure", "end", "failure", "failure", "failure", "end"]}
    >>> fit = ww.repairable(history, "age", unit="pump", event="event", ahead="500 h", units={"age": "h"}, method="exact", report=False)
    >>> list(fit.parameters.index)
    ['beta', 'M_T']
    >>> fit.results["repairable"]["failures"], len(fit.results["repairable"]["forecast"])
    (5, 2)
    """
    if process not in _processes:
        raise InputError(f"process is {process!r}; it is {', '.join(_processes)}")
    if not isinstance(grouped, bool):
        raise InputError(f"grouped is {grouped!r}; it is True or False")
    if grouped and count is None:
        raise InputError("grouped needs count: the column of the number of failures since the row before")
    if event is None and not grouped:
        raise InputError('event is missing: the column that says "failure" or "end"')
    study = Preset("repairable", data, units)
    study.column("unit", "unit", unit)
    study.column("age", "age", age)
    if event is not None:
        study.rows["event"] = repairs_of(study.columns, event)
    study.column("start", "start", start)
    study.column("count", "count", count)
    study.column("mode", "mode", mode)
    study.choices["process"] = process
    for key, value in (("end", end), ("rounding", rounding)):
        if value is not None:
            study.of_data[key] = toml.quantity(value, key)
    if grouped:
        study.of_data["grouped"] = True
    for key, value in (("reference_age", reference_age), ("phase_ends", quantities(phase_ends, "phase_ends"))):
        if value is not None:
            study.conditions[key] = value if isinstance(value, list) else toml.quantity(value, key)
    study.arguments.update({"data.columns.event": "event", "data.end": "end", "data.rounding": "rounding", "data.grouped": "grouped", "predict.age": "at", "predict.next": "ahead",
                            "conditions.phase_ends": "phase_ends", "conditions.reference_age": "reference_age"})
    asked = {"age": quantities(at, "at"), "next": quantities(ahead, "ahead"), **classical_key(classical), **(predict or {})}
    made = study.study(title or f"Failures along {age}", _fix_tables(mode, fixes, study.arguments), priors, asked, unused, may_have_counts=True)
    return made.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)


def _fix_tables(mode, fixes, arguments):
    """The tables [fixes] and [fixes.effectiveness]."""
    if fixes is None and mode is None:
        return {}
    if fixes is None or mode is None:
        raise InputError("mode needs fixes, and fixes needs mode: the column of the failure modes, and the fix of each")
    if not isinstance(fixes, dict) or not fixes:
        raise InputError(f'fixes is {fixes!r}; it is a dict of modes like {{"A": "none", "BC1": "during", "BD1": 0.7}}')
    named = {"none": [], "during": []}
    after = {}
    for each, fix in fixes.items():
        if isinstance(fix, str) and fix not in named:
            raise InputError(f'fixes: {each} is {fix!r}; it is "none", "during", or the share of the failure intensity that the fix removes')
        if isinstance(fix, str):
            named[fix].append(str(each))
        elif isinstance(fix, dict) or (isinstance(fix, numbers.Real) and not isinstance(fix, bool)):
            after[str(each)] = fix if isinstance(fix, dict) else float(fix)
        else:
            raise InputError(f'fixes: {each} is {fix!r}; it is "none", "during", a number from 0 to 1 or a distribution')
    arguments.update({"data.columns.mode": "mode", "fixes": "fixes", "fixes.none": "fixes", "fixes.during": "fixes"})
    arguments.update({f"fixes.effectiveness.{each}": f"fixes, {each}" for each in after})
    return {"fixes": {key: each for key, each in named.items() if each}, "fixes.effectiveness": after}
