import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal, NamedTuple, TypeVar

import pandas

from . import plan as plan
from .clutch import CycleSum as _CycleSum

__all__: list[str]
__version__: str

_Path = str | os.PathLike[str]
_Quantity = Any  # a number, "5 mm^3", or a pint quantity
_Prior = dict[str, Any]
_Progress = bool | Callable[[str, int, int, float], object] | None
_Method = Literal["nuts", "exact", "metropolis"] | None
_F = TypeVar("_F", bound="Fit")

_Event = str | Mapping[str, Any] | None
_Priors = Mapping[str, _Prior] | None
_PriorsOrFlat = Mapping[str, _Prior] | Literal["flat"] | None
_Units = Mapping[str, Any] | None
_Percentages = float | Sequence[float]
_Given = Mapping[str, Any] | pandas.DataFrame | None

class InputError(ValueError): ...
class MissingFileError(InputError, FileNotFoundError): ...
class MachineError(OSError, RuntimeError): ...
class NotTrusted(RuntimeError): ...
class CheckWarning(UserWarning): ...

class Check(NamedTuple):
    name: str
    verdict: str
    detail: str
    advice: str

class Fit:
    study: Study
    results: dict[str, Any]
    checks: list[Check]
    trusted: bool
    seed: int
    def require_trusted(self: _F) -> _F: ...
    @property
    def summary(self) -> pandas.DataFrame: ...
    @property
    def parameters(self) -> pandas.DataFrame: ...
    @property
    def predictions(self) -> pandas.DataFrame: ...
    @property
    def quantities(self) -> pandas.DataFrame: ...
    @property
    def lives(self) -> pandas.DataFrame: ...
    @property
    def draws(self) -> pandas.DataFrame: ...
    @property
    def sample_stats(self) -> pandas.DataFrame: ...
    @property
    def tables(self) -> dict[str, pandas.DataFrame]: ...
    def arrow(self, name: str = ...) -> ArrowTable: ...
    def ask(self, predict: Mapping[str, Any], level: float = ...) -> dict[str, Any]: ...
    def predict(
        self,
        new: pandas.DataFrame | Mapping[str, Any],
        level: float = ...,
        kind: Literal["mean", "next", "unit"] = ...,
        *,
        along: str | None = ...,
    ) -> pandas.DataFrame: ...
    def life(
        self,
        limit: _Quantity | Mapping[str, _Quantity] | None = ...,
        b: float | Sequence[float] = ...,
        confidence: float = ...,
        unit: str | None = ...,
        survived: _Quantity | None = ...,
        *,
        along: str | None = ...,
        given: Mapping[str, _Quantity] | None = ...,
    ) -> pandas.DataFrame: ...
    def survival_function(self, times: _Quantity | Sequence[_Quantity], given: _Given = ...) -> pandas.DataFrame: ...
    def hazard(self, times: _Quantity | Sequence[_Quantity], given: _Given = ...) -> pandas.DataFrame: ...
    def percentile(self, p: float | str | Sequence[float | str], given: _Given = ..., confidence: float = ...) -> pandas.DataFrame: ...
    def conditional(
        self, survived: _Quantity, b: _Percentages = ..., given: _Given = ..., confidence: float = ...
    ) -> pandas.DataFrame: ...
    def against(
        self, other: Fit | _Path, *, horizon: _Quantity | None = ..., confidence: float | str = ..., at: str | None = ...
    ) -> LivesAgainst: ...
    def residuals(self, kind: Literal["score", "cox-snell"] = ...) -> pandas.DataFrame: ...
    def compare(
        self,
        *others: Fit | _Path,
        names: Sequence[str] | None = ...,
        families: str | Sequence[str] | None = ...,
        threads: int = ...,
        progress: _Progress = ...,
    ) -> Comparison: ...
    def update(
        self,
        data: Any,
        repeated: Literal["once", "another"] | None = ...,
        *,
        threads: int = ...,
        report: bool = ...,
        progress: _Progress = ...,
    ) -> Fit: ...
    def track(self, unit: str | None = ..., *, new: bool = ...) -> UnitTracker: ...
    def backtest(self, readings: Any, lives: Any) -> Backtest: ...
    def damage(
        self,
        loads: Any,
        *,
        column: str | None = ...,
        units: Any = ...,
        method: Literal["four-point", "three-point"] = ...,
        residual: Literal["half", "repeat"] = ...,
        time: str | None = ...,
        scale: _Quantity | None = ...,
        rule: Literal["elementary", "original", "haibach", "liu-zenner"] | None = ...,
        knee: _Quantity | None = ...,
        damage_sum: float | str = ...,
        block: _Quantity | None = ...,
        b: _Percentages = ...,
        confidence: float = ...,
        progress: _Progress = ...,
    ) -> Damage: ...
    def design(
        self,
        *others: Fit | _Path,
        names: Sequence[str] | None = ...,
        stress: _Quantity | Sequence[_Quantity] | None = ...,
        mean_stress: _Quantity | None = ...,
        stress_ratio: float | None = ...,
        reliability: float | None = ...,
        confidence: float | None = ...,
        progress: _Progress = ...,
    ) -> DesignCurves: ...
    def export_c(self, folder: _Path, *, name: str = ..., unit: str | None = ..., lines: int | None = ...) -> str: ...
    def export_sql(
        self,
        dialect: Literal["duckdb", "postgresql", "clickhouse"],
        table: str,
        *,
        value: str | None = ...,
        unit: str | None = ...,
        columns: Mapping[str, str] | str | Sequence[str] | None = ...,
        keep: str | Sequence[str] | None = ...,
        prefix: str = ...,
        draws: int = ...,
        part: Literal["all", "setup", "query"] = ...,
    ) -> str: ...
    @property
    def plots(self) -> list[str]: ...
    def plot(self, name: str | None = ..., ax: Any = ...) -> Any: ...
    def write(self, folder: _Path) -> None: ...
    def report(self, path: _Path) -> None: ...
    def to_netcdf(self, path: _Path) -> None: ...
    def to_datatree(self) -> Any: ...
    def _repr_html_(self) -> str: ...
    def __copy__(self: _F) -> _F: ...
    def __deepcopy__(self: _F, memo: Any) -> _F: ...

