"""Lives in one line: a distribution, groups, and stresses that shorten a life."""

from collections.abc import Mapping

from . import toml
from .columns import Columns, modes_of, status_of
from .errors import InputError
from .fit_options import fits
from .life_families import families, family_keys, population_names, population_table, refuse_beside, share_keys, threshold_keys
from .preset_study import classical_key, level_of_bounds
from .proposed import Priors, half_normal, lognormal, normal, quantity_text, rounded_up
from .study import Study

_harsh = "the harshest tested"
_stresses = ("arrhenius", "eyring", "inverse power")


def _stress(columns, heading, model, laws):
    """(factor of the life, constants, parameter of the stress, its default and why)"""
    name = columns.name(heading)
    values = columns.numbers(heading)
    unit = columns.unit(heading)
    if len(values) < len(columns.words(heading)):
        raise InputError(f"stress: column '{heading}' has {len(values)} numbers in {len(columns.words(heading))} rows; it needs one in each row")
    if values.min() == values.max():
        raise InputError(f"stress: column '{heading}' has one value in all rows; what does not differ says nothing of a stress: leave it out")
    if model == "inverse power":
        if values.min() <= 0:
            raise InputError(f"stress: column '{heading}' has the value {values.min():g}; an inverse power needs values above 0")
        return (f" * ({name}/{name}_ref)^-{name}_power", {f"{name}_ref": quantity_text(values.max(), unit)}, f"{name}_power",
                normal(5.0, 5.0), "exponent; a higher one shortens the life more")
    if not unit:
        raise InputError(f"stress: {model} needs a temperature, and column '{heading}' ({values.min():g} to {values.max():g}) has no unit: "
                         f"units={{'{heading}': 'degC'}} if these are degrees Celsius, units={{'{heading}': 'K'}} if they are kelvin")
    energy = "energy" if "energy" not in laws else f"{name}_energy"
    before = f" * {name}_ref/{name}" if model == "eyring" else ""
    return (f"{before} * exp({energy}/boltzmann * (1/{name} - 1/{name}_ref))",
            {"boltzmann": "8.617333262e-5 eV/K", f"{name}_ref": quantity_text(values.max(), unit)}, energy,
            normal(0.7, 0.3, "eV"), "activation energy of aging processes")


def _conditions(columns, by, stress, given):
    """[predict] given: what the caller states, else the first group and the mildest stresses."""
    given = {columns.heading(key, "given"): value for key, value in (given or {}).items()}
    conditions = {}
    for heading in ([by] if by else []) + list(stress):
        value = given.pop(heading, None)
        if heading == by:
            levels = columns.levels(by)
            if not levels:
                raise InputError(f"by: column '{by}' is empty; it names the group of each row")
            value = levels[0] if value is None else str(value)
            if value not in levels:
                raise InputError(f"given: column '{by}' has no '{value}' ({', '.join(levels[:10])})")
        else:
            unit = columns.unit(heading)
            if value is None:
                value = quantity_text(columns.numbers(heading).min(), unit)
            elif isinstance(value, Mapping):  # a distribution over the units
                conditions[columns.name(heading)] = toml.distribution(value, f"given.{heading}")
                continue
            elif not isinstance(value, str) and not hasattr(value, "magnitude"):
                value = quantity_text(value, unit)
        conditions[columns.name(heading)] = toml.quantity(value, f"given.{heading}")
    if given:
        raise InputError(f"given: '{next(iter(given))}' is no condition of the life; by and stress name those")
    return conditions


def _lives(columns, life):
    """(what [data.columns] says, name of the life, its values in rising order, unit)"""
    import numpy

    if isinstance(life, str):
        heading = columns.take(life, "life")
        values = numpy.sort(columns.numbers(heading))
        return {columns.name(heading): columns.entry(heading)}, columns.name(heading), values, columns.unit(heading)
    if not isinstance(life, (tuple, list)) or len(life) != 2:
        raise InputError(f"life is {life!r}; it is the heading of a column, or the two of an interval: ('last_ok', 'first_failed')")
    lower, upper = (columns.take(each, "life") for each in life)
    columns.open_ends(lower, upper)
    units = columns.unit(lower), columns.unit(upper)
    if units[0] != units[1]:
        raise InputError(f"life: column '{lower}' is in {units[0] or 'plain numbers'} and '{upper}' in {units[1] or 'plain numbers'}; "
                         "both ends need the same unit")
    ends = numpy.sort(numpy.concatenate([columns.numbers(lower), columns.numbers(upper)]))
    return {"lower": columns.entry(lower), "upper": columns.entry(upper)}, "life", ends, units[0]


