"""Joint wear in one line."""

from . import toml
from .fit_options import fits
from .errors import InputError
from .preset_study import Preset, level_of_bounds, percentages, quantities


@fits
def joint(data, volume, cycles, *, work_per_cycle=None, work=None, force=None, slip=None, limit=None, risk=None, at=None,
          family="normal", count=None, units=None, priors=None, b=(1, 10), confidence=0.9, predict=None, unused=None, title=None,
          stages=False, seed=None, method=None, chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
    """Fit the wear coefficient of a joint to inspections of its worn volume, and the cycles to a failure threshold.

    Parameters
    ----------
    data : table
        A row for each inspection: whatever ``wearwell.table`` takes.
    volume : str
        Column of the worn volume.
    cycles : str
        Column of the cycles until the inspection.
    work_per_cycle : str or pint quantity, optional
        Friction work of one cycle, force times slip: "6 N m".
    work : str, optional
        Instead, column of the friction work until the inspection.
    force, slip : str, optional
        Instead, columns of the force and of the slip distance until the inspection.
    limit : str or pint quantity, optional
        Failure threshold of the volume: "100 mm^3". Without it no life is predicted.
    risk : str or float, optional
        Risk of passing it before the next inspection: "1 %".
    at : float or sequence of float, optional
        Cycles at which the volume is predicted; by default twice the largest of the table, where ``work_per_cycle`` is known.
    family : {"normal", "lognormal"}
        Distribution of a measurement.
    count : str, optional
        Column of the number of equal rows.
    units : dict, optional
        Unit of columns: ``{"V": "mm^3"}``. A heading may have it.
    priors : dict of str to dict, optional
        Priors by parameter. By default ``k`` is lognormal with median 1e-5 mm^3/(N m) and log_sd 4.2, ``sigma`` half-normal
        with the largest volume, rounded up, as its scale. ``V0`` and ``exponent`` exist if they have a prior.
    b : float or sequence of float
        Percentages of B-lives.
    confidence : float
        Probability with which their lower bounds are exceeded.
    predict : dict, optional
        Further keys of ``[predict]`` of a joint.
    unused : str or sequence of str, optional
        Columns that look like a number of equal rows or like labels of several joints and are none.
    stages : bool
        Whether the posterior after 1, 2, ... rows is computed too: ``fit.results["stages"]``.
    <what all fits share>

    Examples
    --------
    >>> import wearwell as ww
    >>> inspections = {"n": [1, 100, 1000, 5000, 10000], "V": [1.59, 2.57, 8.10, 24.48, 46.21]}
    >>> fit = ww.joint(inspections, "V", "n", work_per_cycle="5.966 N m", limit="100 mm^3", units={"V": "mm^3"}, method="exact",
    ...                report=False)
    >>> print(f"{fit.parameters.loc['k', 'q50']:.1e} {fit.parameters.loc['k', 'unit']}")
    7.8e-04 mm^3/(N m)
    >>> fit.lives.loc[0, ["at", "unit"]].tolist()
    ['to 100 mm^3', 'cycles']
    """
    study = Preset("archard-joint", data, units)
    study.column("cycles", "cycles", cycles)
    study.column("volume", "volume", volume)
    study.column("work", "work", work)
    study.column("force", "force", force)
    study.column("slip", "slip", slip)
    if work_per_cycle is None and work is None and (force is None or slip is None):
        raise InputError("work_per_cycle is missing: the friction work of one cycle, such as '6 N m'; or work, a column of the work until "
                         "each inspection; or force and slip, columns of both")
    if work_per_cycle is not None and (work is not None or force is not None):
        other = "work" if work is not None else "force"
        raise InputError(f"work_per_cycle and {other} say the same of the rows in two ways; give one of them, and the work of one cycle "
                         "for which lives are predicted by predict={'work_per_cycle': '6 N m'}")
    asked = {"limit": None if limit is None else toml.quantity(limit, "limit"), "risk": None if risk is None else toml.quantity(risk, "risk")}
    if work_per_cycle is not None:
        study.conditions["work_per_cycle"] = toml.quantity(work_per_cycle, "work_per_cycle")
        study.arguments["conditions.work_per_cycle"] = "work_per_cycle"
        asked["cycles"] = quantities(at, "at") or [2 * float(max(study.columns.numbers(study.columns.heading(cycles, "cycles")), default=1))]
    elif at is not None:
        asked["cycles"] = quantities(at, "at")
    study.column("count", "count", count)
    if limit is not None:
        asked.update({"b_lives": percentages(b), **level_of_bounds(confidence, predict)})
    if not isinstance(stages, bool):
        raise InputError(f"stages is {stages!r}; it is True or False")
    made = study.study(title or f"Joint wear: {volume} against {cycles}",
                       {"likelihood": {"family": family}, "update": {"stages": "row"} if stages else {}}, priors,
                       {**asked, **(predict or {})}, unused, may_have_counts=True, units=True, noun="joint", count_as="those of one joint")
    return made.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
