import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

from . import Fit, Plan, Study

_Path = str | os.PathLike[str]
_Quantity = Any  # a number, "1e6 cycles", or a pint quantity
_Progress = bool | Callable[[str, int, int, float], object] | None

def next(
    fit: Fit | _Path,
    goal: str,
    *,
    candidates: Any = ...,
    grid: str | Mapping[str, Any] | None = ...,
    specimens: int | str | Sequence[int] | None = ...,
    cost: str | None = ...,
    specimen_cost: float | None = ...,
    use_cost: float | None = ...,
    measure: str | None = ...,
    by: Literal["variance", "information"] = ...,
    value: float | None = ...,
    budget: float | None = ...,
    batch: int = ...,
    until: str | None = ...,
    tests: Any = ...,
    samples: int = ...,
    nodes: int = ...,
    seed: int = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Plan: ...
def size(
    study: Study | _Path,
    goal: str,
    *,
    width: _Quantity,
    tests: Any,
    assurance: float | str = ...,
    level: float | str = ...,
    measure: str | None = ...,
    most: int = ...,
    simulations: int = ...,
    seed: int = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Plan: ...
def demonstrate(
    goal: str,
    *,
    confidence: float | str = ...,
    failures: int | str = ...,
    specimens: int | None = ...,
    time: _Quantity | None = ...,
    distribution: Literal["weibull", "lognormal", "loglogistic"] = ...,
    shape: float | str | None = ...,
    sigma: float | str | None = ...,
    truth: str | Sequence[str] | None = ...,
    sudden_death: int | None = ...,
) -> Plan: ...
def inspect(
    lives: Any,
    *,
    at: str | None = ...,
    risk: float | str | None = ...,
    total_risk: float | str | None = ...,
    warning: _Quantity | None = ...,
    until: _Quantity | None = ...,
    step: _Quantity | None = ...,
    unit: str | None = ...,
    new: bool = ...,
    inspection_cost: float | str | None = ...,
    failure_cost: float | str | None = ...,
    replacement_cost: float | str | None = ...,
    downtime_cost: str | None = ...,
    visit_cost: float | str | None = ...,
    given: Mapping[str, Any] | Sequence[str] | None = ...,
    in_service: Any = ...,
    threads: int = ...,
    progress: _Progress = ...,
) -> Plan: ...
def accelerate(
    *,
    use: _Quantity,
    highest: _Quantity,
    until: _Quantity,
    specimens: int,
    goal: str = ...,
    relation: Literal["arrhenius", "inverse-power", "linear"] = ...,
    family: Literal["weibull", "lognormal", "loglogistic"] = ...,
    shape: float | str | None = ...,
    sigma: float | str | None = ...,
    failing_at_use: float | str | None = ...,
    failing_at_highest: float | str | None = ...,
    life_at_highest: _Quantity | None = ...,
    activation_energy: _Quantity | None = ...,
    exponent: float | str | None = ...,
    slope: float | str | None = ...,
    lowest: _Quantity | None = ...,
    low: _Quantity | None = ...,
    middle_share: float | str = ...,
    least_failures: int = ...,
) -> Plan: ...
