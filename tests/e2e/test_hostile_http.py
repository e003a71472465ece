"""What the transport library of this service is known to get wrong, and what is answered instead.

Each test attacks a server that has no job to do, while a guard sees to it that /healthz goes on to
answer and that the memory stays bounded.
"""

import json
import socket
import time

import pytest
import requests

from attacker import Guard, Raw, ask, bomb, chunk, get, memory, post, status
from shapes import noisy_sphere

UPLOAD = 1 << 20  # limit of the server under attack


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    from conftest import needs_program
    from server import Server
    needs_program()
    with Server(tmp_path_factory.mktemp("hostile"), "--max-upload-bytes", str(UPLOAD),
                "--max-connections-per-client", "0", "--max-head-seconds", "3") as started:
        yield started


@pytest.fixture(scope="module")
def shape(server):
    """Path of the bytes of a stored shape."""
    answer = requests.post(server.url + "/v1/shapes", data=noisy_sphere(20_000), timeout=30)
    assert answer.status_code == 201, answer.text
    return "/v1/shapes/" + answer.json()["id"] + "/data"


def problem(answer):
    """The problem document of a raw answer."""
    return json.loads(answer.partition(b"\r\n\r\n")[2])


def test_h1_a_chunked_body_is_counted(server):
    """413 payload-too-large as soon as the limit is passed; not all of 64 MiB is read."""
    with Guard(server):
        raw = Raw(server)
        raw.send(post("/v1/shapes", "Transfer-Encoding: chunked"))
        piece = chunk(bytes(1 << 20))
        sent = 0
        while sent < 64 and raw.send(piece):
            sent += 1
        answer = raw.read_all()
        # The rest is swallowed for a while, so that the answer is not lost; then it is cut.
        assert sent < 64 or status(answer) == 413
        assert not answer or problem(answer)["code"] == "payload-too-large"
    late = post("/v1/shapes", "Transfer-Encoding: chunked") + piece + chunk(b"x") + b"0\r\n\r\n"
    assert status(ask(server, late)) == 413


def test_h2_a_web_form_is_a_body_like_any_other(server):
    """curl --data-binary sends this type: the shape is taken (201, or 200 if known)."""
    data = noisy_sphere(5000)
    answer = ask(server, post("/v1/shapes", "Content-Type: application/x-www-form-urlencoded",
                              f"Content-Length: {len(data)}") + data)
    assert status(answer) in (200, 201)


def test_h3_a_gzip_bomb_stops_at_the_limit(server):
    """413 after one limit's worth of inflated bytes, for raw bodies and for forms."""
    packed = bomb(200 << 20)
    assert len(packed) < UPLOAD
    form = "Content-Type: multipart/form-data; boundary=b"
    with Guard(server):
        for path, fields in (("/v1/shapes", []), ("/v1/processes/denoise/execution", [form]),
                             ("/v1/processes/denoise/execution",
                              ["Content-Type: application/json"])):
            start = time.monotonic()
            answer = ask(server, post(path, "Content-Encoding: gzip",
                                      f"Content-Length: {len(packed)}", *fields) + packed)
            assert status(answer) in (400, 413), answer[:200]
            assert time.monotonic() - start < 5
    other = ask(server, post("/v1/shapes", "Content-Encoding: br", "Content-Length: 1") + b"x")
    assert (status(other), problem(other)["code"]) == (415, "unsupported-media-type")


def test_h4_many_ranges_give_the_file_once(server, shape):
    """200 with the whole file: several ranges are not served here."""
    ranges = "Range: bytes=" + ",".join("0-" for _ in range(50))
    size = int(requests.head(server.url + shape, timeout=10).headers["Content-Length"])
    with Guard(server):
        answer = ask(server, get(shape, ranges))
        assert status(answer) == 200
        assert len(answer.partition(b"\r\n\r\n")[2]) == size


