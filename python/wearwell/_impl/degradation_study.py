"""Degradation in one line: paths of units to a failure threshold."""

from . import toml
from .columns import Columns
from .errors import InputError
from .fit_options import fits
from .preset_study import level_of_bounds
from .proposed import Priors, factor_27, half_normal, lognormal, normal, quantity_text, rounded_up, unit_of_ratio
from .study import Study

_processes = ("wiener-process", "gamma-process", "inverse-gaussian-process")
_families = ("normal", "lognormal", *_processes)


def _limit(limit, y, unit):
    """The failure threshold as a text in a unit that y may have; a plain number is in the unit of y."""
    limit = toml.quantity(limit, "limit")
    if not isinstance(limit, str):
        return quantity_text(limit, unit)
    has_unit = limit.strip().lower().strip("0123456789.+-e ") != ""
    if has_unit and not unit:
        raise InputError(f"limit is '{limit}', and column '{y}' has no unit: units={{'{y}': '{limit.split(None, 1)[-1]}'}} says that of the "
                         "column, or write the limit as a plain number")
    return limit


def _require_one_path(columns, x, y):
    """Without a column of units all rows are of one."""
    values = columns.cells(x)
    falls = (values[1:] < values[:-1]).nonzero()[0]
    if len(falls):
        row = int(falls[0]) + 2
        raise InputError(f"unit is missing: {x} falls at row {row} from {values[row - 2]:g} to {values[row - 1]:g}, so the rows are of "
                         f"several units; unit='...' names the column that tells them apart, or unit=False says that all rows of {y} are of one")