class Plot:
    name: str
    figures: list[str]
    def __init__(self, name: str, figures: Sequence[dict[str, Any]]) -> None: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_html(self) -> str: ...
    def draw(self, ax: Any) -> Any: ...

# Modules that can be called, which mypy has no other words for.
class _Bearing:
    def __call__(
        self,
        data: Any,
        depth: str,
        *,
        contact: str,
        radius: _Quantity,
        clearance: _Quantity,
        unit: str | None = ...,
        revolutions: str | None = ...,
        time: str | None = ...,
        speed: _Quantity | None = ...,
        pressure: _Quantity | None = ...,
        force: _Quantity | None = ...,
        length: _Quantity | None = ...,
        limit: _Quantity | None = ...,
        risk: _Quantity | None = ...,
        at: _Quantity | Sequence[_Quantity] | None = ...,
        depth_error: _Quantity | None = ...,
        family: str = ...,
        count: str | None = ...,
        units: _Units = ...,
        priors: _Priors = ...,
        b: _Percentages = ...,
        confidence: float = ...,
        predict: Mapping[str, Any] | None = ...,
        unused: str | Sequence[str] | None = ...,
        title: str | None = ...,
        seed: int | None = ...,
        method: _Method = ...,
        chains: int | None = ...,
        warmup: int | None = ...,
        draws: int | None = ...,
        threads: int = ...,
        report: bool = ...,
        progress: _Progress = ...,
    ) -> Fit: ...
    def rate(self, contact: str, *, unit: str | None = ..., draws: int = ..., seed: int = ..., **inputs: Any) -> dict[str, Any]: ...
    def depth(
        self, contact: str, *, unit: str | None = ..., limit: str | None = ..., draws: int = ..., seed: int = ..., **inputs: Any
    ) -> dict[str, Any]: ...
    def pressure(self, contact: str, *, unit: str | None = ..., draws: int = ..., seed: int = ..., **inputs: Any) -> dict[str, Any]: ...
    def length(self, contact: str, *, unit: str | None = ..., draws: int = ..., seed: int = ..., **inputs: Any) -> dict[str, Any]: ...
    def life(self, contact: str, *, unit: str | None = ..., draws: int = ..., seed: int = ..., **inputs: Any) -> dict[str, Any]: ...