def test_h5_a_range_behind_the_end_is_not_satisfiable(server, shape):
    """416 with Content-Range: bytes */SIZE and a whole problem document."""
    size = int(requests.head(server.url + shape, timeout=10).headers["Content-Length"])
    for wanted in (f"{size}-", "99999999999-", f"{size}-{size + 5}", "-0"):
        answer = ask(server, get(shape, f"Range: bytes={wanted}"))
        assert status(answer) == 416, wanted
        assert f"Content-Range: bytes */{size}\r\n".encode() in answer
        assert problem(answer)["code"] == "range-not-satisfiable"
    beyond = ask(server, get(shape, f"Range: bytes={size - 10}-{size + 1000}"))
    assert status(beyond) == 206 and len(beyond.partition(b"\r\n\r\n")[2]) == 10
    error = ask(server, get("/v1/nothing", "Range: bytes=0-3"))
    assert problem(error)["code"] == "not-found"


def test_h6_clients_that_are_slow_to_ask_or_to_read_starve_nobody(server, shape):
    """Heads byte by byte end with 408; unread downloads go on; others are served at once."""
    with Guard(server):
        heads = [Raw(server) for _ in range(200)]
        readers = [Raw(server, receive_buffer=4096) for _ in range(64)]
        for raw in readers:
            raw.send(get(shape))
        end = time.monotonic() + 6
        while time.monotonic() < end:
            for raw in heads:
                raw.send(b"G")
            start = time.monotonic()
            assert requests.get(server.url + "/v1/info", timeout=10).status_code == 200
            assert time.monotonic() - start < 2
            time.sleep(0.5)
        assert {status(raw.read_all()) for raw in heads} <= {408, 0}
        for raw in heads + readers:
            raw.close()


def test_h6_slow_uploads_starve_nobody(server):
    """100 bodies that trickle in: other requests, other uploads among them, go on."""
    with Guard(server):
        slow = [Raw(server) for _ in range(100)]
        for raw in slow:
            raw.send(post("/v1/shapes", "Content-Length: 100000") + b"p")
        answer = requests.post(server.url + "/v1/shapes", data=noisy_sphere(300), timeout=10)
        assert answer.status_code in (200, 201)
        more = [Raw(server) for _ in range(40)]
        refused = 0
        for raw in more:
            raw.send(post("/v1/shapes", "Content-Length: 100000") + b"p")
        time.sleep(1)
        for raw in more:
            raw.socket.setblocking(False)
            try:
                refused += status(raw.socket.recv(4096)) == 503
            except BlockingIOError:
                pass
        assert refused >= 40 - 28  # 128 at a time
        for raw in slow + more:
            raw.close()


def test_h7_idle_connections_are_cheap(server):
    """1500 of them: connecting takes no time, and a GET neither."""
    with Guard(server):
        start = time.monotonic()
        idle = [Raw(server) for _ in range(1500)]
        assert time.monotonic() - start < 10
        start = time.monotonic()
        assert requests.get(server.url + "/v1/info", timeout=10).status_code == 200
        assert time.monotonic() - start < 2
        for raw in idle:
            raw.close()


def test_h7_connections_have_a_limit(start):
    """503 with Retry-After in all, 429 for one address; both go away with the crowd."""
    for flag, code in (("--max-connections", 503), ("--max-connections-per-client", 429)):
        small = start("--max-connections-per-client", "0", flag, "20")
        crowd = [Raw(small) for _ in range(20)]
        time.sleep(0.3)
        answer = ask(small, get("/healthz"))
        assert status(answer) == code and b"\r\nRetry-After: 1\r\n" in answer
        for raw in crowd:
            raw.close()
        time.sleep(0.5)
        assert requests.get(small.url + "/healthz", timeout=10).status_code == 200
        small.terminate()


