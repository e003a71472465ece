"""Runs the client programs, and servers to test them against."""

import json
import os
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

from conftest import BIN, ROOT, simulate

PYTHON = [sys.executable, ROOT / "client-examples" / "python" / "lpf_client.py"]
CPP = [BIN / "lpf-client"]
SLOW = {"analysisIterations": "1000", "patternPoints": "2000", "atoms": "64"}


def environment(url, key=None, retries=None):
    """Variables for a client: the server, and a key if there is one."""
    known = {name: value for name, value in os.environ.items() if not name.startswith("LPF_")}
    known.update(LPF_URL=url, PYTHONDONTWRITEBYTECODE="1")
    if key:
        known["LPF_API_KEY"] = key
    if retries is not None:
        known["LPF_RETRIES"] = str(retries)
    return known


def client(command, url, *arguments, expect=0, **options):
    """Runs a client to its end; (stdout, stderr). Fails unless its exit code is `expect`."""
    done = subprocess.run([*command, *map(str, arguments)], env=environment(url, **options),
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
                          check=False)
    assert done.returncode == expect, (done.returncode, done.stdout, done.stderr)
    assert "Traceback" not in done.stderr
    return done.stdout, done.stderr


def key_file(folder, key):
    """A file with which a server asks for this API key."""
    made = subprocess.run([BIN / "lpf-server", "--hash-key", "lab"], input=key + "\n", check=True,
                          capture_output=True, text=True, timeout=30)
    (folder / "keys").write_text(made.stdout)
    return folder / "keys"


def get(url, path):
    """An answer of the service."""
    with urllib.request.urlopen(url + path, timeout=20) as answer:
        return json.load(answer)


def start_slow_job(url, scan):
    """A job that runs until it is dismissed, or waits if another one does; its ID."""
    query = "&".join(f"{name}={value}" for name, value in SLOW.items())
    with urllib.request.urlopen(urllib.request.Request(
            f"{url}/v1/processes/analyze/execution?{query}", scan.read_bytes(),
            {"Content-Type": "application/octet-stream"}), timeout=20) as answer:
        return json.load(answer)["jobID"]


def fill_queue(url, scan):
    """Slow jobs until no more are accepted; the first of them runs. Their IDs."""
    jobs = [start_slow_job(url, scan)]
    # While it waited for a worker, it would take the queue's place of another one.
    wait_until(lambda: get(url, "/v1/jobs?status=running")["jobs"])
    while True:
        try:
            jobs.append(start_slow_job(url, scan))
        except urllib.error.HTTPError as full:
            assert full.code == 503
            return jobs


def dismiss(url, job):
    """Takes a job back."""
    urllib.request.urlopen(urllib.request.Request(f"{url}/v1/jobs/{job}", method="DELETE"),
                           timeout=20).close()


def wait_until(condition, seconds=15):
    """The first true value of condition()."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.05)
    raise AssertionError(f"it did not happen within {seconds} s")


def interrupt_while_running(command, url, tmp_path):
    """Presses Ctrl-C in a client that is following a job; (exit code, stderr, the job's ID)."""
    scan = simulate(tmp_path / "large.ply", "sphere", 20000)
    process = subprocess.Popen(
        [*command, *map(str, arguments_of_slow_job(command, scan, tmp_path))],
        env=environment(url), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE, text=True,
        # A shell that starts the tests in the background lets them ignore SIGINT.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    try:
        job = wait_until(lambda: get(url, "/v1/jobs?status=running")["jobs"])[0]["jobID"]
        time.sleep(0.3)  # it has the job's ID by now, and is following
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=10)[1]
    finally:
        process.kill()
        process.wait()
    return process.returncode, said, job


def arguments_of_slow_job(command, scan, tmp_path):
    """`analyze` as the client takes it, with inputs that keep the server busy."""
    if command is CPP:
        return ["analyze", scan, tmp_path / "d.json", *(f"{k}={v}" for k, v in SLOW.items())]
    sets = [word for k, v in SLOW.items() for word in ("--set", f"{k}={v}")]
    return ["analyze", scan, "--dictionary", tmp_path / "d.json", *sets]