class _Clutch:
    CycleSum = _CycleSum
    def __call__(
        self,
        design: Any,
        cycles: Any,
        weighings: Any,
        *,
        density: _Quantity,
        depth: _Quantity,
        area: _Quantity,
        balance_sd: _Quantity,
        traces: Any = ...,
        points: Mapping[str, Mapping[str, _Quantity]] | None = ...,
        levels: float | Sequence[float] | None = ...,
        missing_cycles: Literal["refuse", "fill"] = ...,
        search: Mapping[str, float] | None = ...,
        replicates: int | None = ...,
        units: Mapping[str, Mapping[str, Any]] | None = ...,
        title: str | None = ...,
        threads: int = ...,
        report: bool = ...,
        progress: _Progress = ...,
    ) -> Fit: ...

bearing: _Bearing
clutch: _Clutch

class ArrowTable:
    def __init__(self, columns: Sequence[tuple[str, str, Any]]) -> None: ...
    @property
    def columns(self) -> list[str]: ...
    def __len__(self) -> int: ...
    def __arrow_c_stream__(self, requested_schema: object = ...) -> Any: ...

def arrow(frame: pandas.DataFrame, units: Mapping[str, str] | None = ...) -> ArrowTable: ...

class Study:
    toml: str
    def __init__(
        self,
        formula: str | Mapping[str, str],
        data: Any,
        *,
        priors: Mapping[str, _Prior],
        units: Mapping[str, Any] | None = ...,
        unit: str | None = ...,
        random_effects: str | Sequence[str] | Mapping[str, Any] | None = ...,
        family: str = ...,
        scatter: str | float | Mapping[str, Any] | None = ...,
        likelihood: Mapping[str, Mapping[str, Any]] | None = ...,
        constants: Mapping[str, _Quantity] | None = ...,
        predict: Mapping[str, Any] | None = ...,
        sampler: Mapping[str, Any] | None = ...,
        title: str | None = ...,
        status: str | Mapping[str, Any] | None = ...,
        unused: str | Sequence[str] | None = ...,
    ) -> None: ...
    @classmethod
    def from_toml(
        cls,
        text: str,
        data: Mapping[str, Any] | None = ...,
        *,
        units: Mapping[str, Mapping[str, Any]] | None = ...,
        folder: str = ...,
        name: str = ...,
    ) -> Study: ...
    @classmethod
    def from_file(cls, path: _Path) -> Study: ...
    def description(self) -> str: ...
    def fit(
        self,
        seed: int | None = ...,
        *,
        method: _Method = ...,
        chains: int | None = ...,
        warmup: int | None = ...,
        draws: int | None = ...,
        threads: int = ...,
        report: bool = ...,
        progress: _Progress = ...,
    ) -> Fit: ...

