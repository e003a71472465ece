"""What the service says about itself."""

import pytest
import requests

import program


@pytest.mark.parametrize("path", ["/v1/", "/v1/conformance", "/v1/info", "/v1/processes",
                                  "/v1/processes/denoise", "/v1/processes/resample",
                                  "/v1/processes/analyze", "/v1/jobs", "/v1/dictionaries",
                                  "/healthz"])
def test_documents_are_served(client, path):
    assert client.get(path).status_code == 200


def test_openapi_is_version_3_1(client):
    assert client.contract.document["openapi"].startswith("3.1")


def test_links_of_the_landing_page_lead_somewhere(client):
    for link in client.get("/v1/").json()["links"]:
        assert client.raw("GET", link["href"]).status_code == 200, link


def test_info_shows_the_limits(client):
    info = client.get("/v1/info").json()
    assert info["limits"]["uploadBytes"] > 0
    assert info["queue"]["workers"] >= 1


def test_every_input_is_described(client):
    inputs = client.get("/v1/processes/resample").json()["inputs"]
    assert {"shape", "radius", "factor", "targetPoints", "dictionary"} <= set(inputs)
    assert all("schema" in entry for entry in inputs.values())


@pytest.mark.parametrize("method, path, status", [
    ("GET", "/v1/nothing", 404), ("GET", "/v1/jobs/", 404), ("GET", "/../etc/passwd", 404),
    ("PUT", "/v1/jobs", 405), ("DELETE", "/v1/processes/denoise", 405),
    ("POST", "/v1/info", 405), ("GET", "/v1/shapes", 405),
    ("GET", "/v1/processes/denoise/execution", 405), ("OPTIONS", "/v1/jobs", 204)])
def test_wrong_paths_and_methods(client, method, path, status):
    data = b"x" if method in ("PUT", "POST") else None
    answer = client.raw(method, path, data=data)
    assert answer.status_code == status
    if status >= 400:
        assert answer.headers["Content-Type"] == "application/problem+json"
        assert answer.json()["status"] == status
    if status == 405:
        assert "GET" in answer.headers["Allow"] or "POST" in answer.headers["Allow"]


def test_unknown_process(client):
    answer = client.raw("POST", "/v1/processes/melt/execution", data=b"ply")
    assert (answer.status_code, answer.json()["code"]) == (404, "process-not-found")


def test_a_misspelt_query_is_refused(client):
    assert client.get("/v1/jobs?stauts=running").status_code == 400


def test_web_page(client):
    page = client.raw("GET", "/")
    assert page.status_code == 200 and "text/html" in page.headers["Content-Type"]
    assert "default-src 'none'" in page.headers["Content-Security-Policy"]


def test_web_folder(start, tmp_path):
    folder = tmp_path / "web"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html><title>Mine</title>")
    (folder / "decoder.wasm").write_bytes(b"\0asm")
    (tmp_path / "outside.txt").write_text("outside")
    url = start("--web-dir", str(folder)).url
    page = requests.get(url + "/", timeout=10)
    assert "Mine" in page.text and "script-src 'self'" in page.headers["Content-Security-Policy"]
    wasm = requests.get(url + "/decoder.wasm", timeout=10)
    assert wasm.headers["Content-Type"] == "application/wasm" and wasm.content == b"\0asm"
    for path in ("/..%2foutside.txt", "/%2e%2e/outside.txt", "/nothing.js"):
        assert requests.get(url + path, timeout=10).status_code == 404, path


def test_request_ids_come_back(client):
    answer = client.get("/v1/info", headers={"X-Request-Id": "my-id.7"})
    assert answer.headers["X-Request-Id"] == "my-id.7"


def test_admin_listener(start):
    server = start()
    assert requests.get(server.admin_url + "/healthz", timeout=10).status_code == 200
    assert requests.get(server.admin_url + "/readyz", timeout=10).json()["status"] == "ready"
    metrics = requests.get(server.admin_url + "/metrics", timeout=10)
    assert "lpf_queue_depth 0" in metrics.text
    assert requests.get(server.url + "/metrics", timeout=10).status_code == 404


def environment_of(pid):
    """As text; glibc cuts its own variable into pieces where it lies."""
    with open(f"/proc/{pid}/environ", encoding="utf-8") as file:
        return file.read().replace("\0", ":")


@pytest.mark.parametrize("told, expected", [
    (None, "glibc.malloc.hugetlb=1"),
    ("glibc.malloc.arena_max=3", "glibc.malloc.hugetlb=1:glibc.malloc.arena_max=3"),
    ("glibc.malloc.hugetlb=0", "glibc.malloc.hugetlb=0")])
def test_asks_for_large_pages_unless_told_not_to(start, monkeypatch, told, expected):
    if told and program.IMAGE:
        pytest.skip("a container has an environment of its own")
    if told:
        monkeypatch.setenv("GLIBC_TUNABLES", told)
    else:
        monkeypatch.delenv("GLIBC_TUNABLES", raising=False)
    server = start()
    assert f"GLIBC_TUNABLES={expected}:" in environment_of(server.pid)
    with open(f"/proc/{server.pid}/comm", encoding="utf-8") as file:
        assert file.read().strip() == "lpf-server"
    assert requests.get(server.url + "/v1/info", timeout=10).status_code == 200
