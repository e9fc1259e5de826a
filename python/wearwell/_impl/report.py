"""The page that answers, comparisons, selections and fits have."""

import os

from . import _core
from .errors import InputError


class Report:
    """What writes a page. ``_page`` is its HTML, or None where there is none, as ``_no_page`` says."""

    _page = None
    _no_page = "there is no page"

    def _html(self):
        if not self._page:
            raise InputError(self._no_page)
        return self._page

    def report(self, path):
        """Write the report, one HTML page that needs no network.

        Parameters
        ----------
        path : str or path
            The file, such as "report.html".

        Raises
        ------
        InputError
            If this was made without a report, or the path cannot be written (no folder, no permission).
        MachineError
            If the disk fails.

        Examples
        --------
        >>> import os, tempfile
        >>> import wearwell as ww
        >>> page = os.path.join(tempfile.mkdtemp(), "report.html")
        >>> ww.plan.demonstrate("B10 >= 1e6 cycles").report(page)
        >>> os.path.getsize(page) > 10_000
        True
        """
        _core.write_file(os.fspath(path), self._html())