def fit(
    study: Study | _Path,
    seed: int | None = ...,
    *,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def life(
    data: Any,
    life: str | Sequence[str],
    *,
    event: _Event = ...,
    entry: str | None = ...,
    count: str | None = ...,
    family: str = ...,
    standard: Literal["smallest extreme value", "normal", "logistic", "largest extreme value"] | None = ...,
    threshold: bool | _Quantity = ...,
    share_defective: bool | float = ...,
    share_dead_on_arrival: bool | float = ...,
    subpopulations: Literal[2, 3, 4] | Sequence[str] | None = ...,
    by: str | None = ...,
    unit: str | None = ...,
    mode: str | Mapping[str, Any] | None = ...,
    shape: Literal["shared", "separate"] | None = ...,
    stress: Mapping[str, str] | None = ...,
    given: Mapping[str, _Quantity] | None = ...,
    units: _Units = ...,
    priors: _PriorsOrFlat = ...,
    b: _Percentages = ...,
    confidence: float = ...,
    classical: bool = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def degradation(
    data: Any,
    y: str,
    x: str,
    *,
    unit: str | Literal[False] | None = ...,
    limit: _Quantity | None = ...,
    path: Literal["line", "power"] = ...,
    family: str = ...,
    starts_at_zero: bool | None = ...,
    units: _Units = ...,
    priors: _PriorsOrFlat = ...,
    b: _Percentages = ...,
    confidence: float = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def sn(
    data: Any,
    stress: str,
    life: str,
    *,
    event: _Event = ...,
    stress_ratio: str | float | None = ...,
    mean_stress: str | float | None = ...,
    correction: str | None = ...,
    curve: str = ...,
    fatigue_limit: str = ...,
    family: str = ...,
    scatter: Literal["constant", "grows"] = ...,
    count: str | None = ...,
    label: str | None = ...,
    units: _Units = ...,
    priors: _Priors = ...,
    b: _Percentages = ...,
    confidence: float = ...,
    at: _Quantity | Sequence[_Quantity] | Mapping[str, Any] | None = ...,
    survival_to: _Quantity | Sequence[_Quantity] | None = ...,
    required_life: _Quantity | Sequence[_Quantity] | None = ...,
    reliability: _Quantity | Sequence[_Quantity] | None = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def staircase(
    data: Any,
    stress: str,
    event: str | Mapping[str, Any],
    *,
    count: str | None = ...,
    limit_family: str = ...,
    units: _Units = ...,
    priors: _Priors = ...,
    reliability: _Quantity | Sequence[_Quantity] = ...,
    confidence: float = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def joint(
    data: Any,
    volume: str,
    cycles: str,
    *,
    work_per_cycle: _Quantity | None = ...,
    work: str | None = ...,
    force: str | None = ...,
    slip: str | None = ...,
    limit: _Quantity | None = ...,
    risk: _Quantity | None = ...,
    at: _Quantity | Sequence[_Quantity] | None = ...,
    family: str = ...,
    count: str | None = ...,
    units: _Units = ...,
    priors: _Priors = ...,
    b: _Percentages = ...,
    confidence: float = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    stages: bool = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def repairable(
    data: Any,
    age: str,
    *,
    unit: str,
    event: str | Mapping[str, Any] | None = ...,
    start: str | None = ...,
    count: str | None = ...,
    grouped: bool = ...,
    process: Literal["power_law", "renewal", "phases"] = ...,
    end: Literal["row", "last failure"] | None = ...,
    rounding: _Quantity | None = ...,
    phase_ends: _Quantity | Sequence[_Quantity] | None = ...,
    reference_age: _Quantity | None = ...,
    mode: str | None = ...,
    fixes: Mapping[str, Any] | None = ...,
    at: _Quantity | Sequence[_Quantity] | None = ...,
    ahead: _Quantity | Sequence[_Quantity] | None = ...,
    units: _Units = ...,
    priors: _Priors = ...,
    classical: bool = ...,
    predict: Mapping[str, Any] | None = ...,
    unused: str | Sequence[str] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def returns(
    data: Any,
    *,
    sold: str | None = ...,
    quantity: str | None = ...,
    returned: str | None = ...,
    until: str | None = ...,
    period: Literal["month", "week"] | None = ...,
    ages: Literal["middle", "start", "end", "whole"] = ...,
    warranty: _Quantity | None = ...,
    delay_to_use: Any = ...,
    delay_of_report: Any = ...,
    hold_out: _Quantity | None = ...,
    family: Literal["weibull", "exponential", "lognormal", "loglogistic", "frechet", "gamma", "inverse-gaussian", "birnbaum-saunders"] = ...,
    ahead: _Quantity | None = ...,
    cost_per_return: str | None = ...,
    planned_sales: Any = ...,
    survival_to: _Quantity | Sequence[_Quantity] | None = ...,
    priors: _Priors | Literal["flat"] = ...,
    b: _Percentages = ...,
    predict: Mapping[str, Any] | None = ...,
    title: str | None = ...,
    seed: int | None = ...,
    method: _Method = ...,
    chains: int | None = ...,
    warmup: int | None = ...,
    draws: int | None = ...,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def table(data: Any, *, units: Mapping[str, Any] | None = ..., name: str = ...) -> Any: ...

class Selection:
    summary: dict[str, Any]
    trusted: bool
    checks: list[Check]
    def __init__(self, summary: str, text: str, models: str, page: str) -> None: ...
    @property
    def models(self) -> pandas.DataFrame: ...
    def report(self, path: _Path) -> None: ...

def select(
    data: Any,
    response: str,
    *,
    inputs: str | Sequence[str] = ...,
    degree: int | None = ...,
    terms: str | Sequence[str] = ...,
    criterion: str = ...,
    keep: int = ...,
    near: float = ...,
    force: str | Sequence[str] = ...,
    weights: str = ...,
    folds: int = ...,
    nested: int | None = ...,
    seed: int = ...,
    time: float | None = ...,
    threads: int = ...,
    report: bool = ...,
) -> Selection: ...

def rainflow(
    signal: Any, *, method: Literal["four-point", "three-point"] = ..., residual: Literal["half", "repeat"] = ...
) -> pandas.DataFrame: ...

class Comparison:
    summary: dict[str, Any]
    close: list[str]
    def __init__(self, summary: str, text: str, page: str) -> None: ...
    @property
    def lives(self) -> pandas.DataFrame: ...
    def report(self, path: _Path) -> None: ...

def compare(
    *fits: Fit | Study | _Path | Mapping[str, Fit | _Path],
    names: Sequence[str] | None = ...,
    families: str | Sequence[str] | None = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Comparison: ...

def unit_life(
    fit: Fit | str | os.PathLike[str],
    unit: str | None = ...,
    *,
    survived: _Quantity | None = ...,
    horizon: _Quantity | None = ...,
    risk: str | None = ...,
    level: float | str | None = ...,
    sides: Literal["lower", "upper", "both"] | None = ...,
) -> Plan: ...

def decide(
    lives: Any,
    *,
    failure_cost: float | str,
    replacement_cost: float | str,
    at: str | None = ...,
    in_service: Any = ...,
    inspection_cost: float | str | None = ...,
    downtime_cost: str | None = ...,
    month: _Quantity | None = ...,
    months: int = ...,
    service_level: float | str = ...,
    claims: float | str | None = ...,
    unit: str | None = ...,
    inspect_after: _Quantity | None = ...,
    given: Mapping[str, Any] | Sequence[str] | None = ...,
    progress: _Progress = ...,
) -> Plan: ...

def update(
    fit: Fit | _Path,
    data: Any,
    repeated: Literal["once", "another"] | None = ...,
    *,
    threads: int = ...,
    report: bool = ...,
    progress: _Progress = ...,
) -> Fit: ...
def track(fit: Fit | _Path, unit: str | None = ..., *, new: bool = ...) -> UnitTracker: ...

class Quantiles(NamedTuple):
    q05: float
    q50: float
    q95: float
    unit: str

class UnitTracker:
    unit: str
    is_new: bool
    def update(self, rows: Any) -> UnitTracker: ...
    @property
    def summary(self) -> dict[str, Any]: ...
    @property
    def rul(self) -> Quantiles: ...
    @property
    def level(self) -> Quantiles: ...
    @property
    def doubt(self) -> str | None: ...
    @property
    def passed(self) -> float: ...
    @property
    def rate_change(self) -> dict[str, Any] | None: ...
    def risk(self, within: _Quantity) -> float: ...
    def path(self) -> pandas.DataFrame: ...
    @property
    def outcomes(self) -> pandas.DataFrame: ...

def backtest(fit: Fit | _Path, readings: Any, lives: Any) -> Backtest: ...

class Backtest:
    summary: dict[str, Any]
    trusted: bool
    @property
    def forecasts(self) -> pandas.DataFrame: ...
    @property
    def coverage(self) -> pandas.DataFrame: ...
    def _repr_html_(self) -> str: ...

def export_c(fit: Fit | _Path, folder: _Path, *, name: str = ..., unit: str | None = ..., lines: int | None = ...) -> str: ...
def export_sql(
    fit: Fit | _Path,
    dialect: Literal["duckdb", "postgresql", "clickhouse"],
    table: str,
    *,
    value: str | None = ...,
    unit: str | None = ...,
    columns: Mapping[str, str] | str | Sequence[str] | None = ...,
    keep: str | Sequence[str] | None = ...,
    prefix: str = ...,
    draws: int = ...,
    part: Literal["all", "setup", "query"] = ...,
) -> str: ...

class Monitor:
    url: str
    def __init__(
        self, url: str = ..., *, token: str | None = ..., certificate: _Path | None = ..., timeout: float = ...
    ) -> None: ...
    def fleet(self) -> dict[str, Any]: ...
    def units(self, search: str = ...) -> pandas.DataFrame: ...
    def unit(self, name: str) -> dict[str, Any]: ...
    def send(self, readings: Mapping[str, Any] | Sequence[Mapping[str, Any]] | pandas.DataFrame) -> dict[str, Any]: ...
    def report(self, unit: str, event: str, **fields: Any) -> dict[str, Any]: ...
    def events(self) -> Iterator[dict[str, Any]]: ...

class _Answer:
    title: str
    summary: dict[str, Any]
    json: str
    trusted: bool
    def __init__(
        self, title: str, text: str, json: str, tables: Sequence[tuple[str, str]], page: str, trusted: bool
    ) -> None: ...
    @property
    def tables(self) -> dict[str, pandas.DataFrame]: ...
    def report(self, path: _Path) -> None: ...
    def write(self, folder: _Path) -> None: ...
    def _repr_html_(self) -> str: ...

class LivesAgainst(_Answer):
    @property
    def outlives(self) -> float: ...
    @property
    def differences(self) -> pandas.DataFrame: ...

class Damage(_Answer):
    @property
    def lives(self) -> pandas.DataFrame: ...
    @property
    def life(self) -> Quantiles: ...
    @property
    def damage(self) -> Quantiles: ...
    @property
    def sources(self) -> pandas.DataFrame: ...

class DesignCurves(_Answer):
    @property
    def curves(self) -> pandas.DataFrame: ...
    @property
    def models(self) -> pandas.DataFrame: ...

class LoadSpectrum(_Answer): ...

def damage(
    fit: Fit | _Path,
    loads: Any,
    *,
    column: str | None = ...,
    units: Any = ...,
    method: Literal["four-point", "three-point"] = ...,
    residual: Literal["half", "repeat"] = ...,
    time: str | None = ...,
    scale: _Quantity | None = ...,
    rule: Literal["elementary", "original", "haibach", "liu-zenner"] | None = ...,
    knee: _Quantity | None = ...,
    damage_sum: float | str = ...,
    block: _Quantity | None = ...,
    b: _Percentages = ...,
    confidence: float = ...,
    progress: _Progress = ...,
) -> Damage: ...
def design(
    *fits: Fit | _Path | Mapping[str, Fit | _Path],
    names: Sequence[str] | None = ...,
    stress: _Quantity | Sequence[_Quantity] | None = ...,
    mean_stress: _Quantity | None = ...,
    stress_ratio: float | None = ...,
    reliability: float | None = ...,
    confidence: float | None = ...,
    progress: _Progress = ...,
) -> DesignCurves: ...
def spectrum(
    loads: Any,
    *,
    column: str | None = ...,
    units: Any = ...,
    method: Literal["four-point", "three-point"] = ...,
    residual: Literal["half", "repeat"] = ...,
    time: str | None = ...,
    bins: int = ...,
    bin_width: float | None = ...,
) -> LoadSpectrum: ...

class Plan(_Answer):
    def __init__(
        self, title: str, text: str, json: str, tables: Sequence[tuple[str, str]], page: str, trusted: bool, name: str = ...
    ) -> None: ...

def flat(unit: Any, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def uniform(lower: _Quantity, upper: _Quantity) -> _Prior: ...
def normal(mean: _Quantity, sd: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def lognormal(
    median: _Quantity | None = ...,
    log_sd: float | None = ...,
    *,
    mean: _Quantity | None = ...,
    sd: _Quantity | None = ...,
    lower: _Quantity | None = ...,
    upper: _Quantity | None = ...,
) -> _Prior: ...
def half_normal(scale: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def half_cauchy(scale: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def exponential(mean: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def gamma(shape: float, scale: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def inverse_gamma(shape: float, scale: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def student_t(
    df: float, location: _Quantity, scale: _Quantity, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...
) -> _Prior: ...
def beta(alpha: float, beta: float, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def jeffreys(unit: Any, *, lower: _Quantity | None = ..., upper: _Quantity | None = ...) -> _Prior: ...
def prior(
    distribution: str, *, unit: Any = ..., lower: _Quantity | None = ..., upper: _Quantity | None = ..., **parameters: _Quantity
) -> _Prior: ...
def default() -> _Prior: ...

def __dir__() -> list[str]: ...