def _shape(shape, by, unit, mode, populations):
    """"shared" or "separate", the default where it is None."""
    if shape not in (None, "shared", "separate"):
        raise InputError(f"shape is {shape!r}; it is 'shared', one for all groups, failure modes or subpopulations, or 'separate'")
    if shape == "separate" and by is None and mode is None and not populations:
        raise InputError("shape='separate' needs by or mode: the column of the groups or failure modes that differ; or subpopulations")
    given = [name for name, value in (("by", by), ("unit", unit), ("mode", mode)) if value is not None]
    if len(given) > 1:
        why = {"by unit": "each group has its own scale, which then has no random effect",
               "by mode": "each failure mode has its own scale, for all groups", "unit mode": "failure modes have no random effects"}
        raise InputError(f"{given[0]} and {given[1]}: {why[' '.join(given[:2])]}; leave one out")
    return shape or ("shared" if mode is None and not populations else "separate")


@fits
def life(data, life, *, event=None, entry=None, count=None, family="weibull", standard=None, threshold=False, share_defective=False,
         share_dead_on_arrival=False, subpopulations=None, by=None, unit=None, mode=None, shape=None, stress=None, given=None, units=None,
         priors=None, b=(1, 10, 50), confidence=0.9, classical=False, predict=None, unused=None, title=None, seed=None,
         method=None, chains=None, warmup=None, draws=None, threads=0, report=True, progress=None):
    """Fit a distribution of life to a table: censored, truncated, by group, under stress, of several subpopulations.

    Parameters
    ----------
    data : table
        A row for each item, or for ``count`` equal ones: whatever ``wearwell.table`` takes.
    life : str or (str, str)
        Column of the life, failed or not; or the two columns of an interval in which it ended (an empty or infinite upper end:
        it still runs, an empty lower end: it failed before the upper end).
    event : str or dict, optional
        Column that says how each life ended: True or 1 where it failed, False or 0 where it still ran; or words, such as
        "failed", "censored", "suspended", "runout", "left", "interval". A dict says what codes and words mean:
        ``{"column": "censored", "failure": 0}``. Without it all lives ended with a failure.
    entry : str, optional
        Column of the age at which observation began (left truncation).
    count : str, optional
        Column of the number of equal items in a row.
    family : {"weibull", "exponential", "lognormal", "loglogistic", "frechet", "gamma", "inverse-gaussian", "birnbaum-saunders", \
            "generalized-gamma", "exponentiated-weibull", "log10-normal", "log-location-scale"}
        Distribution of the lives.
    standard : {"smallest extreme value", "normal", "logistic", "largest extreme value"}, optional
        Of family "log-location-scale", and needed there: the distribution of the standardized logarithm.
    threshold : bool, str, float or pint quantity
        Life before which no part fails (three-parameter Weibull, shifted lognormal): True for a parameter with a prior, or a known
        one. It is the same for all groups, modes, subpopulations and stresses; scales count from it on.
    share_defective : bool or float
        Share of the parts that can fail at all (limited failure population, cure model): True for a parameter with a prior, or a
        known share. Lives that fewer parts reach are infinite.
    share_dead_on_arrival : bool or float
        Share of the parts that are dead at life 0; a life of 0 is such a part.
    subpopulations : {2, 3, 4} or sequence of str, optional
        Number of subpopulations of which a part is one, unknown which (mixture), or their names in the order of their median lives;
        two are "early" and "late". Each has its own scale, and a share; the last has the rest.
    by : str, optional
        Column of groups, such as suppliers. Each group has its own scale.
    unit : str, optional
        Column of batches, or of units with several lives, whose lives differ at random: the scale has a random effect
        (lognormal). Predicted lives are those of an item of any batch; ``fit.life(unit="B3")`` has those of one.
    mode : str or dict, optional
        Column of the failure mode of each failure. Each mode has its own scale, and a part fails by the mode whose life ends
        first (competing risks). "A|B" is one of the two, "unknown" any. Without ``event`` a word such as "censored" in this
        column marks what still ran; ``{"column": "cause", "runout": 0}`` names another one.
    shape : {"shared", "separate"}, optional
        Whether all groups, modes or subpopulations have one shape, or each has its own. By default groups share it, and modes and
        subpopulations do not.
    stress : dict of str to str, optional
        By column "arrhenius" or "eyring" (temperatures, whose unit must be stated) or "inverse power" (voltage, load,
        humidity): how a life shortens. Groups share the effect of a stress.
    given : dict, optional
        Conditions of the lives that are predicted; plain numbers in the unit of their column. By default the first group and
        the mildest stresses of the table. A stress that differs from unit to unit is a dict: ``{"distribution": "normal",
        "mean": "25 degC", "sd": "6 K"}`` or ``{"values": ["20 degC", "35 degC"], "shares": [0.7, 0.3]}``.
    units : dict, optional
        Unit of columns: ``{"hours": "h", "T": "degC"}``. A heading may have it: "T [degC]". A life without one is a number.
    priors : dict of str to dict, or "flat", optional
        Priors that replace defaults, by parameter. With "flat" nothing is known of any parameter, and the mode of the
        posterior, ``fit.results["mode"]``, is the maximum likelihood estimate. Defaults are weak. Scale (``characteristic``, ``median_life`` or
        ``mean_life``; ``life_ref``, at the harshest stresses, where there is a stress): lognormal, log_sd 2, median the
        largest life (with stress the middle one) rounded up to 1, 2 or 5 times a power of ten. If few parts failed, the
        median is what the time on test per failure gives with slope 1.5, and log_sd grows with its distance from the
        largest life. ``slope`` of weibull:
        lognormal, median 1.5, log_sd 0.7; shapes of other families have the same spread of the logarithm of life, ``lambda`` is
        normal, 0, sd 1.5, and ``exponent`` lognormal, median 1, log_sd 0.7. ``threshold``: half-normal, scale the smallest life
        rounded up. ``share_defective``, ``share_dead_on_arrival`` and ``share_NAME`` of each subpopulation but the last: uniform.
        ``energy``: normal, 0.7 eV, sd 0.3 eV; ``NAME_power``: normal, 5, sd 5. ``SCALE_scatter`` of ln life between units,
        such as ``characteristic_scatter``: half-normal, scale 1.
    b : float or sequence of float
        Percentages of B-lives.
    confidence : float
        Probability with which their lower bounds are exceeded.
    classical : bool
        Whether ``fit.results["classical"]`` has the estimates of frequentist software beside the posterior: maximum likelihood
        of the data alone with normal (Fisher) and likelihood-ratio bounds, median rank regression, Kaplan-Meier or Turnbull.
    predict : dict, optional
        Further keys of ``[predict]`` of a formula study, such as ``{"survival_to": "1000 h"}``.
    unused : str or sequence of str, optional
        Columns that look like an event, a count or a unit and are none.
    <what all fits share>
        For a column that is not used and looks like a number of equal items or a label of units with several lives.

    Examples
    --------
    Two suppliers; what still ran counts as such:

    >>> import wearwell as ww
    >>> pumps = {"hours": [312, 480, 510, 640, 700, 700, 150, 210, 260, 330, 420, 700],
    ...          "failed": [True, True, True, True, False, False, True, True, True, True, True, False],
    ...          "supplier": ["A"] * 6 + ["B"] * 6}
    >>> fit = ww.life(pumps, "hours", event="failed", by="supplier", units={"hours": "h"}, method="exact", report=False)
    >>> fit.parameters[["unit", "q50"]].round(1)
                      unit    q50
    name
    characteristic[A]    h  765.4
    characteristic[B]    h  448.8
    slope                1    1.7

    An Arrhenius test; lives at the temperature of use are those of a new device:

    >>> ovens = {"T": [150] * 4 + [175] * 4 + [200] * 4, "hours": [3200, 4100, 5000, 5000, 1100, 1500, 1900, 2600, 410, 560, 700, 880],
    ...          "status": ["failed"] * 2 + ["censored"] * 2 + ["failed"] * 8}
    >>> fit = ww.life(ovens, "hours", event="status", family="exponential", stress={"T": "arrhenius"}, given={"T": 100},
    ...               units={"T": "degC", "hours": "h"}, method="exact", report=False)
    >>> fit.parameters.loc["energy", ["unit", "mean"]].tolist()
    ['eV', 0.7900...]

    Two failure modes; each mode's mean life, and the B10 life of the part:

    >>> parts = {"hours": [210, 340, 560, 610, 780, 900, 950, 1000], "cause": ["seal", "wear", "wear", "seal", "wear", "censored", "wear", "censored"]}
    >>> fit = ww.life(parts, "hours", mode="cause", family="exponential", units={"hours": "h"}, method="exact", report=False)
    >>> list(fit.parameters.index)
    ['mean_life[seal]', 'mean_life[wear]']

    Few parts can fail at all: the share that can, and how early they do:

    >>> boards = {"hours": [12, 40, 95, 180, 420, 2000], "failed": [1, 1, 1, 1, 1, 0], "count": [1, 1, 1, 1, 1, 95]}
    >>> fit = ww.life(boards, "hours", event="failed", count="count", share_defective=True, units={"hours": "h"}, method="exact", report=False)
    >>> fit.parameters["q50"].index.tolist()
    ['characteristic', 'slope', 'share_defective']
    """
    of_family = family_keys(family, standard)
    populations = population_names(subpopulations)
    shares = (("share_defective", share_defective), ("share_dead_on_arrival", share_dead_on_arrival))
    refuse_beside(shares, populations, (("by", by), ("unit", unit), ("mode", mode)))
    shape = _shape(shape, by, unit, mode, populations)
    scale, slots, shapes = families[family]
    base = "life_ref" if stress else scale
    names = {"life", "life_ref", "energy", "mode", "subpopulation", "threshold", *(each[0] for each in shares), scale, f"{base}_scatter",
             *(each[0] for each in shapes)}
    columns = Columns(data, units, names - {"life"})
    rows, measured, values, of = _lives(columns, life)
    if isinstance(life, str):
        columns.require_numbers(columns.heading(life, "life"), "life")
    if not len(values) or values[-1] <= 0:
        raise InputError(f"life: {life!r} has no value above 0")
    if event is not None:
        rows["status"] = status_of(columns, event)
    for key, column in (("entry", entry), ("count", count)):
        if column is not None:
            rows[key] = columns.entry(columns.take(column, key))
    if by is not None:
        by = columns.take(by, "by")
        rows[columns.name(by)] = by
    if unit is not None:
        unit = columns.take(unit, "unit")
        rows[columns.name(unit)] = unit
    modes = modes_of(columns, mode)
    if mode is not None:
        rows["mode"] = modes.pop("heading")
    stress = {columns.take(key, "stress"): model for key, model in (stress or {}).items()}
    known = Priors(priors)
    least = values[len(values) // 2] if stress else values[-1]
    size, log_sd, why = columns.life_size({**rows, **({} if isinstance(life, (tuple, list)) else {"life": rows[measured]})}, modes, least, stress)
    of_what = "middle life" if stress else "largest life"
    known.add(base, lognormal(rounded_up(size), of, log_sd), f"{why}; about the {of_what if size == least else 'life with slope 1.5'}, rounded up")
    if unit:
        known.add(f"{base}_scatter", half_normal(1.0), "most units are within a factor of ten")
    index = f"[{columns.name(by)}]" if by else "[mode]" if mode is not None else "[subpopulation]" if populations else ""
    formula, constants = base + index, {}
    for heading, model in stress.items():
        model = "inverse power" if model == "inverse-power" else model
        if model not in _stresses:
            raise InputError(f"stress: {heading} is {model!r}; it is {', '.join(_stresses)}")
        rows[columns.name(heading)] = columns.entry(heading)
        factor, refs, parameter, default, reason = _stress(columns, heading, model, known.laws)
        formula, constants = formula + factor, {**constants, **refs}
        known.add(parameter, default, reason)
    own = index if shape == "separate" else ""
    for name, default, reason in shapes:
        known.add(name, default, reason)
        slots = {slot: text.replace(name, name + own) for slot, text in slots.items()}
    further = {**threshold_keys(threshold, values[values > 0][0], of, known, constants), **share_keys(shares, known)}
    of_populations = population_table(populations, known) if populations else {}
    known.require_used()
    unused = [columns.heading(each, "unused") for each in ([unused] if isinstance(unused, str) else unused or ())]
    columns.warn_of_idle(unused, counts=count is None, units=unit is None, instead="by" if by else "mode" if mode is not None else "")
    asked = {**({"given": conditions} if (conditions := _conditions(columns, by, stress, given)) else {}),
             "b_lives": list(b) if hasattr(b, "__iter__") else [b], **level_of_bounds(confidence, predict),
             **classical_key(classical), **(predict or {})}
    place = scale if stress else formula
    parts = [toml.table("", {"title": title or f"Life: {life if isinstance(life, str) else ' to '.join(life)}", "model": "formula"}),
             toml.table("data", {"file": "data", **({"unused": unused} if unused else {})}), toml.table("data.columns", rows)]
    if constants:
        parts.append(toml.table("constants", constants, {key: _harsh for key in constants if key.endswith("_ref")}))
    if stress:
        parts.append(toml.table("formula", {scale: formula}))
    if unit:
        parts.append(toml.table(f"random_effects.{columns.name(unit)}", {base: {"distribution": "lognormal", "log_sd": f"{base}_scatter"}}))
    if mode is not None:
        parts.append(toml.table("failure_modes", {"column": "mode", **modes}))
    if populations:
        parts.append(toml.table("subpopulations", of_populations))
    parts += [toml.table(f"likelihood.{measured}", {**of_family, **{slot: text.replace("{}", place) for slot, text in slots.items()}, **further}),
              toml.table("prior", known.laws, known.comments), toml.table("predict", asked)]
    table, only = columns.table(unused)
    study = Study._made("\n".join(parts), {"data": (table, columns.data, only)}, {
        "data.columns.status": "event", "data.columns.mode": "mode", "failure_modes": "mode", f"data.columns.{measured}": "life", "predict.b_lives": "b", "predict.credible_level": "confidence",
        "predict.given": "given", "predict.classical": "classical", "subpopulations.names": "subpopulations", "constants.threshold": "threshold",
        **{f"likelihood.{measured}.{key}": key for key in further}})
    return study.fit(seed, method=method, chains=chains, warmup=warmup, draws=draws, threads=threads, report=report, progress=progress)
