"""Worn volume of clutch linings, cycle by cycle (docs/reference/clutch.md)."""

import json
import os

from . import _core
from ._data import table_of


class CycleSum:
    """Cycles run through a wear model, model.json of a fitted campaign.

    ``CycleSum("results/model.json").add(cycles)``: a table with plate, cycle, slip_speed, torque, temperature,
    closing_time and energy (units in the headings, "torque [N m]", or by ``units``), or the path of a file that may be
    larger than memory. How cycles are cut into calls changes no bit. scatter_only: without the uncertainty of the model,
    ten times as fast. skip_not_finite: leaves out cycles at which the model gives no finite number, and counts them.
    """

    def __init__(self, model, *, scatter_only=False, skip_not_finite=False):
        self._cycles = _core.Cycles(os.fspath(model), bool(scatter_only), bool(skip_not_finite))

    def add(self, cycles, *, units=None):
        """All of these cycles or, where one is refused (InputError), none of them. Returns the sum itself."""
        if isinstance(cycles, (str, os.PathLike)):
            self._cycles.add_file(os.fspath(cycles))
        else:
            self._cycles.add(table_of(cycles, "cycles", units))
        return self

    @property
    def summary(self):
        """As ``wearwell clutch predict --json`` prints it."""
        return json.loads(self._cycles.json())

    @property
    def plates(self):
        """A frame by plate: cycles, energy [J], volume [mm^3], its standard deviations, the share worn."""
        import pandas

        return pandas.DataFrame(
            [{k: v for k, v in each.items() if k != "outside"} for each in self.summary["plates"]]
        ).set_index("plate") if self.summary["plates"] else pandas.DataFrame()
