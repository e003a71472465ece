"""nginx with the configuration that is shipped, in front of the built server."""

import contextlib
import hashlib
import math
import os
import random
import shutil
import socket
import struct
import subprocess
import threading
import time
from pathlib import Path

import pytest
import requests

from contract import Client
from shapes import header, noisy_sphere

NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin")
CONFIGURATION = Path(__file__).resolve().parents[2] / "deploy" / "nginx.conf"

pytestmark = pytest.mark.skipif(not NGINX, reason="nginx is not installed (nginx-light)")


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Proxy:
    """A running nginx: only addresses and folders differ from what is shipped."""

    def __init__(self, folder, server_url):
        self.port = free_port()
        self.url = f"http://127.0.0.1:{self.port}"
        text = CONFIGURATION.read_text()
        for shipped, here in (("listen 8080", f"listen 127.0.0.1:{self.port}"),
                              ("server lpf-server:8080", "server " + server_url.split("//")[1]),
                              ("/tmp/", f"{folder}/"), ("/dev/stdout", f"{folder}/access.log")):
            assert shipped in text
            text = text.replace(shipped, here)
        folder.mkdir()
        folder.chmod(0o777)  # nginx's workers are another user when this runs as root
        (folder / "nginx.conf").write_text(text)
        self.process = subprocess.Popen([NGINX, "-p", str(folder), "-c", str(folder / "nginx.conf"),
                                         "-g", "daemon off;"])
        self.log = folder / "access.log"
        deadline = time.monotonic() + 10
        while True:
            with contextlib.suppress(requests.ConnectionError):
                requests.get(self.url + "/healthz", timeout=5)
                return
            assert self.process.poll() is None and time.monotonic() < deadline
            time.sleep(0.05)

    def stop(self):
        self.process.terminate()
        self.process.wait(timeout=20)


@pytest.fixture
def proxied(tmp_path, start):
    server = start("--trusted-proxy", "127.0.0.1", "--max-connections-per-client", "0")
    # Below the system's folder for temporary files, as nginx's workers may not read pytest's own.
    folder = Path("/tmp") / f"lpf-nginx-{os.getpid()}-{free_port()}"
    proxy = Proxy(folder, server.url)
    yield server, proxy
    proxy.stop()
    shutil.rmtree(folder, ignore_errors=True)


def connections(port):
    """Established connections of the server at this port, as the kernel lists them."""
    count = 0
    for line in Path("/proc/net/tcp").read_text().splitlines()[1:]:
        fields = line.split()
        count += int(fields[1].split(":")[1], 16) == port and fields[3] == "01"
    return count


def slow_upload(port, stop):
    """Sends a head and then a byte a second, as one does who means harm or has a bad line."""
    with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port)) as line:
        line.sendall(b"POST /v1/shapes HTTP/1.1\r\nHost: lpf\r\n"
                     b"Content-Length: 100000\r\n\r\nply\n")
        while not stop.wait(1):
            line.sendall(b"x")


def test_slow_clients_are_held_off(proxied):
    server, proxy = proxied
    port = int(server.url.rsplit(":", 1)[1])
    stop = threading.Event()
    crowd = [threading.Thread(target=slow_upload, args=(proxy.port, stop)) for _ in range(200)]
    for one in crowd:
        one.start()
    try:
        time.sleep(2)
        direct, through, most = [], [], 0
        for _ in range(50):
            for url, times in ((server.url, direct), (proxy.url, through)):
                begin = time.monotonic()
                assert requests.get(url + "/v1/jobs", timeout=10).status_code == 200
                times.append(time.monotonic() - begin)
            most = max(most, connections(port))
        assert connections(proxy.port) >= 200, "the crowd is not there"
        assert most <= 20, "slow clients reach the server"
        assert sorted(direct)[45] < 0.5 and sorted(through)[45] < 0.5
    finally:
        stop.set()
        for one in crowd:
            one.join()


