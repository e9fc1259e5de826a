"""Questions that a fit answers later."""

import json

from .errors import InputError
from .messages import in_python


class FitAnswers:
    """Predictions and lives under new conditions. Part of ``Fit``."""

    def ask(self, predict, level=0.9):
        """Answers to another ``[predict]`` under the same posterior. Nothing is fitted again.

        Parameters
        ----------
        predict : dict
            Keys of ``[predict]`` of a study file of the same model, such as ``{"cycles": [30000]}`` of a joint or
            ``{"along": ..., "at": [...], "given": {...}}`` of a formula; quantities are texts with units.
        level : float
            Probability that the intervals of predictions hold, between 0 and 1. The intervals keep the names ci05, ci95,
            pi05 and pi95 at every level.

        Returns
        -------
        dict
            With the keys "predictions", "quantities" and "life" of summary.json, as far as they are asked for. ``next`` of a
            repairable system adds "repairable", of warranty returns "returns", and ``classical`` of lives "classical".

        Raises
        ------
        InputError
            If ``level`` is not between 0 and 1, or a key or value is not one of the model's ``[predict]``.

        Examples
        --------
        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> answers = fit.ask({"cycles": [30000], "limit": "120 mm^3"})
        >>> round(answers["predictions"][0]["mean"], 1)
        138.9
        >>> round(answers["life"]["b10"], -2)
        22800.0
        """
        if not 0 < level < 1:
            raise InputError(f"level is {level}; it lies between 0 and 1")
        try:
            return json.loads(self._live().asked(self.study._asking(predict), float(level)))
        except InputError as error:
            raise InputError(in_python(str(error))) from None

    def predict(self, new, level=0.9, kind="mean", *, along=None):
        """Predictions under new conditions, of a study of a formula.

        Parameters
        ----------
        new : pandas.DataFrame or dict of columns
            A row for each prediction, in the units of the study's columns or of a heading, "F [kN]". Columns that the study does
            not have are ignored.
        level : float
            Probability that an interval holds, between 0 and 1.
        kind : {"mean", "next", "unit"}
            "mean": the true mean of the median item, with a credible interval. "next": a measurement of an item not seen
            yet, with a prediction interval. "unit": a measurement of the item that the label column of ``new`` names,
            by its own random effects given its data (an empty cell: a new item). Up to the item's last row the formula
            holds as in the data; beyond, where conditions change, its path goes on from its present value. Of lives, "mean"
            is the mean life of all items, "next" the life of the next one, with intervals of 90 %.
        along : str, optional
            Column that is the axis of wear; needed where the formula is only a rate or a running sum, and for
            ``kind="unit"`` with several numeric conditions.

        Returns
        -------
        pandas.DataFrame
            Columns ``mean``, ``lower``, ``upper``, with the index of ``new``; ``attrs["unit"]`` is their unit. Where
            several columns are measured, the name of each comes before: "depth mean".

        Raises
        ------
        InputError
            If the study is of another model, a column is missing, a value is missing or not finite, an item is
            unknown, or measurements of a new item cannot be predicted (two random effects, or a process).

        Examples
        --------
        >>> import wearwell as ww
        >>> wear = {"F": [100, 200, 300, 400], "s": [4e4] * 4, "V": [0.41, 0.78, 1.23, 1.61]}
        >>> study = ww.Study(formula="V = k*F*s", data=wear, units={"F": "N", "s": "m", "V": "mm^3"},
        ...                  priors={"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3")})
        >>> fit = study.fit(seed=1, method="exact", draws=100, report=False)
        >>> fit.predict({"F": [150, 250], "s": [4e4, 4e4]}).round(2)
           mean  lower  upper
        0  0.60   0.58   0.62
        1  1.01   0.97   1.04
        """
        from .ask import predict

        return predict(self, new, level, kind, along)

    def life(self, limit=None, b=(1, 10), confidence=0.9, unit=None, survived=None, *, along=None, given=None):
        """Lives to a failure threshold, or of what the study measures, with B-lives and bounds.

        Parameters
        ----------
        limit : str, float, pint quantity or dict, optional
            Failure threshold of the measured quantity, with its unit; by name where several are measured. None where
            lives are measured, and where the study states one. A life ends when the path first reaches it.
        b : float or sequence of float
            Percentages p of B-lives, between 0 and 100: the life by which p percent have failed.
        confidence : float
            Probability with which ``bound`` is exceeded, between 0 and 1.
        unit : str, optional
            An item of the data: its remaining useful life, from its last row.
        survived : str, float or pint quantity, optional
            Lives of items that have reached this, from there on.
        along : str, optional
            Column that is the axis of wear and life; by default the one that the study states.
        given : dict, optional
            Conditions, by column; what is the same in all rows may be left out.

        Returns
        -------
        pandas.DataFrame
            A row for the life, with ``name``, ``of``, ``at``, ``unit``, quantiles ``q05``, ``q50``, ``q95`` and a column
            for each B-life (``b1``, ``b10``, ...), averaged over the posterior. Where items differ, a row for each B-life
            over all items, with ``predictive`` (that of the next item) and ``bound``; else ``bound`` of the life is that
            of the first B-life. With ``survived`` a row for the probability of survival to it, in percent. Infinity: the
            life never ends.

        Raises
        ------
        InputError
            If an argument does not apply to the study's model, a column or an item is unknown, ``survived`` lies before
            the item's last row, or fewer than 0.1 % survive to it.

        Examples
        --------
        Wear of a joint to another threshold:

        >>> import wearwell as ww
        >>> fit = ww.fit("examples/joint/study.toml", seed=1, report=False)
        >>> life = fit.life(limit="120 mm^3", b=[1, 10])
        >>> life[["unit", "q50", "b1", "b10"]].round(-2).iloc[0].tolist()
        ['cycles', 25900.0, 19600.0, 22800.0]

        A formula, along its column s under a force of 200 N:

        >>> wear = {"F": [100, 200, 300, 400], "s": [4e4] * 4, "V": [0.41, 0.78, 1.23, 1.61]}
        >>> study = ww.Study(formula="V = k*F*s", data=wear, units={"F": "N", "s": "m", "V": "mm^3"},
        ...                  priors={"k": ww.lognormal("1e-7 mm^3/(N m)", log_sd=3), "sigma": ww.half_normal("5 mm^3")})
        >>> fit = study.fit(seed=1, method="exact", draws=100, report=False)
        >>> fit.life(limit="10 mm^3", along="s", given={"F": "200 N"})[["unit", "q50"]].round(-4).iloc[0].tolist()
        ['m', 500000.0]
        """
        from .lives import life

        return life(self, limit, b, confidence, unit, survived, along, given)
