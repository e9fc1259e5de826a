"""Worn volume of clutch linings, cycle by cycle."""

import json
import os

from ._impl import _core
from ._impl.data import table_of


class CycleSum:
    """Worn volume of the plates of a clutch, summed over cycles with the wear model of a fitted campaign.

    How cycles are divided into calls of ``add`` changes no bit of the result.

    Parameters
    ----------
    model : str or path
        model.json, which ``wearwell fit`` or ``Fit.write`` writes for a clutch study.
    scatter_only : bool
        Whether to leave out the uncertainty of the model, and take only the scatter of cycles: ten times as fast.
    skip_not_finite : bool
        Whether to leave out and count cycles at which the model gives no finite number, instead of refusing them.

    Raises
    ------
    InputError
        If the file is missing, or is not a wear model.

    Examples
    --------
    The folder clutch-results is that of ``wearwell fit examples/clutch/study.toml -o clutch-results``:

    >>> import wearwell as ww
    >>> wear = ww.clutch.CycleSum("clutch-results/model.json")
    >>> wear.plates.empty
    True
    """

    def __init__(self, model, *, scatter_only=False, skip_not_finite=False):
        self._cycles = _core.Cycles(os.fspath(model), bool(scatter_only), bool(skip_not_finite))

    def add(self, cycles, *, units=None):
        """Add cycles: all of them or, if one is refused, none.

        Parameters
        ----------
        cycles : table, str or path
            A row for each cycle, or the path of a file that may be larger than memory. Columns: plate, cycle (rising in each
            plate), slip_speed, torque, temperature, closing_time and energy, each with its unit.
        units : dict, optional
            Unit of each column, by heading. A heading may have it: "torque [N m]".

        Returns
        -------
        CycleSum
            The sum itself.

        Raises
        ------
        InputError
            If a column is missing, or a value is missing or out of its range; the message names row and column.

        Examples
        --------
        >>> import wearwell as ww
        >>> cycles = {"plate": ["A", "A"], "cycle": [1, 2], "slip_speed [rad/s]": [200, 250], "torque [N m]": [40, 40],
        ...           "temperature [degC]": [150, 150], "closing_time [s]": [1, 1], "energy [J]": [4000, 5000]}
        >>> wear = ww.clutch.CycleSum("clutch-results/model.json").add(cycles)
        >>> wear.plates.loc["A", ["cycles", "energy"]].tolist()
        [2.0, 9000.0]
        """
        if isinstance(cycles, (str, os.PathLike)):
            self._cycles.add_file(os.fspath(cycles))
        else:
            self._cycles.add(table_of(cycles, "cycles", units))
        return self

    @property
    def summary(self):
        """All numbers of the sum.

        Returns
        -------
        dict
            As ``wearwell clutch predict --json`` prints them: ``units``, ``trusted``, ``problems`` and, for each plate,
            ``plates``.

        Examples
        --------
        >>> import wearwell as ww
        >>> ww.clutch.CycleSum("clutch-results/model.json").summary["units"]
        {'energy': 'J', 'volume': 'mm^3'}
        """
        return json.loads(self._cycles.json())

    @property
    def plates(self):
        """The plates, with what has worn of each.

        Returns
        -------
        pandas.DataFrame
            A row for each plate, indexed by its name. Columns among others: ``cycles``; ``energy`` [J]; ``volume``, the worn
            volume [mm^3]; ``sd_scatter`` and ``sd_full``, its standard deviations by the scatter of cycles and with the
            uncertainty of the model [mm^3]; ``worn``, its share of the volume that may wear; ``outside_any``, cycles
            outside the range in which the model was fitted. Empty before the first cycle.

        Examples
        --------
        >>> import wearwell as ww
        >>> cycles = {"plate": ["A", "A"], "cycle": [1, 2], "slip_speed [rad/s]": [200, 250], "torque [N m]": [40, 40],
        ...           "temperature [degC]": [150, 150], "closing_time [s]": [1, 1], "energy [J]": [4000, 5000]}
        >>> plates = ww.clutch.CycleSum("clutch-results/model.json").add(cycles).plates
        >>> bool(plates.loc["A", "volume"] > 0), int(plates.loc["A", "outside_any"])
        (True, 0)
        """
        import pandas

        return pandas.DataFrame(
            [{k: v for k, v in each.items() if k != "outside"} for each in self.summary["plates"]]
        ).set_index("plate") if self.summary["plates"] else pandas.DataFrame()

