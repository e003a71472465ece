"""Each process from the upload to its results."""

import json

import pytest

from shapes import ascii_ply, radius_error, read_ply


def test_denoise_keeps_points_order_and_attributes(client, sphere, done):
    before, after = read_ply(sphere), read_ply(client.get(done + "/results/points").content)
    assert len(after) == len(before)
    for name in ("red", "green", "blue", "intensity", "number"):
        assert [r[name] for r in after] == [r[name] for r in before], name
    assert radius_error(after) < radius_error(before)


def test_one_line_gets_the_points_themselves(client, sphere):
    answer = client.execute("denoise", sphere, wait=60,
                            headers={"Content-Type": "application/x-www-form-urlencoded"})
    assert answer.status_code == 200
    assert answer.headers["Preference-Applied"] == "wait=60"
    assert answer.headers["Content-Type"] == "application/ply"
    assert len(read_ply(answer.content)) == 1500
    assert client.get(answer.headers["Location"]).json()["status"] == "successful"


@pytest.mark.parametrize("query, expected", [("?factor=2", 3000), ("?targetPoints=1000", 1000)])
def test_resample_to_a_number(client, sphere, query, expected):
    rows = read_ply(client.get(client.run("resample", sphere, query) + "/results/points").content)
    assert abs(len(rows) - expected) < 0.05 * expected
    assert radius_error(rows) < 0.05
    assert all(0 <= r["number"] < 1500 for r in rows)


def test_analyze_learns_a_dictionary(client, sphere):
    path = client.run("analyze", sphere, "?atoms=6")
    results = client.get(path + "/results").json()
    assert set(results) == {"dictionary", "report", "fields"}
    dictionary = client.get(path + "/results/dictionary").json()
    assert len(dictionary["atoms"]) == 6
    assert all(len(atom) == len(dictionary["patternPoints"]) for atom in dictionary["atoms"])
    assert client.get(path + "/results/points").status_code == 404


def test_analyze_with_a_wait_lists_its_results(client, sphere):
    answer = client.execute("analyze", sphere, wait=60)
    assert answer.status_code == 200 and "dictionary" in answer.json()


def test_results_index_tells_sizes_and_digests(client, done):
    import hashlib
    for name, entry in client.get(done + "/results").json().items():
        content = client.get(entry["href"]).content
        assert len(content) == entry["bytes"], name
        assert hashlib.sha256(content).hexdigest() == entry["sha256"], name


def test_report_tells_what_was_done(client, done):
    report = client.get(done + "/results/report").json()
    assert report["jobID"] == done.split("/")[-1]


def test_draco_out_keeps_the_points(client, sphere):
    path = client.run("denoise", sphere, "?format=drc")
    answer = client.get(path + "/results/points")
    assert answer.headers["Content-Type"] == "application/vnd.draco"
    assert answer.content.startswith(b"DRACO")
    rows = read_ply(client.get(path + "/results/points?format=ply").content)
    assert [r["number"] for r in rows] == list(range(1500))


def test_draco_in(client, sphere, done):
    draco = client.get(done + "/results/points?format=drc").content
    shape = client.post("/v1/shapes", draco).json()
    assert (shape["format"], shape["points"]) == ("drc", 1500)
    again = client.run("denoise", draco)
    assert client.get(again + "/results/points").content.startswith(b"DRACO")


def test_form_with_file_and_fields(client, sphere):
    answer = client.execute("denoise", None, wait=60, files={
        "file": ("scan.ply", sphere), "format": (None, "ply-ascii"), "attributes": (None, "drop")})
    assert answer.status_code == 200, answer.text
    assert b"format ascii 1.0" in answer.content and b"intensity" not in answer.content


def test_json_request_names_an_uploaded_shape(client, sphere):
    shape = client.post("/v1/shapes", sphere).json()
    for reference in (shape["id"], {"href": "/v1/shapes/" + shape["id"]}):
        body = json.dumps({"inputs": {"shape": reference, "atoms": 4}})
        answer = client.execute("analyze", body, headers={"Content-Type": "application/json"})
        assert answer.status_code == 201, answer.text
        job = client.finish(answer.json())
        assert job["status"] == "successful" and job["shape"] == shape["id"]
        assert job["parameters"]["atoms"] == 4
        assert job["resolvedParameters"]["atoms"] == {
            "value": 4, "source": "request", "rule": job["resolvedParameters"]["atoms"]["rule"]}


def test_dictionary_is_listed_fetched_and_used_again(client, sphere):
    first = client.run("analyze", sphere, "?atoms=5")
    learned = client.get(first + "/results/dictionary").json()
    assert learned["id"] in [d["id"] for d in client.get("/v1/dictionaries").json()["dictionaries"]]
    path = "/v1/dictionaries/" + learned["id"]
    assert client.get(path).json()["sourceJob"] == first.split("/")[-1]
    assert client.get(path + "/data?format=json").json()["atoms"] == learned["atoms"]
    assert client.get(path + "/data?format=npy").content.startswith(b"\x93NUMPY")
    second = client.run("analyze", sphere,
                        f"?dictionary={learned['id']}&dictionaryMode=fixed")
    assert client.get(second + "/results/dictionary").json()["atoms"] == learned["atoms"]


def test_unknown_dictionary(client, sphere):
    missing = "01890000-0000-7000-8000-000000000000"
    answer = client.execute("denoise", sphere, f"?dictionary={missing}")
    assert (answer.status_code, answer.json()["code"]) == (404, "dictionary-not-found")


@pytest.mark.parametrize("query, pointer", [
    ("?raduis=1", "/inputs/raduis"), ("?radius=-1", "/inputs/radius"),
    ("?radius=many", "/inputs/radius"), ("?atoms=1.5", "/inputs/atoms"),
    ("?atoms=100000", "/inputs/atoms"), ("?format=stl", "/inputs/format"),
    ("?radius=1&radius=2", "/inputs/radius"), ("?factor=2", "/inputs/factor")])
def test_wrong_inputs_are_pointed_at(client, sphere, query, pointer):
    answer = client.execute("denoise", sphere, query)
    assert answer.status_code == 422
    assert pointer in [e["pointer"] for e in answer.json()["errors"]]


@pytest.mark.parametrize("body, status", [
    ("{", 400), ('{"inputs":{}}', 422), ('{"inputs":{"shape":"x"}}', 422),
    ('{"inputs":{"shape":"01890000-0000-7000-8000-000000000000"}}', 404),
    ('{"inputs":{"shape":1,"shape":2}}', 400), ("[" * 100 + "]" * 100, 413)])
def test_wrong_json(client, body, status):
    answer = client.execute("denoise", body, headers={"Content-Type": "application/json"})
    assert answer.status_code == status, answer.text


def test_doubles_of_large_coordinates_survive(client):
    points = [(6378137.0 + i % 30 * 0.01, 5613000.5 + i // 30 * 0.01, 100.125)
              for i in range(900)]
    data = ascii_ply(points).replace(b"property float", b"property double")
    answer = client.execute("denoise", data, "?format=ply", wait=60)
    assert answer.status_code == 200
    rows = read_ply(answer.content)
    assert all(abs(r["x"] - p[0]) < 0.005 and abs(r["y"] - p[1]) < 0.005
               for r, p in zip(rows, points))
