"""Which web pages may use the service, as a browser would ask."""

import pytest
import requests

PAGE = "https://pages.example"
EVIL = "https://evil.example"


def preflight(url, origin, method="POST", path="/v1/shapes"):
    return requests.options(url + path, timeout=10, headers={
        "Origin": origin, "Access-Control-Request-Method": method,
        "Access-Control-Request-Headers": "authorization, content-type, prefer"})


def cors_headers(answer):
    return [name for name in answer.headers if name.lower().startswith("access-control-")]


def test_nothing_is_allowed_unless_it_is_named(client):
    assert not cors_headers(preflight(client.url, PAGE))
    read = requests.get(client.url + "/v1/info", headers={"Origin": PAGE}, timeout=10)
    assert read.status_code == 200 and not cors_headers(read)


@pytest.mark.parametrize("origin", [EVIL, "null", "http://127.0.0.1:1", "https://127.0.0.1"])
@pytest.mark.parametrize("method, path", [("POST", "/v1/shapes"), ("DELETE", "/v1/jobs/x"),
                                          ("POST", "/v1/processes/denoise/execution")])
def test_a_foreign_page_changes_nothing(client, origin, method, path):
    answer = client.raw(method, path, data=b"ply", headers={"Origin": origin})
    assert answer.status_code == 403
    assert answer.json()["code"] == "forbidden"
    assert not cors_headers(answer)


def test_the_service_s_own_page_may(client, sphere):
    answer = client.post("/v1/shapes", data=sphere, headers={"Origin": client.url})
    assert answer.status_code in (200, 201)


def test_a_local_server_is_not_reached_under_a_name_of_a_stranger(start):
    """DNS rebinding: the page's own name leads to this machine, so that its origin is the host."""
    url = start().url
    for method, path in (("GET", "/v1/jobs"), ("POST", "/v1/shapes")):
        answer = requests.request(method, url + path, data=b"ply", timeout=10, headers={
            "Host": "evil.example:8080", "Origin": "http://evil.example:8080"})
        assert answer.status_code == 403, method


def test_a_named_page_may(start, sphere):
    url = start("--cors-origin", PAGE, "--cors-origin", "http://localhost:3000").url
    asked = preflight(url, PAGE)
    assert asked.status_code == 204
    assert asked.headers["Access-Control-Allow-Origin"] == PAGE
    assert "POST" in asked.headers["Access-Control-Allow-Methods"]
    allowed = asked.headers["Access-Control-Allow-Headers"].lower()
    for name in ("authorization", "content-type", "prefer", "idempotency-key", "last-event-id"):
        assert name in allowed
    sent = requests.post(url + "/v1/processes/denoise/execution", data=sphere, timeout=60,
                         headers={"Origin": PAGE})
    assert sent.status_code == 201
    assert sent.headers["Access-Control-Allow-Origin"] == PAGE
    assert "Origin" in sent.headers["Vary"]
    assert "Access-Control-Allow-Credentials" not in sent.headers
    exposed = sent.headers["Access-Control-Expose-Headers"]
    for name in ("Location", "ETag", "Retry-After", "Link", "Content-Range", "X-Request-Id",
                 "Preference-Applied", "Idempotency-Replayed", "RateLimit-Remaining"):
        assert name in exposed
    assert not cors_headers(preflight(url, EVIL))
    assert requests.post(url + "/v1/shapes", data=sphere, headers={"Origin": EVIL},
                         timeout=10).status_code == 403
    # Problems are readable for the page, too.
    missing = requests.get(url + "/v1/jobs/x", headers={"Origin": PAGE}, timeout=10)
    assert missing.status_code == 404
    assert missing.headers["Access-Control-Allow-Origin"] == PAGE


def test_a_star_is_for_all_pages(start):
    url = start("--cors-origin", "*").url
    answer = requests.post(url + "/v1/shapes", data=b"no shape", headers={"Origin": EVIL},
                           timeout=10)
    assert answer.status_code == 415
    assert answer.headers["Access-Control-Allow-Origin"] == "*"
    assert "Access-Control-Allow-Credentials" not in answer.headers


def test_every_answer_has_safe_headers(client):
    for method, path in (("GET", "/v1/info"), ("GET", "/healthz"), ("GET", "/"),
                         ("GET", "/nothing"), ("OPTIONS", "/v1/jobs"), ("HEAD", "/v1/info"),
                         ("PUT", "/v1/info")):
        answer = client.raw(method, path, data=b"x" if method == "PUT" else None)
        where = f"{method} {path}"
        assert answer.headers["X-Content-Type-Options"] == "nosniff", where
        assert answer.headers["X-Frame-Options"] == "DENY", where
        assert answer.headers["Referrer-Policy"] == "no-referrer", where
        assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"], where
        assert answer.headers["X-Request-Id"], where
        assert "Server" not in answer.headers or "/" not in answer.headers["Server"], where


@pytest.mark.parametrize("path", ["/v1/", "/v1/info", "/v1/jobs", "/v1/openapi.json", "/healthz",
                                  "/"])
def test_head_is_get_without_the_body(client, path):
    got = client.raw("GET", path)
    head = client.raw("HEAD", path)
    assert head.status_code == got.status_code
    assert head.headers["Content-Type"] == got.headers["Content-Type"]
    assert not head.content
