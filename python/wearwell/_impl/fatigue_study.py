"""Fatigue in one line: S-N curves, and fatigue limits of up-and-down tests."""

from collections.abc import Mapping

from . import toml
from .columns import status_of
from .errors import InputError
from .fit_options import fits
from .preset_study import Preset, level_of_bounds, percentages, quantities
from .proposed import quantity_text

_corrections = ("none", "goodman", "gerber", "soderberg", "morrow", "swt", "walker")
_curves = ("basquin", "knee", "stromeyer", "bastenaire")


def _stresses(at, conditions, unit):
    """[predict.stress] of the stresses asked for, by name. A plain number is in the unit of the tests."""
    if at is None:
        return None
    if not isinstance(at, Mapping):
        at = {each if isinstance(each, str) else toml.number_text(each): each for each in quantities(at, "at")}
    same = {key: conditions[key] for key in ("stress_ratio", "mean_stress") if key in conditions}

    def of_tests(value, argument):
        value = toml.quantity(value, argument)
        return value if isinstance(value, str) else quantity_text(value, unit)

    return {name: {key: of_tests(value, f"at: '{name}': {key}") if key == "alternating_stress" else toml.quantity(value, f"at: '{name}': {key}")
                   for key, value in each.items()} if isinstance(each, Mapping)
            else {"alternating_stress": of_tests(each, f"at: '{name}'"), **same} for name, each in at.items()}


@fits
def sn(data, stress, life, *, event=None, stress_ratio=None, mean_stress=None, correction=None, curve="basquin", fatigue_limit="none",
       family="log10-normal", scatter="constant", count=None, label=None, units=None, priors=None, b=(1, 10), confidence=0.9,
       at=None, survival_to=None, required_life=None, reliability=None, predict=None, unused=None, title=None, seed=None, method=None,
       chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
    """Fit an S-N curve to a table of fatigue tests, run-outs included.

    Parameters
    ----------
    data : table
        A row for each test: whatever ``wearwell.table`` takes.
    stress : str
        Column of the stress amplitude.
    life : str
        Column of the cycles at which a test ended.
    event : str or dict, optional
        Column that says how each test ended, as of ``wearwell.life``. Without it all specimens failed.
    stress_ratio, mean_stress : str or float, optional
        Column of the ratio of the smallest to the largest stress, or of the mean stress; or what is the same for all tests:
        -1, "200 MPa". Not needed where ``correction`` is "none".
    correction : {"none", "goodman", "gerber", "soderberg", "morrow", "swt", "walker"}, optional
        Mean-stress correction: "goodman" by default where a column of ratios or means is given, else "none".
    curve : {"basquin", "knee", "stromeyer", "bastenaire"}
        Form of the curve.
    fatigue_limit : {"none", "random"}
        Whether specimens have a limit that scatters.
    family : {"log10-normal", "weibull", "normal"}
        Distribution of lives under one stress.
    scatter : {"constant", "grows"}
        Whether lives scatter alike under every stress, or more under lower ones.
    count : str, optional
        Column of the number of equal tests in a row.
    label : str, optional
        Column that names a type; by default lives are asked of all tested stresses.
    units : dict, optional
        Unit of columns: ``{"S": "MPa"}``. A heading may have it.
    priors : dict of str to dict, optional
        Priors by parameter. Those that are missing have the defaults of the model, from the stresses tested:
        ``fit.study.description()`` shows them.
    b : float or sequence of float
        Percentages of B-lives.
    confidence : float
        Probability with which their lower bounds are exceeded.
    at : str, float, sequence or dict, optional
        Stress amplitudes whose lives are predicted: "400 MPa", or a plain number in the unit of the tests; or these by name, each with its own ratio or mean stress if need
        be: ``{"shaft": {"alternating_stress": "400 MPa", "stress_ratio": -1}}``.
    survival_to : str or list of str, optional
        Lives to which the share of survivors is asked, such as "1e6 cycles".
    required_life : str or list of str, optional
        Life for which the allowable stress is asked, with ``reliability``.
    reliability : str, float or list, optional
        Share that survives it: "90 %".
    predict : dict, optional
        Further keys of ``[predict]`` of an S-N study.
    unused : str or sequence of str, optional
        Columns that look like an event and are none.
    <what all fits share>

    Examples
    --------
    >>> import wearwell as ww
    >>> tests = {"S": [450, 450, 400, 400, 350, 350, 300, 300, 260], "N": [3.1e4, 4.4e4, 9e4, 1.3e5, 3.2e5, 2.4e5, 1.1e6, 8.2e5, 5e6],
    ...          "end": ["failed"] * 8 + ["runout"]}
    >>> fit = ww.sn(tests, "S", "N", event="end", units={"S": "MPa"}, method="exact", report=False)
    >>> round(fit.parameters.loc["b", "q50"], 3)
    -0.117
    """
    study = Preset("sn", data, units)
    study.column("alternating_stress", "stress", stress)
    study.either("stress_ratio", "stress_ratio", stress_ratio)
    study.either("mean_stress", "mean_stress", mean_stress)
    if stress_ratio is not None and mean_stress is not None:
        raise InputError("stress_ratio and mean_stress say the same in two ways; give one of them")
    if correction is None:
        correction = "goodman" if {"stress_ratio", "mean_stress"} & set(study.rows) else "none"
    for name, value, allowed in (("correction", correction, _corrections), ("curve", curve, _curves),
                                 ("fatigue_limit", fatigue_limit, ("none", "random")), ("scatter", scatter, ("constant", "grows")),
                                 ("family", family, ("log10-normal", "weibull", "normal"))):
        if value not in allowed:
            raise InputError(f"{name} is {value!r}; it is {', '.join(allowed)}")
    if correction != "none" and stress_ratio is None and mean_stress is None:
        raise InputError(f"correction='{correction}' needs stress_ratio or mean_stress: a column, or a value such as -1 of all tests")
    study.column("life", "life", life)
    if event is not None:
        study.status(status_of(study.columns, event))
    study.column("count", "count", count)
    study.column("label", "label", label)
    law = {"mean_stress": correction, **({"curve": curve} if curve != "basquin" else {}),
           **({"fatigue_limit": fatigue_limit} if fatigue_limit != "none" else {}), **({"scatter": scatter} if scatter != "constant" else {})}
    asked = {"types": "all", "b_lives": percentages(b), **level_of_bounds(confidence, predict), "survival_to": quantities(survival_to, "survival_to"),
             "required_life": quantities(required_life, "required_life"), "reliability": quantities(reliability, "reliability"),
             "stress": _stresses(at, study.conditions, study.columns.unit(study.columns.heading(stress, "stress"))), **(predict or {})}
    for name, each in (asked["stress"] if at is not None else {}).items():
        study.arguments.update({f"{table}.{name}.{key}": f"at: '{name}': {key}" for key in each for table in ("stress", "predict.stress")})
    study.arguments.update({"law.mean_stress": "correction", "law.curve": "curve", "law.scatter": "scatter", "predict.stress": "at", "likelihood.family": "family"})
    made = study.study(title or f"S-N curve: {stress} and {life}", {"law": law, "likelihood": {"family": family}}, priors, asked, unused, may_have_counts=True)
    return made.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)


