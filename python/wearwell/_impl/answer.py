"""An answer of the library with its text, numbers, tables and page."""

import csv
import functools
import io
import os
from json import loads

from . import _core
from .messages import in_arguments
from .notebook import html_of_plan
from .report import Report


class Answer(Report):
    """What plans, decisions, damage and design curves have in common."""

    _file = "plan"  # name of the JSON file

    def __init__(self, title, text, json, tables, page, trusted):
        self.title, self.json, self.summary, self.trusted = title, json, loads(json), trusted
        self._text, self._csv, self._page = text, dict(tables), page

    @functools.cached_property
    def tables(self):
        """Tables of the answer.

        Returns
        -------
        dict of str to pandas.DataFrame
            By name, as the command writes tables/NAME.csv; headings have units, "time [cycles]".

        Examples
        --------
        >>> import wearwell as ww
        >>> plan = ww.plan.demonstrate("B10 >= 1e6 cycles", failures="0 to 2")
        >>> len(plan.tables["plans"])
        3
        """
        import pandas

        found = {}
        for name, content in self._csv.items():
            header = next(csv.reader(io.StringIO(content)), None)
            found[name] = pandas.read_csv(io.StringIO(content), float_precision="round_trip") if header else pandas.DataFrame()
        return found

    def write(self, folder):
        """Write the folder that the command writes with ``-o``: its JSON file, tables and report, whole or not at all.

        Parameters
        ----------
        folder : str or path
            The folder. Files of an earlier result are replaced; other files stay.

        Raises
        ------
        InputError
            If the folder cannot be made, or a file in it that is not of an earlier result has the name of a new one.
        MachineError
            If the disk fails.

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> folder = os.path.join(tempfile.mkdtemp(), "plan")
        >>> ww.plan.demonstrate("B10 >= 1e6 cycles").write(folder)
        >>> sorted(os.listdir(folder))
        ['plan.json', 'report.html', 'results.sha1', 'tables']
        """
        files = [(f"{self._file}.json", self.json), *((f"tables/{name}.csv", text) for name, text in self._csv.items()),
                 ("report.html", self._page)]
        _core.write_folder(os.fspath(folder), files)

    def __str__(self):
        return in_arguments(self._text)

    def __repr__(self):
        return f"<wearwell.{type(self).__name__} {self.title!r}>"

    def _repr_html_(self):
        return html_of_plan(self.title, str(self), self._page)
