"""Files as strangers send them: every bad one is a clear refusal, and the server lives on."""

import gzip
import struct

import pytest

from shapes import ascii_ply, binary_ply, header, noisy_sphere

XYZ = [("float", "x"), ("float", "y"), ("float", "z")]
GOOD = binary_ply([(i % 10, i // 10, 0.0) for i in range(100)], XYZ)


def with_header(text):
    return b"ply\n" + text.encode() + b"end_header\n" + b"\0" * 64


def draco(points=100, version=(2, 3), kind=0, method=0):
    """The head of a Draco stream that claims so many points, and nothing behind it."""
    return b"DRACO" + bytes([*version, kind, method, 0, 0]) + struct.pack("<i", points) + b"\1" * 16


MALFORMED = {
    "empty": b"",
    "one_byte": b"p",
    "lfs_pointer": b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12\n",
    "off_with_huge_count": b"OFF\n353535235358 353535235358 0\n0 0 0\n",
    "obj": b"v 0 0 0\nv 1 0 0\nf 1 2 1\n",
    "html": b"<!doctype html><html></html>",
    "json": b'{"points": []}',
    "gzip_named_ply": gzip.compress(GOOD),
    "magic_only": b"ply\n",
    "no_end_of_header": b"ply\nformat ascii 1.0\nelement vertex 3\n",
    "unknown_format": with_header("format asciii 1.0\nelement vertex 1\n"),
    "unknown_version": with_header("format ascii 2.0\nelement vertex 1\n"),
    "no_format": with_header("element vertex 1\nproperty float x\n"),
    "no_count": with_header("format ascii 1.0\nelement vertex\n"),
    "count_is_a_word": with_header("format ascii 1.0\nelement vertex many\n"),
    "negative_count": header(-1, XYZ) + b"\0" * 24,
    "count_of_4_billion": header(4_000_000_000, XYZ) + b"\0" * 24,
    "count_of_2_to_64": header(2 ** 64, XYZ) + b"\0" * 24,
    "count_over_the_limit": header(30_000_000, XYZ, "ascii") + b"0 0 0\n" * 100,
    "truncated_binary": GOOD[:-5],
    "truncated_ascii": ascii_ply([(0, 0, 0)] * 5, count=9),
    "word_for_a_number": ascii_ply([(0, 0, 0)]).replace(b"0 0 0", b"0 x 0"),
    "no_z": header(3, XYZ[:2]) + b"\0" * 24,
    "x_twice": header(3, XYZ + XYZ[:1]) + b"\0" * 48,
    "unknown_type": header(3, [("floatt", "x")] + XYZ[1:]) + b"\0" * 36,
    "two_vertex_elements": header(1, XYZ, extra="element vertex 1\nproperty float x\n") + b"\0" * 16,
    "no_vertex": with_header("format binary_little_endian 1.0\nelement point 1\nproperty int a\n"),
    "endless_header_line": b"ply\nformat ascii 1.0\ncomment " + b"a" * 200_000,
    "nul_in_header": b"ply\0\nformat ascii 1.0\nelement vertex 0\nend_header\n",
    "face_out_of_range": header(3, XYZ, extra="element face 1\nproperty list uchar int vertex_indices\n")
    + b"\0" * 36 + b"\3" + struct.pack("<3i", 0, 1, 99),
    "list_of_2_billion": header(3, XYZ, extra="element face 1\nproperty list int int vertex_indices\n")
    + b"\0" * 36 + struct.pack("<2i", 0x7FFFFFFF, 0),
    "only_nan": binary_ply([(float("nan"),) * 3] * 10, XYZ),
    "draco_of_2_billion_points": draco(points=2_000_000_000),
    "draco_of_unknown_version": draco(version=(9, 9)),
    "draco_of_unknown_kind": draco(kind=7),
    "draco_cut": draco()[:8],
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_files_are_refused(client, name):
    for path in ("/v1/shapes", "/v1/processes/denoise/execution"):
        answer = client.post(path, data=MALFORMED[name] or b"")
        assert answer.status_code in (413, 415, 422), answer.text
        assert len(answer.json()["detail"]) > 15
    assert client.get("/healthz").status_code == 200


@pytest.mark.parametrize("name, data", [
    ("no points", ascii_ply([])), ("one point", ascii_ply([(1, 2, 3)])),
    ("two points", ascii_ply([(1, 2, 3), (2, 2, 3)])),
    ("one place", ascii_ply([(1, 2, 3)] * 50))])
def test_shapes_without_extent_are_stored_but_no_job_is_made_of_them(client, name, data):
    shape = client.post("/v1/shapes", data)
    assert shape.status_code in (200, 201)
    answer = client.execute("denoise", data)
    assert answer.status_code == 422, name
    assert answer.json()["code"] in ("too-few-points", "degenerate-shape")


def test_points_that_are_not_finite_are_dropped_and_told(client):
    rows = [(i % 20, i // 20, 0.0) for i in range(400)] + [(float("inf"), 0, 0)] * 3
    job = client.finish(client.execute("denoise", binary_ply(rows, XYZ)).json())
    assert job["status"] == "successful"
    assert sum("non-finite" in w["code"] for w in job["warnings"]) == 1


@pytest.mark.parametrize("name, points", [
    ("line", [(i / 10, 0, 0) for i in range(60)]),
    ("plane", [(i % 10, i // 10, 0) for i in range(100)]),
    ("three points", [(0, 0, 0), (1, 0, 0), (0, 1, 0)]),
    ("far away", [(1e7 + i % 10, 1e7 + i // 10, 1e7) for i in range(100)])])
def test_degenerate_shapes_have_a_defined_end(client, name, points):
    for process in ("denoise", "resample", "analyze"):
        job = client.finish(client.execute(process, ascii_ply(points)).json())
        assert job["status"] in ("successful", "failed"), name
        if job["status"] == "failed":
            assert job["exception"]["status"] == 422, job["exception"]


def test_a_shape_is_stored_once(client):
    data = noisy_sphere(50, seed=99)
    first = client.post("/v1/shapes", data)
    second = client.post("/v1/shapes", data)
    assert (first.status_code, second.status_code) == (201, 200)
    assert first.json()["id"] == second.json()["id"]
    path = first.headers["Location"]
    assert client.get(path).json()["points"] == 50
    assert client.get(path + "/data").content == data
    assert client.request("HEAD", path).status_code == 200
    assert client.delete(path).status_code == 204
    assert client.get(path).status_code == 404
    assert client.delete(path).status_code == 404


def test_compressed_upload(client):
    data = noisy_sphere(60, seed=98)
    answer = client.post("/v1/shapes", gzip.compress(data), headers={"Content-Encoding": "gzip"})
    assert answer.status_code == 201
    assert answer.json()["bytes"] == len(data)


def test_chunked_upload(client):
    data = noisy_sphere(70, seed=97)
    answer = client.post("/v1/shapes", iter([data[:100], data[100:]]))
    assert answer.status_code == 201 and answer.json()["points"] == 70


@pytest.mark.parametrize("body", [
    b'--b\r\nContent-Disposition: form-data; filename="x"\r\n\r\nabc\r\n--b--\r\n',
    b'--b\r\nContent-Disposition: form-data; name="atoms"\r\n\r\n4\r\n--b--\r\n',
    b'--b\r\nContent-Disposition: form-data; name="file"\r\n\r\nabc', b"nonsense"])
def test_broken_forms(client, body):
    answer = client.execute("denoise", body,
                            headers={"Content-Type": "multipart/form-data; boundary=b"})
    assert answer.status_code == 400, answer.text


def test_post_without_length_is_411(client):
    import http.client
    from urllib.parse import urlparse
    connection = http.client.HTTPConnection(urlparse(client.url).netloc, timeout=10)
    connection.putrequest("POST", "/v1/shapes")
    connection.endheaders()
    assert connection.getresponse().status == 411


def test_limits_of_size(start):
    from contract import Client
    small = Client(start("--max-upload-bytes", "5000", "--max-points", "50").url)
    assert small.post("/v1/shapes", b"a" * 6000).json()["code"] == "payload-too-large"
    assert small.post("/v1/shapes", iter([b"a" * 3000] * 3)).json()["code"] == "payload-too-large"
    bomb = gzip.compress(b"a" * 50_000_000)[:5000]
    assert small.post("/v1/shapes", bomb,
                      headers={"Content-Encoding": "gzip"}).status_code in (400, 413)
    answer = small.post("/v1/shapes", GOOD)
    assert (answer.status_code, answer.json()["code"]) == (413, "limit-exceeded")
    assert small.get("/v1/info").json()["limits"]["points"] == 50
