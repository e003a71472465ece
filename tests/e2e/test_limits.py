"""How often one client may ask, and who counts as one client."""

import json
import time

import requests

import program


def statuses(url, count, method="GET", path="/v1/conformance", **options):
    with requests.Session() as session:
        return [session.request(method, url + path, timeout=10, **options) for _ in range(count)]


def keyed(tmp_path, start, *flags):
    made = program.run(["--hash-key", "lab"], input="correct-horse-battery-staple\n")
    assert made.returncode == 0, made.stderr
    (tmp_path / "keys").write_text(made.stdout)
    server = start("--api-key-file", str(tmp_path / "keys"), *flags)
    return server, {"Authorization": "Bearer correct-horse-battery-staple"}


def test_the_limits_are_told(client):
    limits = client.get("/v1/info").json()["limits"]
    for name in ("requestsPerSecond", "requestBurst", "uploadsPerSecond", "uploadBurst"):
        assert limits[name] > 0


def test_a_key_that_asks_too_often_is_told_to_wait(tmp_path, start):
    server, headers = keyed(tmp_path, start, "--max-requests-per-second", "2",
                            "--max-request-burst", "5")
    answers = statuses(server.url, 8, headers=headers)
    assert [a.status_code for a in answers][:5] == [200] * 5
    refused = answers[-1]
    assert refused.status_code == 429
    assert refused.json()["code"] == "rate-limited"
    assert "requestsPerSecond" in refused.json()["detail"]
    assert refused.headers["RateLimit-Limit"] == "5"
    assert refused.headers["RateLimit-Remaining"] == "0"
    assert int(refused.headers["RateLimit-Reset"]) >= 1
    assert requests.get(server.url + "/healthz", timeout=10).status_code == 200
    time.sleep(int(refused.headers["Retry-After"]))
    assert requests.get(server.url + "/v1/info", headers=headers, timeout=10).status_code == 200
    metrics = requests.get(server.admin_url + "/metrics", timeout=10).text
    assert 'lpf_problems_total{code="rate-limited"}' in metrics


def test_uploads_are_counted_by_themselves(tmp_path, start):
    server, headers = keyed(tmp_path, start, "--max-uploads-per-second", "1",
                            "--max-upload-burst", "2")
    answers = statuses(server.url, 3, "POST", "/v1/shapes", headers=headers, data=b"no shape")
    assert [a.status_code for a in answers] == [415, 415, 429]
    assert "uploadsPerSecond" in answers[-1].json()["detail"]
    assert statuses(server.url, 1, headers=headers)[0].status_code == 200


def test_guessing_keys_through_a_proxy_is_slowed_down(tmp_path, start):
    server, headers = keyed(tmp_path, start, "--max-requests-per-second", "1",
                            "--max-request-burst", "3", "--trusted-proxy", "127.0.0.1")
    guess = {"Authorization": "Bearer wrong-wrong-wrong-wrong", "X-Forwarded-For": "198.51.100.7"}
    assert [a.status_code for a in statuses(server.url, 5, headers=guess)][3:] == [429, 429]
    assert statuses(server.url, 1, headers=headers)[0].status_code == 200


def test_a_script_on_this_machine_is_not_limited(start):
    url = start("--max-requests-per-second", "1", "--max-request-burst", "1").url
    assert {a.status_code for a in statuses(url, 50)} == {200}


def test_the_address_comes_from_a_trusted_proxy_only(start):
    flags = ["--max-requests-per-second", "1", "--max-request-burst", "2"]
    behind = start(*flags, "--trusted-proxy", "127.0.0.0/8")
    first = {"X-Forwarded-For": "203.0.113.9, 198.51.100.1"}
    second = {"X-Forwarded-For": "203.0.113.9, 198.51.100.2"}
    assert [a.status_code for a in statuses(behind.url, 3, headers=first)] == [200, 200, 429]
    assert statuses(behind.url, 1, headers=second)[0].status_code == 200
    behind.terminate()
    alone = start(*flags)
    assert {a.status_code for a in statuses(alone.url, 5, headers=first)} == {200}


def test_the_log_has_a_line_for_every_request_and_no_secrets(tmp_path, start):
    log = tmp_path / "log"
    server = start("--log-level", "info", log=log)
    sent = requests.get(server.url + "/v1/jobs?limit=17", timeout=10, headers={
        "X-Request-Id": "mine-1", "Authorization": "Bearer private-private-private"})
    refused = requests.post(server.url + "/v1/shapes", timeout=10,
                            files={"file": ("private-name.ply", b"no shape")})
    requests.get(server.url + "/private-path", timeout=10)
    server.terminate()
    lines = [json.loads(text) for text in log.read_text().splitlines()]
    of = {line["request"]: line for line in lines if line["event"] == "request"}
    assert of["mine-1"]["route"] == "/v1/jobs"
    assert of["mine-1"]["status"] == 200
    assert of["mine-1"]["method"] == "GET"
    assert of["mine-1"]["bytes"] == len(sent.content)
    assert of["mine-1"]["seconds"] >= 0
    assert of[refused.headers["X-Request-Id"]]["problem"] == "unsupported-format"
    assert refused.json()["requestId"] == refused.headers["X-Request-Id"]
    text = log.read_text()
    for secret in ("private", "limit=17", "127.0.0.1"):
        assert secret not in text, secret
