import os
from collections.abc import Mapping
from typing import Any, TypeVar

import pandas

_C = TypeVar("_C", bound="CycleSum")

class CycleSum:
    def __init__(self, model: str | os.PathLike[str], *, scatter_only: bool = ..., skip_not_finite: bool = ...) -> None: ...
    def add(self: _C, cycles: Any, *, units: Mapping[str, Any] | None = ...) -> _C: ...
    @property
    def summary(self) -> dict[str, Any]: ...
    @property
    def plates(self) -> pandas.DataFrame: ...
