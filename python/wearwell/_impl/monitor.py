"""A running monitor, by its HTTP API."""

import contextlib
import http.client
import json
import math
import ssl
import urllib.error
import urllib.parse
import urllib.request

from .errors import InputError, MachineError

_nan, _inf = float("nan"), float("inf")
_at_once, _most_bytes = 500, 2**20
_loopback = ("127.0.0.1", "localhost", "::1")


class _NoRedirect(urllib.request.HTTPRedirectHandler):
    """A redirection would hand the token to another server."""

    def redirect_request(self, *_):
        return None


class Monitor:
    """A running ``wearwell monitor``: its units, and a way in for readings.

    Parameters
    ----------
    url : str
        Address of its page.
    token : str, optional
        The token of its configuration. Beyond this computer it is sent by https only.
    certificate : str or path, optional
        File with the certificate to trust (PEM), where the system does not know it.
    timeout : float
        Seconds to wait for an answer.

    Attributes
    ----------
    url : str
        The address.

    Raises
    ------
    InputError
        If the address is no http or https address, or a token would be sent unencrypted.

    Examples
    --------
    >>> import wearwell as ww
    >>> monitor = ww.Monitor(url)  # "http://127.0.0.1:8080"
    >>> monitor.fleet()["title"]
    'Two hundred machines'
    """

    def __init__(self, url="http://127.0.0.1:8080", *, token=None, certificate=None, timeout=10.0):
        parts = urllib.parse.urlsplit(url) if isinstance(url, str) else None
        if parts is None or parts.scheme not in ("http", "https") or not parts.hostname:
            raise InputError(f"url is {url!r}; it is like 'http://127.0.0.1:8080'")
        if token is not None and parts.scheme == "http" and parts.hostname not in _loopback:
            raise InputError(f"token: {url} is not encrypted, and anyone on the way could read it; the address begins with https")
        self.url, self._token, self._timeout = url.rstrip("/"), token, float(timeout)
        context = ssl.create_default_context(cafile=certificate) if parts.scheme == "https" else None
        handlers = [_NoRedirect] + ([urllib.request.HTTPSHandler(context=context)] if context else [])
        self._opener = urllib.request.build_opener(*handlers)

    def fleet(self):
        """What all units have in common, and counts.

        Returns
        -------
        dict
            ``title``, ``axis`` and ``axis_unit``, ``limited`` and ``level_unit``, ``limit``, ``horizon``, ``trusted``, ``units``
            by alarm, ``messages``, and times in Unix milliseconds.

        Raises
        ------
        InputError
            If the monitor refuses the request, because of a wrong token for example.
        MachineError
            If it cannot be reached.

        Examples
        --------
        >>> import wearwell as ww
        >>> fleet = ww.Monitor(url).fleet()
        >>> fleet["axis_unit"], fleet["units"]["all"]
        ('h', 2)
        """
        return self._get("/api/v1/fleet")

    def units(self, search=""):
        """All units by risk, highest first.

        Parameters
        ----------
        search : str
            Part of the name, in any case.

        Returns
        -------
        pandas.DataFrame
            A row for each unit, indexed by name: ``alarm``, ``at``, quantiles of the level now (``level_q05``, ...) and of the
            remaining useful life (``rul_q05``, ...; infinity: never), ``b10``, ``risk``, ``passed``, ``doubt``, ``beyond``,
            ``service`` (``"in service"``, ``"removed"``, ``"failed"``) and ``readings``. ``attrs`` has ``axis_unit`` and ``level_unit``. NaN where nothing determines a number.

        Raises
        ------
        InputError
            If the monitor refuses the request.
        MachineError
            If it cannot be reached.

        Examples
        --------
        >>> import wearwell as ww
        >>> units = ww.Monitor(url).units()
        >>> units["risk"].is_monotonic_decreasing, units.attrs["axis_unit"]
        (True, 'h')
        """
        import pandas

        fleet, rows = self.fleet(), {}
        while True:
            query = urllib.parse.urlencode({"search": search, "offset": len(rows), "count": _at_once})
            page = self._get(f"/api/v1/units?{query}")
            before = len(rows)
            rows.update((each["unit"], _row(each)) for each in page["units"])
            if len(rows) >= page["matching"] or len(rows) == before:
                break
        frame = pandas.DataFrame.from_dict(rows, orient="index", columns=list(_columns))
        frame.index.name = "unit"
        frame.attrs.update(axis_unit=fleet["axis_unit"], level_unit=fleet["level_unit"])
        return frame

    def unit(self, name):
        """One unit with its history and forecast.

        Parameters
        ----------
        name : str
            Name of the unit.

        Returns
        -------
        dict
            What ``units`` has, and ``moments`` (its readings and the forecasts then), ``path``, ``survival`` and ``forecasts``.

        Raises
        ------
        InputError
            If there is no such unit, or the monitor refuses the request.
        MachineError
            If it cannot be reached.

        Examples
        --------
        >>> import wearwell as ww
        >>> monitor = ww.Monitor(url)
        >>> monitor.unit(monitor.units().index[0])["quality"]["readings"]
        3
        """
        return self._get("/api/v1/units/" + urllib.parse.quote(str(name), safe=""))

    def send(self, readings):
        """Send readings to the store of the monitor.

        Parameters
        ----------
        readings : dict, list of dict, or pandas.DataFrame
            Fields of the messages, as the monitor's configuration maps them. Times may be datetimes. Missing values are left out.
            It is harmless to send a reading again.

        Returns
        -------
        dict
            Counts ``readings`` (new ones, on disk), ``repeated`` and ``refused``, and ``problem``, the first one.

        Raises
        ------
        InputError
            If no reading of a message of up to 1 MiB can be taken, or the monitor takes none by HTTP.
        MachineError
            If it or its store cannot be reached: send them again.

        Examples
        --------
        >>> import wearwell as ww
        >>> monitor = ww.Monitor(url)
        >>> reading = {"time": "2026-05-05T12:00:00Z", "machine": "M067", "use_h": 900.0, "wear_um": 17.5}
        >>> monitor.send(reading)["readings"], monitor.send(reading)["repeated"]
        (1, 1)
        """
        total = {"readings": 0, "repeated": 0, "refused": 0, "problem": ""}
        for body in _bodies(_records(readings)):
            delivery = self._post(body)
            for key in ("readings", "repeated", "refused"):
                total[key] += delivery[key]
            total["problem"] = total["problem"] or delivery["problem"]
        return total

    def report(self, unit, event, **fields):
        """Report an event of a unit: a part is replaced or has failed, a reading is corrected, ...

        Parameters
        ----------
        unit : str
            Name of the unit.
        event : str
            ``"installed"``, ``"replaced"``, ``"repaired"``, ``"removed"``, ``"failed"``, ``"sensor"``, ``"corrected"``,
            ``"withdrawn"``, ``"cancelled"`` or ``"acknowledged"``. A unit that is not known begins with ``"installed"``.
        **fields
            ``by``, who reports it; perhaps ``note``; ``key``, the place among the unit's readings (as in ``moments`` of
            ``unit()``); and by the names of the study's columns what the event needs: the use on the counter, the offset of a
            sensor, all values of a corrected reading. ``restored``, the amount that a repair takes back, in the unit of the level. ``part_name``, the part of the study that goes on, of ``"installed"`` and ``"replaced"``. ``number`` of the event that is cancelled, ``alarm_ms`` of the alarm that is
            acknowledged (both as ``unit()`` has them).

        Returns
        -------
        dict
            ``events``: 1, and ``repeated``: 0; or the other way round, where the same event is stored already.

        Raises
        ------
        InputError
            If the event cannot be taken: the message says why.
        MachineError
            If the monitor or its store cannot be reached: report it again.

        Examples
        --------
        >>> import wearwell as ww
        >>> monitor = ww.Monitor(url)
        >>> name = monitor.units().index[0]
        >>> last = monitor.unit(name)["moments"][-1]["key"]
        >>> monitor.report(name, "withdrawn", key=last, by="J. Doe", note="wrong gauge")["events"]
        1
        """
        body = json.dumps({"event": event, **{key: _plain(value, key, 1) for key, value in fields.items()}}).encode()
        return self._post(body, f"/api/v1/units/{urllib.parse.quote(str(unit), safe='')}/events")

    def events(self):
        """Changes as they come.

        Returns
        -------
        iterator of dict
            Each with ``fleet`` (as ``fleet()``), ``changed``, the names of the units that changed, and ``all``, whether all may have
            changed: the first one, and where more than 200 did. Endless; a loop ends it by ``break``.

        Raises
        ------
        InputError
            If the monitor refuses the request.
        MachineError
            If it cannot be reached, or ends.

        Examples
        --------
        >>> import wearwell as ww
        >>> next(ww.Monitor(url).events())["all"]
        True
        """
        beat = 10
        with self._open("/api/v1/events", timeout=self._timeout + 2 * beat) as answer:
            kind = ""
            for line in _lines(answer, self.url):
                name, _, value = line.partition(": ")
                if name == "event":
                    kind = value
                elif name == "data" and kind == "fleet":
                    yield json.loads(value)
        raise MachineError(f"{self.url} has ended the events")

    def _open(self, path, body=None, timeout=None):
        request = urllib.request.Request(self.url + path, data=body)
        if body is not None:
            request.add_header("Content-Type", "application/json")
        if self._token is not None:
            request.add_header("Authorization", f"Bearer {self._token}")
        try:
            return self._opener.open(request, timeout=timeout or self._timeout)
        except urllib.error.HTTPError:
            raise
        except (OSError, http.client.HTTPException) as error:
            raise MachineError(f"{self.url} cannot be reached: {getattr(error, 'reason', error)}") from None

    def _get(self, path):
        try:
            with self._open(path) as answer, _reading(self.url):
                return json.load(answer)
        except urllib.error.HTTPError as error:
            raise self._refusal(error) from None

    def _post(self, body, path="/api/v1/readings"):
        try:
            with self._open(path, body) as answer, _reading(self.url):
                return json.load(answer)
        except urllib.error.HTTPError as error:
            raise self._refusal(error) from None

    def _refusal(self, error):
        """The error of an answer that is no success."""
        with error:
            text = error.read().decode("utf-8", "replace")
        try:
            answer = json.loads(text)
            text = answer.get("error") or answer.get("problem") or text
        except (ValueError, AttributeError):
            pass
        message = f"{self.url}: {text.strip() or error.reason}"
        return MachineError(message + "; send it again") if error.code >= 500 else InputError(message)

    def __repr__(self):
        return f"<wearwell.Monitor {self.url}>"


