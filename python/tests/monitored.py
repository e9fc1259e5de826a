"""A monitor on a free port of this computer, over a result of the example `fleet`."""

import contextlib
import json
import socket
import subprocess
import time
import urllib.request

from conftest import binary


def _free_port():
    with socket.socket() as at:
        at.bind(("127.0.0.1", 0))
        return at.getsockname()[1]


def _wait_for(url, process):
    for _ in range(200):
        if process.poll() is not None:
            break
        with contextlib.suppress(OSError), urllib.request.urlopen(f"{url}/health", timeout=1) as answer:
            if json.load(answer)["status"] == "ok":
                return
        time.sleep(0.05)
    raise RuntimeError(f"the monitor does not answer: {process.stderr.read()}")


@contextlib.contextmanager
def monitored(folder, results, lines=(), token=None):
    """Its address, while it runs; ``lines``: messages that its store begins with."""
    url = f"http://127.0.0.1:{_free_port()}"
    with open(folder / "monitor.toml", "w") as file:
        file.write(f'''title = "Two hundred machines"
result = "{results}"
[store]
url = "fleet.sqlite"
[reading]
unit = "machine"
time = "time"
time_format = "iso 8601"
[reading.columns]
wear = {{ field = "wear_um", unit = "um" }}
use = {{ field = "use_h", unit = "h" }}
[source.line]
kind = "http"
[alarm]
horizon = "500 h"
watch = 0.05
act = 0.3
[http]
listen = "{url.removeprefix("http://")}"
''' + (f'token = "{token}"\n' if token else ""))
    process = subprocess.Popen([binary, "monitor", folder / "monitor.toml", "--quiet"], stderr=subprocess.PIPE, text=True)
    try:
        _wait_for(url, process)
        if lines:
            request = urllib.request.Request(f"{url}/api/v1/readings", data="\n".join(map(json.dumps, lines)).encode())
            request.add_header("Content-Type", "application/json")
            if token:
                request.add_header("Authorization", f"Bearer {token}")
            urllib.request.urlopen(request).close()
        yield url
    finally:
        process.terminate()
        process.wait()
        process.stderr.close()