@fits
def staircase(data, stress, event, *, count=None, limit_family="normal", units=None, priors=None, reliability=("50 %", "90 %"),
              confidence=0.9, predict=None, unused=None, title=None, seed=None, method=None, chains=None, warmup=None, draws=None,
              threads=0, report=True, progress=None):
    """Fit the fatigue limit and its scatter to an up-and-down test.

    Parameters
    ----------
    data : table
        A row for each specimen: whatever ``wearwell.table`` takes.
    stress : str
        Column of the stress amplitude.
    event : str or dict
        Column that says whether each specimen failed, as of ``wearwell.life``.
    count : str, optional
        Column of the number of equal tests in a row.
    limit_family : {"normal", "smallest-extreme-value"}
        Distribution of the logarithm of the limit.
    units : dict, optional
        Unit of columns: ``{"S": "MPa"}``. A heading may have it.
    priors : dict of str to dict, optional
        Priors of ``log10_limit`` and ``sigma_limit``; by default those of the model, from the stresses tested.
    reliability : str, float or sequence
        Shares of specimens that survive the stresses that are asked for.
    confidence : float
        Probability with which their lower bounds are exceeded.
    predict : dict, optional
        Further keys of ``[predict]`` of a staircase.
    unused : str or sequence of str, optional
        Columns that look like a number of equal tests and are none.
    <what all fits share>

    Examples
    --------
    >>> import wearwell as ww
    >>> tests = {"S [MPa]": [300, 315, 330, 315, 300, 315, 300, 285, 300, 315], "broke": [0, 0, 1, 1, 0, 1, 1, 0, 0, 1]}
    >>> fit = ww.staircase(tests, "S", "broke", method="exact", report=False)
    >>> fit.quantities.loc[0, ["name", "unit"]].tolist(), round(fit.quantities.loc[0, "q50"])
    (['fatigue limit', 'MPa'], 307)
    """
    if limit_family not in ("normal", "smallest-extreme-value"):
        raise InputError(f"limit_family is {limit_family!r}; it is normal, smallest-extreme-value")
    study = Preset("staircase", data, units)
    study.column("alternating_stress", "stress", stress)
    study.status(status_of(study.columns, event))
    study.column("count", "count", count)
    law = {"limit_family": limit_family} if limit_family != "normal" else {}
    asked = {"reliability": quantities(reliability, "reliability"), "credible_level": confidence, **(predict or {})}
    made = study.study(title or f"Fatigue limit: {stress}", {"law": law}, priors, asked, unused, may_have_counts=True)
    return made.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