_columns = ("alarm", "at", "level_q05", "level_q50", "level_q95", "rul_q05", "rul_q50", "rul_q95", "b10", "risk", "passed", "doubt", "beyond",
            "service", "readings")


@contextlib.contextmanager
def _reading(url):
    try:
        yield
    except (OSError, http.client.HTTPException, ValueError) as error:
        raise MachineError(f"{url}: the answer broke off or is not JSON: {error}") from None


def _lines(answer, url):
    try:
        for line in answer:
            yield line.decode("utf-8", "replace").rstrip("\r\n")
    except (OSError, http.client.HTTPException) as error:
        raise MachineError(f"{url} has ended the events: {error}") from None


def _row(unit):
    """A unit as a row. Null is infinity of a life whose unit is known, else NaN."""
    known, never = unit["known"], _inf if unit["known"] else _nan
    level, remaining = unit["level"] or {}, unit["remaining"] or {}

    def number(value, infinite=_nan):
        return infinite if value is None else value

    quantiles = ("q05", "q50", "q95")
    return [unit["alarm"], number(unit["at"]), *(number(level.get(q)) for q in quantiles), *(number(remaining.get(q), never) for q in quantiles),
            number(unit["b10"], never), number(unit["risk"]), number(unit["passed"]), unit["doubt"], unit["beyond"], unit["service"],
            unit["quality"]["readings"]]