def large_scan(points, bands=200):
    """A wavy sheet whose points carry many bands of a camera: 812 bytes each."""
    dice = random.Random(7)
    properties = [("float", axis) for axis in "xyz"]
    properties += [("uint", f"band{i}") for i in range(bands)]
    rows = []
    for _ in range(points):
        x, y = dice.uniform(0, 50), dice.uniform(0, 50)
        rows.append(struct.pack("<fff", x, y, math.sin(x)) + dice.randbytes(4 * bands))
    return header(points, properties) + b"".join(rows)


def test_large_files_pass_both_ways(proxied):
    _, proxy = proxied
    scan = large_scan(65_000)
    assert len(scan) > 50_000_000
    client = Client(proxy.url)
    stored = client.post("/v1/shapes", data=scan)
    assert stored.status_code == 201
    assert stored.json()["sha256"] == hashlib.sha256(scan).hexdigest()
    path = f"/v1/shapes/{stored.json()['id']}/data"
    assert client.get(path).content == scan
    part = client.get(path, headers={"Range": "bytes=1000000-1999999",
                                     "Accept-Encoding": "gzip"})
    assert part.status_code == 206 and part.content == scan[1_000_000:2_000_000]


def test_too_large_files_are_refused(proxied):
    _, proxy = proxied
    with socket.create_connection(("127.0.0.1", proxy.port)) as line:
        line.sendall(b"POST /v1/shapes HTTP/1.1\r\nHost: lpf\r\n"
                     b"Content-Length: 700000000\r\n\r\n")
        answer = line.recv(4096)
        assert b" 413 " in answer.split(b"\r\n")[0]
        assert b"application/problem+json" in answer


def test_events_arrive_while_they_happen(proxied):
    _, proxy = proxied
    client = Client(proxy.url)
    job = client.execute("denoise", noisy_sphere(20000)).json()
    with requests.get(f"{proxy.url}/v1/jobs/{job['jobID']}/events", stream=True,
                      timeout=60) as stream:
        assert stream.status_code == 200
        assert stream.headers["Content-Type"].startswith("text/event-stream")
        assert "Content-Encoding" not in stream.headers
        begin = time.monotonic()
        pieces = stream.iter_content(None)
        first = next(pieces)
        assert first and time.monotonic() - begin < 5
        rest = b"".join(pieces)
    assert b"event: end" in first + rest


def test_a_waiting_stream_gives_its_first_event_at_once(proxied):
    """A job that takes long: its first event must not wait in a buffer for its last."""
    _, proxy = proxied
    client = Client(proxy.url)
    job = client.execute("denoise", large_scan(60_000, bands=0), "?analysisIterations=1000").json()
    begin = time.monotonic()
    with requests.get(f"{proxy.url}/v1/jobs/{job['jobID']}/events", stream=True,
                      timeout=60) as stream:
        next(stream.iter_content(None))
        assert time.monotonic() - begin < 5
        assert client.get("/v1/jobs/" + job["jobID"]).json()["status"] in ("accepted", "running")
    assert client.delete("/v1/jobs/" + job["jobID"]).json()["status"] == "dismissed"


def test_ids_addresses_and_logs(proxied):
    server, proxy = proxied
    own = requests.get(proxy.url + "/v1/info?secret=1", headers={"X-Request-Id": "mine-2"},
                       timeout=10)
    assert own.headers["X-Request-Id"] == "mine-2"
    forged = requests.get(proxy.url + "/v1/info", headers={"X-Request-Id": "not harmless"},
                          timeout=10)
    assert forged.headers["X-Request-Id"] != "not harmless"
    text = proxy.log.read_text()
    assert "mine-2" in text and "secret" not in text and "127.0.0.1" not in text
    zipped = requests.get(proxy.url + "/v1/openapi.json", timeout=10)
    assert zipped.headers["Content-Encoding"] == "gzip"
    assert server.terminate() == 0
    gone = requests.get(proxy.url + "/v1/info", timeout=20)
    assert gone.status_code == 503
    assert gone.headers["Content-Type"] == "application/problem+json"
    assert gone.json()["code"] == "unavailable" and gone.headers["Retry-After"]
    assert gone.json()["requestId"] == gone.headers["X-Request-Id"]
