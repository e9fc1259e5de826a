"""How far a fit is, on a terminal or in a notebook."""

import contextlib
import sys


def _described(what, done, total, seconds):
    """The part of the work, or its steps where they are counted."""
    if total:
        return f"{done} of {total} {what}, {seconds:.0f} s"
    return f"{done} {what}, {seconds:.0f} s" if done else what


class _Bar:
    width = 30

    def __init__(self):
        self._handle = None
        try:
            shell = get_ipython()  # type: ignore[name-defined]  # noqa: F821  (there in IPython alone)
            self._notebook = shell.__class__.__name__ == "ZMQInteractiveShell"
        except NameError:
            self._notebook = False
        self._shown = False
        self._longest = 0

    def __call__(self, what, done, total, seconds):
        share = min(1.0, done / total) if total else 0.0
        self._shown = True
        if self._notebook:
            from IPython.display import HTML, display

            html = HTML(f'<progress value="{share:.3f}" max="1"></progress> {_described(what, done, total, seconds)}')
            if self._handle is None:
                self._handle = display(html, display_id=True)
            else:
                self._handle.update(html)
            return
        filled = int(share * self.width)
        line = f"[{'#' * filled}{'.' * (self.width - filled)}] {_described(what, done, total, seconds)} "
        self._longest = max(self._longest, len(line))
        sys.stderr.write("\r" + line.ljust(self._longest))
        sys.stderr.flush()

    def close(self):
        if not self._shown:
            return
        if self._notebook:
            from IPython.display import HTML

            self._handle.update(HTML(""))
        else:
            sys.stderr.write("\r\x1b[K" if sys.stderr.isatty() else "\n")


@contextlib.contextmanager
def reporter(progress):
    if progress is None or progress is False:
        yield None
    elif progress is True:
        bar = _Bar()
        try:
            yield bar
        finally:
            bar.close()
    elif callable(progress):
        yield progress
    else:
        from .errors import InputError

        raise InputError(f"progress is {progress!r}; it is True or a function of (what, done, total, seconds)")