def _records(readings):
    """Messages as dicts of plain values."""
    if hasattr(readings, "to_dict") and hasattr(readings, "columns"):
        readings = readings.to_dict("records")
    elif hasattr(readings, "keys"):
        readings = [readings]
    if not isinstance(readings, (list, tuple)) or not all(hasattr(each, "keys") for each in readings):
        raise InputError(f"readings is {type(readings).__name__}; it is a dict, a list of dicts, or a data frame")
    if not readings:
        raise InputError("readings has no rows")
    return [{str(key): value for key, value in ((key, _plain(each[key], key, row)) for key in each.keys()) if value is not None}
            for row, each in enumerate(readings, 1)]


def _plain(value, key, row):
    if hasattr(value, "isoformat"):
        return value.isoformat() if value == value else None  # NaT is missing
    if hasattr(value, "item"):
        kind = getattr(getattr(value, "dtype", None), "kind", "")
        if kind == "M":  # of numpy; its nanoseconds would be a whole number
            return value.astype("datetime64[us]").item().isoformat() if value == value else None
        value = value if kind == "m" else value.item()
    if value is None or isinstance(value, (str, bool, int)):
        return value
    if isinstance(value, float):
        if math.isinf(value):
            raise InputError(f"readings, row {row}, '{key}' is {value!r}; a number is finite")
        return None if value != value else value
    if type(value).__name__ == "NAType":
        return None
    raise InputError(f"readings, row {row}, '{key}' is {type(value).__name__}; it is a number, a text or a time")


def _bodies(records):
    """Lines of JSON in parts that the monitor takes."""
    part, size = [], 0
    for each in records:
        line = json.dumps(each, ensure_ascii=False).encode() + b"\n"
        if part and size + len(line) > _most_bytes:
            yield b"".join(part)
            part, size = [], 0
        part.append(line)
        size += len(line)
    yield b"".join(part)
