"""Wear of clutch linings in one line: what calling ``wearwell.clutch`` does."""

from . import toml
from .data import require_no_truths, table_of
from .errors import InputError
from .fit_options import fits
from .preset_study import percentages
from .study import Study


@fits
def clutch(design, cycles, weighings, *, density, depth, area, balance_sd, traces=None, points=None, levels=None, missing_cycles="refuse",
           search=None, replicates=None, units=None, title=None, threads=0, report=True, progress=None):
    """Fit the wear model of a dry clutch to a campaign: points of the design, closings, and weighings of the plates.

    ``wearwell.clutch.CycleSum`` then sums the wear of further closings.

    Parameters
    ----------
    design : table
        Points of the campaign: point, role, slip_speed, torque, temperature, closing_time.
    cycles : table
        Every closing of every plate: plate, cycle, slip_speed, torque, temperature, closing_time, energy.
    weighings : table
        Weighings of the plates: plate, cycle, block, mass.
    density, depth, area : str or pint quantity
        Of the lining: "2.2 g/cm^3"; "1 mm", the depth at which it is worn out; "100 cm^2".
    balance_sd : str or pint quantity
        Standard deviation of one weighing: "1 mg".
    traces : table, optional
        Speed, torque and temperature over some closings.
    points : dict of dict, optional
        Duties whose life is asked for, by name: ``{"hill": {"slip_speed": "2800 rpm", "torque": "75 N m", "temperature":
        "240 degC", "closing_time": "3.4 s"}}``.
    levels : float or sequence of float, optional
        Wear levels, as shares of the volume that may wear.
    missing_cycles : {"refuse", "fill"}
        What to do about gaps in the log of closings.
    search : dict, optional
        Exponents that are tried: ``{"lowest": 0.1, "highest": 3, "step": 0.1}``.
    replicates : int, optional
        Simulated repetitions of the whole fit, for the full interval; default 50, 0 for none.
    units : dict of dict, optional
        Unit of columns by table: ``{"cycles": {"torque": "N m"}}``. Headings may have them.
    title : str, optional
        Title of the study.
    <options of the run>

    Returns
    -------
    Fit
        The fit. ``fit.study.toml`` is the study as a file; ask ``fit.trusted`` before you use a number.

    Raises
    ------
    InputError
        If a table lacks a column or a value, or a quantity has the wrong unit.

    Warns
    -----
    CheckWarning
        For each check that warns or fails.

    Examples
    --------
    The folder campaign is that of ``wearwell clutch simulate``:

    >>> import wearwell as ww
    >>> fit = ww.clutch("campaign/design.csv", "campaign/cycles.csv", "campaign/weighings.csv", density="2.2 g/cm^3", depth="1 mm",
    ...                 area="100 cm^2", balance_sd="1 mg", replicates=0, search={"lowest": 0.4, "highest": 1.2, "step": 0.4}, report=False)
    >>> fit.results["model"]
    'clutch-wear'
    """
    tables = {"design": design, "cycles": cycles, "weighings": weighings, **({} if traces is None else {"traces": traces})}
    units = {name: toml.mapping(each, f"units: {name}", "{'torque': 'N m'}")
             for name, each in toml.mapping(units, "units", "{'cycles': {'torque': 'N m'}}").items()}
    unknown = next((key for key in units if key not in tables), None)
    if unknown:
        raise InputError(f"units: '{unknown}' is no table; tables are {', '.join(tables)}, as units={{'cycles': {{'torque': 'N m'}}}}")
    if not isinstance(missing_cycles, str):
        raise InputError(f"missing_cycles is {missing_cycles!r}; it is 'refuse' or 'fill'")
    data = {**{name: name for name in tables}, **({} if missing_cycles == "refuse" else {"missing_cycles": missing_cycles})}
    search = toml.mapping(search, "search", "{'lowest': 0.1, 'highest': 3, 'step': 0.1}")
    parts = [toml.table("", {"title": title or "Clutch wear", "model": "clutch-wear"}), toml.table("data", data),
             toml.table("lining", {"density": toml.quantity(density, "density"), "depth": toml.quantity(depth, "depth"),
                                    "area": toml.quantity(area, "area")}),
             toml.table("balance", {"sd": toml.quantity(balance_sd, "balance_sd")})]
    if search:
        parts.append(toml.table("search", search))
    if replicates is not None:
        parts.append(toml.table("uncertainty", {"replicates": replicates}))
    if levels is not None:
        parts.append(toml.table("life", {"levels": percentages(levels)}))
    for name, duty in toml.mapping(points, "points", "{'hill': {'slip_speed': '2800 rpm', ...}}").items():
        quoted = toml.value(str(name), "points")
        duty = toml.mapping(duty, f"points: {name}", "{'slip_speed': '2800 rpm', ...}")
        parts.append(toml.table(f"life.points.{quoted}", {key: toml.quantity(each, f"points.{name}.{key}") for key, each in duty.items()}))
    given = {name: (table_of(each, name, units.get(name)), each, None) for name, each in tables.items()}
    for name, (table, _, _) in given.items():
        require_no_truths(table, name)
    made = Study._made("\n".join(parts), given, {"lining.density": "density", "lining.depth": "depth", "lining.area": "area",
                                                 "balance.sd": "balance_sd", "data.missing_cycles": "missing_cycles", "life.levels": "levels", "life.points": "points",
                                                 "uncertainty.replicates": "replicates"})
    made._given = {name: (each, units.get(name) or {}, None) for name, each in tables.items()}
    return made.fit(threads=threads, report=report, progress=progress)