def test_h8_heads_are_bounded(server):
    """431 after 32 KiB or 100 fields, however much follows."""
    with Guard(server):
        raw = Raw(server)
        raw.send(b"GET / HTTP/1.1\r\nHost: h\r\nA: ")
        sent = 0
        while sent < 80 and raw.send(b"a" * (1 << 20)):
            sent += 1
        answer = raw.read_all()
        assert status(answer) in (431, 0)
        assert sent < 80 or answer
    assert status(ask(server, get("/", "A: " + "a" * 40_000))) == 431
    assert status(ask(server, get("/", *[f"A{i}: b" for i in range(20_000)]))) in (431, 0)
    assert status(ask(server, get("/", *[f"A{i}: b" for i in range(101)]))) == 431


@pytest.mark.parametrize("fields", [
    ["Content-Length: abc"],
    ["Content-Length: -1"],
    ["Content-Length: +5"],
    ["Content-Length: 5, 5"],
    ["Content-Length: 5", "Content-Length: 6"],
    ["Content-Length: 5", "Content-Length: 5"],
    ["Content-Length: 5", "Transfer-Encoding: chunked"],
    ["Transfer-Encoding: chunked", "Transfer-Encoding: identity"],
    ["Transfer-Encoding: xchunked"],
    ["Transfer-Encoding: chunked, identity"],
    ["Transfer-Encoding : chunked"],
    ["Transfer-Encoding:\x0bchunked"],
    ["Content-Length: 5\n", "A: b"],
    ["A: b\r\n c", "Content-Length: 5"],
    ["A: b\x00c", "Content-Length: 5"],
    ["A: b\rContent-Length: 5"],
], ids=range(16))
def test_h9_ambiguous_requests_are_refused(server, fields):
    """400 and the end of the connection: what follows is never taken for a request."""
    start = time.monotonic()
    answer = ask(server, post("/v1/shapes", *fields) + b"5\r\nGET /v1/info HTTP/1.1\r\nHost: h\r\n\r\n")
    assert status(answer) == 400
    assert answer.count(b"HTTP/1.1 ") == 1
    assert time.monotonic() - start < 4


def test_h9_nobody_forges_the_address(server):
    """REMOTE_ADDR in a request is a header like any other."""
    answer = ask(server, get("/healthz", "REMOTE_ADDR: 10.0.0.1", "LOCAL_ADDR: 10.0.0.2"))
    assert status(answer) == 200 and b"10.0.0." not in answer


def test_h10_a_large_length_is_refused_before_the_body(server):
    """413 at once, without 100 Continue."""
    with Guard(server):
        for fields in ([], ["Expect: 100-continue"]):
            raw = Raw(server)
            raw.send(post("/v1/shapes", f"Content-Length: {200 << 20}", *fields))
            start = time.monotonic()
            answer = raw.read_all()
            assert status(answer) == 413 and b"100 Continue" not in answer
            assert time.monotonic() - start < 2
            raw.close()


def test_h10_a_body_that_is_wanted_is_asked_for(server):
    """100 Continue, and then the answer."""
    data = noisy_sphere(200)
    raw = Raw(server)
    raw.send(post("/v1/shapes", f"Content-Length: {len(data)}", "Expect: 100-continue"))
    assert raw.socket.recv(25) == b"HTTP/1.1 100 Continue\r\n\r\n"
    assert status(raw.ask(data)) in (200, 201)


def test_h11_no_exception_is_told(server):
    """Whatever fails inside, no header and no body names it."""
    for request in (get("/v1/jobs/%ff%fe"), get("/v1/shapes/" + "a" * 5000),
                    post("/v1/processes/denoise/execution", "Content-Type: application/json",
                         "Content-Length: 7") + b'{"a":1}',
                    post("/v1/shapes", "Content-Length: 4") + b"ply\n"):
        answer = ask(server, request)
        assert 400 <= status(answer) < 500, answer
        assert b"EXCEPTION" not in answer and b"what()" not in answer


