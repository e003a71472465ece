"""API keys: who has none stays outside, and a changed file takes effect without a restart."""

import signal
import time

import pytest
import requests

import program
from contract import Client
from shapes import noisy_sphere

KEY = "correct-horse-battery-staple"
NEXT = "the-key-of-the-next-year"


def line(name, key):
    """The line of a key file, as the server itself makes it."""
    done = program.run(["--hash-key", name], input=key + "\n")
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def keys(tmp_path, start):
    """A server with one key, and its key file. `start` is asked for to skip without a binary."""
    path = tmp_path / "keys"
    path.write_text("# keys of the lab\n\n" + line("lab", KEY))
    path.chmod(0o640)
    return start("--api-key-file", str(path), "--log-level", "info", log=tmp_path / "log"), path


def bearer(key):
    return {"Authorization": "Bearer " + key}


def test_a_key_is_needed_for_everything_below_v1(keys):
    server, _ = keys
    for path in ("/v1/", "/v1/info", "/v1/jobs", "/v1/openapi.json", "/v1/nothing"):
        refused = requests.get(server.url + path, timeout=10)
        assert refused.status_code == 401, path
        assert refused.headers["WWW-Authenticate"].startswith("Bearer")
        assert refused.headers["Content-Type"] == "application/problem+json"
        assert refused.json()["code"] == "unauthorized"
        assert refused.json()["requestId"] == refused.headers["X-Request-Id"]
    for wrong in (bearer(KEY + "x"), bearer(""), {"Authorization": "Basic " + KEY},
                  {"Authorization": KEY}, bearer(line("lab", KEY).split(":")[1].strip())):
        assert requests.get(server.url + "/v1/info", headers=wrong, timeout=10).status_code == 401
    assert requests.get(server.url + "/v1/info?key=" + KEY, timeout=10).status_code == 401


def test_health_preflight_and_page_are_open(keys):
    server, _ = keys
    assert requests.get(server.url + "/healthz", timeout=10).status_code == 200
    assert requests.get(server.url + "/", timeout=10).status_code == 200
    assert requests.options(server.url + "/v1/jobs", timeout=10).status_code == 204


def test_with_the_key_everything_works(keys):
    server, _ = keys
    client = Client(server.url, headers=bearer(KEY))
    assert client.get("/v1/info").json()["authentication"] is True
    path = client.run("denoise", noisy_sphere())
    assert client.get(path + "/results/points").status_code == 200


def test_an_upload_without_a_key_is_refused_at_once(keys):
    server, _ = keys
    begin = time.monotonic()
    refused = requests.post(server.url + "/v1/shapes", data=b"x" * 20_000_000, timeout=30)
    assert refused.status_code == 401
    assert time.monotonic() - begin < 5


def wait_for(condition):
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


def test_sighup_takes_new_keys_and_keeps_old_ones_when_the_file_is_wrong(keys, tmp_path):
    server, path = keys

    def status(key):
        return requests.get(server.url + "/v1/info", headers=bearer(key), timeout=10).status_code

    assert (status(KEY), status(NEXT)) == (200, 401)
    path.write_text(line("lab", KEY) + line("lab", NEXT))
    server.process.send_signal(signal.SIGHUP)
    wait_for(lambda: status(NEXT) == 200)
    assert status(KEY) == 200
    path.write_text("lab:" + KEY + "\n")
    server.process.send_signal(signal.SIGHUP)
    wait_for(lambda: "api-keys-kept" in (tmp_path / "log").read_text())
    assert status(KEY) == 200
    path.write_text(line("lab", NEXT))
    server.process.send_signal(signal.SIGHUP)
    wait_for(lambda: status(KEY) == 401)
    assert status(NEXT) == 200
    log = (tmp_path / "log").read_text()
    assert KEY not in log and NEXT not in log
    assert "Line 1" in log


def test_a_wrong_key_file_stops_the_start(tmp_path, start):
    del start  # asked for to skip without a binary
    for text, part in (("lab\n", "Line 1"), ("", "no key"), ("# x\nlab:abc\n", "Line 2")):
        path = tmp_path / "wrong"
        path.write_text(text)
        ended = program.run(["--port", "0", "--admin-port", "0", "--data-dir",
                             str(tmp_path / "unused"), "--api-key-file", str(path)])
        assert ended.returncode != 0
        assert part in ended.stderr


def test_weak_keys_get_no_line(start):
    del start
    ended = program.run(["--hash-key", "lab"], input="secret\n")
    assert ended.returncode == 2
    assert "16" in ended.stderr and "secret" not in ended.stdout
