"""Wear of bearings in one line: what calling ``wearwell.bearing`` does."""

from . import toml
from .fit_options import fits
from .errors import InputError
from .preset_study import Preset, level_of_bounds, percentages, quantities


@fits
def bearing(data, depth, *, contact, radius, clearance, unit=None, revolutions=None, time=None, speed=None, pressure=None, force=None,
            length=None, limit=None, risk=None, at=None, depth_error=None, family="normal", count=None, units=None, priors=None,
            b=(1, 10), confidence=0.9, predict=None, unused=None, title=None, seed=None, method=None, chains=None, warmup=None, draws=None,
            threads=0, report=True, progress=None):
    """Fit the wear rate of journal bearings to inspections of their wear depth, and the life to a failure threshold.

    ``wearwell.bearing.rate``, ``depth``, ``pressure``, ``length`` and ``life`` compute one bearing of known wear.

    Parameters
    ----------
    data : table
        A row for each inspection: whatever ``wearwell.table`` takes.
    depth : str
        Column of the wear depth.
    contact : str
        "stationary", "journal" or "bushing", what wears; or a column of these.
    radius, clearance : str or pint quantity
        Radius of the journal and radial clearance: "10 mm"; or columns of them.
    unit : str, optional
        Column that names the bearing of each row; the wear rate then differs from bearing to bearing. Without it each row is
        its own bearing, and all have one wear rate.
    revolutions : str, optional
        Column of the revolutions until the inspection; or ``time`` and ``speed``.
    time, speed : str or pint quantity, optional
        Column of the time until the inspection, and the speed: a column or "60 rpm".
    pressure : str or pint quantity, optional
        Pressure on the projected area: a column or "1 MPa"; or ``force`` and ``length``.
    force, length : str or pint quantity, optional
        Load and length of the bearing.
    limit : str or pint quantity, optional
        Failure threshold of the depth: "80 um". Without it no life is predicted.
    risk : str or float, optional
        Risk of reaching it before the inspection of a new bearing: "1 %".
    at : float, str or sequence, optional
        Revolutions at which the depth is predicted.
    depth_error : str or pint quantity, optional
        Known standard deviation of one measured depth, instead of the parameter sigma.
    family : {"normal", "lognormal"}
        Distribution of a measured depth.
    count : str, optional
        Column of the number of equal rows.
    units : dict, optional
        Unit of columns: ``{"d": "um"}``. A heading may have it.
    priors : dict of str to dict, optional
        Priors by parameter. By default ``k`` is lognormal with median 1e-5 mm^3/(N m) and log_sd 4.2, ``sigma`` half-normal
        with the largest depth, rounded up, as its scale, ``k_scatter`` half-normal with scale 1.
    b : float or sequence of float
        Percentages of B-lives.
    confidence : float
        Probability with which their lower bounds are exceeded.
    predict : dict, optional
        Further keys of ``[predict]`` of a bearing study, such as ``{"pressure": "1.5 MPa", "speed": "60 rpm"}``.
    unused : str or sequence of str, optional
        Columns that look like a number of equal rows or like labels of bearings and are none.
    <what all fits share>

    Examples
    --------
    >>> import pandas as pd
    >>> import wearwell as ww
    >>> inspections = pd.read_csv("examples/bearing/inspections.csv")
    >>> fit = ww.bearing(inspections, "depth_um", contact="stationary", radius="10 mm", clearance="clearance_um", unit="bearing",
    ...                  revolutions="revolutions", force="force_N", length="20 mm", depth_error="2 um", method="exact", report=False,
    ...                  units={"depth_um": "um", "clearance_um": "um", "force_N": "N"})
    >>> print(f"{fit.parameters.loc['k', 'q50']:.1e} {fit.parameters.loc['k', 'unit']}")
    2.0e-06 mm^3/(N m)
    """
    study = Preset("bearing-wear", data, units)
    study.column("depth", "depth", depth)
    study.column("bearing", "unit", unit)
    for name, value in (("contact", contact), ("radius", radius), ("clearance", clearance), ("revolutions", revolutions), ("time", time),
                        ("speed", speed), ("pressure", pressure), ("force", force), ("length", length)):
        study.either(name, name, value)
    if revolutions is None and (time is None or speed is None):
        raise InputError("revolutions is missing: the column of the revolutions until each inspection; or time and speed")
    if pressure is None and (force is None or length is None):
        raise InputError("pressure is missing: '1 MPa' or a column; or force and length")
    study.column("count", "count", count)
    priors = dict(priors or {})
    if unit is not None and "k_scatter" not in priors:
        priors["k_scatter"] = {"distribution": "default"}
    asked = {"revolutions": quantities(at, "at"), "limit": None if limit is None else toml.quantity(limit, "limit"),
             "risk": None if risk is None else toml.quantity(risk, "risk")}
    if limit is not None:
        asked.update({"b_lives": percentages(b), **level_of_bounds(confidence, predict)})
    likelihood = {"family": family, **({} if depth_error is None else {"depth_error": toml.quantity(depth_error, "depth_error")})}
    made = study.study(title or f"Bearing wear: {depth}", {"likelihood": likelihood}, priors, {**asked, **(predict or {})}, unused,
                       may_have_counts=True, units=unit is None, noun="bearing")
    return made.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
