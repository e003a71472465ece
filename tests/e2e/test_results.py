"""Fetching results: tags, ranges, formats."""

import pytest


def test_tags_let_a_client_keep_what_it_has(client, done):
    points = done + "/results/points"
    tag = client.get(points).headers["ETag"]
    answer = client.get(points, headers={"If-None-Match": f'"other", {tag}'})
    assert answer.status_code == 304 and answer.headers["ETag"] == tag
    assert client.get(points, headers={"If-None-Match": '"other"'}).status_code == 200


@pytest.mark.parametrize("asked, first, last", [
    ("bytes=0-9", 0, 9), ("bytes=100-", 100, None), ("bytes=-7", -7, None)])
def test_ranges(client, done, asked, first, last):
    points = done + "/results/points"
    whole = client.get(points).content
    answer = client.get(points, headers={"Range": asked})
    assert answer.status_code == 206
    assert answer.content == (whole[first:] if last is None else whole[first:last + 1])
    assert answer.headers["Content-Range"].endswith(f"/{len(whole)}")


def test_a_download_is_taken_up_again(client, done):
    points = done + "/results/points"
    whole = client.get(points)
    rest = client.get(points, headers={"Range": "bytes=1000-", "If-Range": whole.headers["ETag"]})
    assert rest.status_code == 206 and whole.content[:1000] + rest.content == whole.content
    other = client.get(points, headers={"Range": "bytes=1000-", "If-Range": '"other"'})
    assert other.status_code == 200


def test_ranges_that_cannot_be_had(client, done):
    points = done + "/results/points"
    answer = client.get(points, headers={"Range": "bytes=999999999-"})
    assert answer.status_code == 416 and answer.headers["Content-Range"].startswith("bytes */")
    many = "bytes=" + ",".join("0-" for _ in range(50))
    assert client.get(points, headers={"Range": many}).status_code == 200


def test_head_tells_the_length(client, done):
    for name in ("points", "dictionary", "report", "fields"):
        path = f"{done}/results/{name}"
        head = client.request("HEAD", path, headers={"Accept-Encoding": "identity"})
        body = client.get(path, headers={"Accept-Encoding": "identity"})
        assert head.headers["Content-Length"] == str(len(body.content)), name


@pytest.mark.parametrize("query, accept, start", [
    ("?format=ply", None, b"ply\nformat binary_little_endian"),
    ("?format=ply-ascii", None, b"ply\nformat ascii"), ("?format=drc", None, b"DRACO"),
    ("", "application/vnd.draco", b"DRACO"), ("", "application/ply", b"ply"),
    ("", "*/*", b"ply"), ("", "application/vnd.draco;q=0.5, application/ply", b"ply")])
def test_formats(client, done, query, accept, start):
    headers = {"Accept": accept} if accept else {}
    answer = client.get(done + "/results/points" + query, headers=headers)
    assert answer.status_code == 200 and answer.content.startswith(start)


def test_formats_that_cannot_be_had(client, done):
    points = done + "/results/points"
    assert client.get(points + "?format=stl").status_code == 422
    assert client.get(points, headers={"Accept": "image/png"}).status_code == 406


def test_downloads_have_names(client, done):
    disposition = client.get(done + "/results/points").headers["Content-Disposition"]
    assert disposition.startswith("attachment") and ".ply" in disposition


def test_converted_points_have_a_tag_of_their_own(client, done):
    points = done + "/results/points"
    draco = client.get(points + "?format=drc")
    assert draco.headers["ETag"] != client.get(points).headers["ETag"]
    again = client.get(points + "?format=drc", headers={"If-None-Match": draco.headers["ETag"]})
    assert again.status_code == 304