@pytest.mark.parametrize("disposition, taken", [
    ('form-data; filename="a.ply"; name="file"', True),
    ("form-data; name=file; filename=a.ply", True),
    ("form-data; filename*=UTF-8''na%C3%AFve.ply; name=file", True),
    ('form-data; filename="a.ply"', False),
    ('form-data; name=""; filename="a.ply"', False),
    ('form-data; name="' + "a" * 10_000 + '"', False),
    ('attachment; name="file"', False),
], ids=["reordered", "unquoted", "extended", "unnamed", "empty", "long", "attachment"])
def test_h12_forms_are_read_by_the_book(server, disposition, taken):
    """A part has a name, however it is written, or the form is refused with 400."""
    body = (f"--b\r\nContent-Disposition: {disposition}\r\n\r\n".encode() + noisy_sphere(300) +
            b"\r\n--b--\r\n")
    answer = ask(server, post("/v1/processes/analyze/execution",
                              "Content-Type: multipart/form-data; boundary=b",
                              f"Content-Length: {len(body)}") + body)
    assert status(answer) == (201 if taken else 400), answer
    if taken:
        job = json.loads(answer.partition(b"\r\n\r\n")[2])["jobID"]
        requests.delete(server.url + "/v1/jobs/" + job, timeout=10)


def test_h13_time_limits_hold_for_high_descriptors(server):
    """A head that does not come ends with 408 also behind 1100 other connections."""
    idle = [Raw(server) for _ in range(1100)]
    late = Raw(server)
    late.send(b"GET / HT")
    start = time.monotonic()
    assert status(late.read_all()) == 408
    assert time.monotonic() - start < 8
    for raw in idle:
        raw.close()


def test_h14_a_stop_waits_for_nobody_for_long(start):
    """Silent, slow and unreading clients: exit code 0 within the patience of 10 s."""
    leaving = start("--max-connections-per-client", "0")
    clients = [Raw(leaving) for _ in range(40)]
    for raw in clients[:10]:
        raw.send(b"GET / HT")
    for raw in clients[10:20]:
        raw.send(post("/v1/shapes", "Content-Length: 1000") + b"p")
    for raw in clients[20:30]:
        raw.send(get("/v1/openapi.json"))
    time.sleep(0.3)
    begin = time.monotonic()
    assert leaving.terminate() == 0
    assert time.monotonic() - begin < 15


def test_h15_a_post_without_length_is_answered_at_once(server):
    """411, and 414 for a long target."""
    for request, code in ((post("/v1/shapes"), 411), (get("/" + "a" * 9000), 414)):
        raw = Raw(server)
        raw.send(request)
        start = time.monotonic()
        assert raw.socket.recv(12) == f"HTTP/1.1 {code}".encode()
        assert time.monotonic() - start < 2
        raw.close()


def test_connections_are_kept_for_the_next_request(server):
    """Two requests on one connection; a body that is not wanted ends it."""
    with requests.Session() as session:
        for _ in range(3):
            answer = session.get(server.url + "/v1/info", timeout=10)
            assert answer.headers.get("Connection", "").lower() != "close"
    hidden = get("/v1/info")
    answer = ask(server, post("/v1/nothing", f"Content-Length: {len(hidden)}") + hidden)
    assert answer.count(b"HTTP/1.1 ") == 1 and b"Connection: close" in answer


def test_running_out_of_descriptors_is_survived(start):
    """Connections wait, or are refused, until others end; then all is as before."""
    poor = start("--max-connections-per-client", "0", descriptors=64)
    crowd = []
    for _ in range(100):
        raw = Raw(poor)
        crowd.append(raw)
    time.sleep(0.5)
    before = cpu_seconds(poor)
    time.sleep(1)
    assert cpu_seconds(poor) - before < 0.5, "the server runs in a circle"
    for raw in crowd:
        raw.close()
    time.sleep(0.5)
    assert requests.get(poor.url + "/healthz", timeout=10).status_code == 200


def cpu_seconds(server):
    with open(f"/proc/{server.pid}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def test_at_the_end_the_memory_was_bounded(server):
    """After all of the above, on the same server."""
    assert memory(server) < 256 << 20
    assert socket.create_connection(("127.0.0.1", int(server.url.rpartition(":")[2])), timeout=5)