@fits
def degradation(data, y, x, *, unit=None, limit=None, path="line", family="normal", starts_at_zero=None, units=None, priors=None,
                b=(1, 10), confidence=0.9, predict=None, unused=None, title=None, seed=None, method=None, chains=None, warmup=None,
                draws=None, threads=0, report=True, progress=None):
    """Fit degradation paths, and the lives to a failure threshold: of a new unit, and what remains to each.

    Parameters
    ----------
    data : table
        A row for each reading: whatever ``wearwell.table`` takes.
    y : str
        Column that is measured, such as wear.
    x : str
        Column along which it grows or falls: time, distance, cycles.
    unit : str or False, optional
        Column that names the unit of each row. The rate then differs from unit to unit (lognormal). False: all rows are of
        one unit, although ``x`` does not rise throughout.
    limit : str, float or pint quantity, optional
        Failure threshold of ``y``; a plain number is in its unit. Without it no life is predicted.
    path : {"line", "power"}
        Shape of a path: rate*x, or rate*L*(x/L)^power, where L is the largest x, rounded up: ``rate`` is the mean rate up to L.
    family : {"normal", "lognormal", "wiener-process", "gamma-process", "inverse-gaussian-process"}
        Readings that scatter about the path (default), by a share of it (lognormal: paths begin at 0 and rise), or a process of random increments, whose variance over the mean of a
        step is ``step_ratio``. Gamma and inverse Gaussian processes only rise.
    starts_at_zero : bool, optional
        Whether paths begin at 0. By default the data decide by a straight line through each unit: not where the line begins
        beyond 30 % of the largest reading and beyond four times the scatter about it.
    units : dict, optional
        Unit of columns: ``{"wear": "um", "km": "km"}``. A heading may have it.
    priors : dict of str to dict, or "flat", optional
        Priors that replace defaults, by parameter. With "flat" nothing is known of any parameter, and the mode of the
        posterior, ``fit.results["mode"]``, is the maximum likelihood estimate. Defaults are weak, sizes rounded up to 1, 2 or 5 times a power of ten.
        ``rate``: lognormal, log_sd 2, median the rate of straight lines through the data. ``power``: lognormal, median 1, log_sd 0.5. ``start``: normal, mean half of the
        largest reading, sd all of it. ``sigma``: half-normal, scale the largest reading, 1 of "lognormal"; ``step_ratio``: the largest reading.
        ``rate_scatter`` of ln rate between units: half-normal, scale 1.
    b : float or sequence of float
        Percentages of B-lives.
    confidence : float
        Probability with which their lower bounds are exceeded.
    predict : dict, optional
        Further keys of ``[predict]`` of a formula study. By default ``at`` is twice the largest x.
    unused : str or sequence of str, optional
        Columns that look like labels of units and are none.
    <what all fits share>

    Examples
    --------
    One machine; of several ``unit="machine"`` names the column that tells them apart:

    >>> import wearwell as ww
    >>> wear = {"km": [10, 20, 30, 40], "wear": [11, 19, 32, 41]}
    >>> fit = ww.degradation(wear, y="wear", x="km", limit="100 um", units={"wear": "um", "km": "km"}, method="exact", report=False)
    >>> fit.parameters.loc["rate", ["unit", "q50"]].tolist()
    ['um/km', 1.028...]
    >>> fit.lives.loc[0, ["at", "unit"]].tolist()
    ['to path = 100 um', 'km']
    """
    if path not in ("line", "power"):
        raise InputError(f"path is {path!r}; it is 'line' or 'power'")
    if family not in _families:
        raise InputError(f"family is {family!r}; it is {', '.join(_families)}")
    columns = Columns(data, units, {"rate", "power", "start", "sigma", "step_ratio", "rate_scatter", "path"})
    y, x = columns.take(y, "y"), columns.take(x, "x")
    unused = [columns.heading(each, "unused") for each in ([unused] if isinstance(unused, str) else unused or ())]
    rows = {columns.name(y): columns.entry(y), columns.name(x): columns.entry(x)}
    if unit not in (None, False):
        unit = columns.take(unit, "unit")
        rows[columns.name(unit)] = unit
    elif unit is None:
        _require_one_path(columns, x, y)
        columns.warn_of_idle(unused, units=True, otherwise="unit=False")
    of, along = columns.unit(y), columns.unit(x)
    columns.require_rows_of_family(x, y, family)
    for argument, heading in (("y", y), ("x", x)):
        columns.require_numbers(heading, argument)
    values, places = columns.numbers(y), columns.numbers(x)
    at_zero, falls, rate = columns.line(x, y, unit or None)
    if starts_at_zero is not None and not starts_at_zero and family != "normal":
        raise InputError(f"starts_at_zero=False needs family='normal': paths of the family {family} begin at 0")
    at_zero = bool(starts_at_zero) if starts_at_zero is not None else at_zero or family == "lognormal"
    process = family in _processes
    if process and not at_zero and starts_at_zero is None:
        raise InputError(f"family '{family}': the path of a process begins at 0, and a line through the readings of {y} does not: give "
                         "the growth since the first reading, or starts_at_zero=True")
    if falls and family in ("lognormal", "gamma-process", "inverse-gaussian-process"):
        raise InputError(f"family '{family}': its paths only rise, and {y} falls; give the loss since the first reading")
    size = rounded_up(max(abs(values)) or 1)
    last = max(abs(places)) or 1
    known = Priors(priors)
    sign = "-" if falls else ""
    name = columns.name(x)
    known.add("rate", lognormal(rounded_up(rate), unit_of_ratio(of, along), 2), f"{factor_27} of the rate of straight lines, rounded up")
    if path == "power":
        if places.min() < 0:
            raise InputError(f"path='power' needs an axis from 0 on, and {x} is {places.min():g}")
        at = f"{rounded_up(last):.15g}" + (f" [{along}]" if along not in ("", "1") else "")
        known.add("power", lognormal(1.0, "", 0.5), "below 1 it slows down, above it speeds up")
        grows = f"rate * {at} * ({name}/({at}))^power"
    else:
        grows = f"rate * {name}"
    formula = f"{sign}{grows}" if at_zero else f"start {sign or '+'} {grows}"
    if not at_zero:
        known.add("start", normal(size / 2, size, of), "half of the largest reading, give or take all of it")
    if process:
        known.add("step_ratio", half_normal(size, of), "up to the size of the readings")
        slots = {"family": family, "mean": formula, "scale": "step_ratio"}
    else:
        lognormal_readings = family == "lognormal"
        known.add("sigma", half_normal(1.0) if lognormal_readings else half_normal(size, of),
                  "scatter of the log of a reading" if lognormal_readings else "scatter of a reading, up to the size of the readings")
        slots = ({"family": family, "median": "path", "log_sd": "sigma"} if lognormal_readings
                 else {"family": "normal", "mean": "path", "sd": "sigma"})
    effects = ""
    if unit:
        known.add("rate_scatter", half_normal(1.0), "most units are within a factor of ten")
        effects = toml.table(f"random_effects.{columns.name(unit)}", {"rate": {"distribution": "lognormal", "log_sd": "rate_scatter"}})
    known.require_used()
    asked = {"along": name, "at": [quantity_text(2 * last, along)]}
    if limit is not None:
        asked.update({"limit": {columns.name(y) if process else "path": _limit(limit, y, of)}, "b_lives": list(b) if hasattr(b, "__iter__") else [b],
                      **level_of_bounds(confidence, predict)})
    parts = [toml.table("", {"title": title or f"Degradation: {y} along {x}", "model": "formula"}), toml.table("data", {"file": "data", **({"unused": unused} if unused else {})}),
             toml.table("data.columns", rows), *([] if process else [toml.table("formula", {"path": formula})]),
             toml.table(f"likelihood.{columns.name(y)}", slots), toml.table("prior", known.laws, known.comments), effects,
             toml.table("predict", {**asked, **(predict or {})})]
    table, only = columns.table(unused)
    study = Study._made("\n".join(parts), {"data": (table, data, only)}, {
        f"data.columns.{columns.name(y)}": "y", f"data.columns.{name}": "x", "predict.limit": "limit", "predict.b_lives": "b",
        "predict.credible_level": "confidence"}, {"limit": limit, "confidence": confidence})
    return study.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
