"""A live server on an empty data folder, and a small noisy scan to send to it."""

import contextlib
import json
import os
import re
import select
import subprocess
from pathlib import Path

import pytest

BIN = Path(os.environ["LPF_BIN_DIR"])
ROOT = Path(__file__).resolve().parent.parent.parent


def listening_port(server, seconds=30):
    """The port from the JSON line with which the server says that it is ready."""
    ready, _, _ = select.select([server.stdout], [], [], seconds)
    assert ready, f"the server said nothing for {seconds} s"
    line = json.loads(server.stdout.readline())
    assert line["event"] == "listening"
    return line["port"]


@contextlib.contextmanager
def serve(folder, *flags):
    """The address of a server with these flags, as long as it is needed."""
    with open(folder / "log", "w", encoding="utf-8") as log:
        server = subprocess.Popen(
            [BIN / "lpf-server", "--port", "0", "--admin-port", "0", "--data-dir", folder / "data",
             *flags],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=log, text=True)
    try:
        yield f"http://127.0.0.1:{listening_port(server)}"
        assert server.poll() is None, (folder / "log").read_text()
    finally:
        server.terminate()
        try:
            server.wait(timeout=35)
        except subprocess.TimeoutExpired:
            server.kill()
            server.wait()
        server.stdout.close()


@pytest.fixture(scope="session")
def url(tmp_path_factory):
    with serve(tmp_path_factory.mktemp("server")) as address:
        yield address


def simulate(path, shape="curve_on_surface", points=5000, noise=0.01):
    subprocess.run([BIN / "lpf-scan", "simulate", "--shape", shape, "--points", str(points),
                    "--noise", str(noise), "-o", path], check=True, stdout=subprocess.DEVNULL)
    return path


def vertices(path):
    """Number of points that a PLY header claims; the body must be there too."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    assert data.startswith(b"ply\n") and body
    return int(re.search(rb"element vertex (\d+)", header).group(1))


def rmse(path, shape="curve_on_surface"):
    answer = subprocess.run([BIN / "lpf-scan", "error", path, "--shape", shape], check=True,
                            capture_output=True, text=True).stdout
    return json.loads(answer)["rmse"]


@pytest.fixture(scope="session")
def scan(tmp_path_factory):
    return simulate(tmp_path_factory.mktemp("scan") / "scan.ply")


@pytest.fixture
def run(url):
    """Runs an example with arguments; its output as text. Fails if the example fails."""

    def run_example(name, *arguments, expect=0):
        done = subprocess.run(
            [ROOT / "client-examples" / "curl" / name, *map(str, arguments)],
            env={**os.environ, "LPF_URL": url}, stdin=subprocess.DEVNULL,
            capture_output=True, text=True, timeout=240, check=False)
        assert done.returncode == expect, done.stdout + done.stderr
        return done.stdout + done.stderr

    return run_example
