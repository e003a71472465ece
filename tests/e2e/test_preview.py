"""Previews: of what came in at once, of what came out when it is there."""

import pytest

from shapes import ascii_ply, binary_ply, noisy_sphere, radius_error, read_ply

SLOW = "?analysisIterations=1000"


def test_of_a_shape(client, sphere):
    shape = client.post("/v1/shapes", sphere).json()
    path = f"/v1/shapes/{shape['id']}/preview"
    answer = client.get(path)
    rows = read_ply(answer.content)
    assert len(rows) == shape["points"]
    assert answer.headers["Preview-Points"] == answer.headers["Preview-Total-Points"] == "1500"
    assert answer.headers["Preview-Offset"] == "0 0 0"
    original = read_ply(sphere)
    assert set(rows[0]) == {"x", "y", "z", "red", "green", "blue"}
    assert [row["red"] for row in rows] == [row["red"] for row in original]
    assert rows[7]["x"] == original[7]["x"]


def test_is_decimated_evenly(client, sphere):
    shape = client.post("/v1/shapes", sphere).json()
    answer = client.get(f"/v1/shapes/{shape['id']}/preview?maxPoints=300")
    rows = read_ply(answer.content)
    assert len(rows) == 300 and answer.headers["Preview-Total-Points"] == "1500"
    for axis in "xyz":
        upper = sum(row[axis] > 0 for row in rows)
        assert 100 < upper < 200
    again = client.get(f"/v1/shapes/{shape['id']}/preview?maxPoints=300")
    assert again.content == answer.content


def test_of_other_formats(client):
    text = client.post("/v1/shapes", ascii_ply([(i, 0, 1) for i in range(50)])).json()
    assert len(read_ply(client.get(f"/v1/shapes/{text['id']}/preview").content)) == 50
    path = client.run("denoise", noisy_sphere(400, seed=51), "?format=drc")
    draco = client.get(path + "/preview")
    assert draco.headers["Preview-Of"] == "result"
    assert len(read_ply(draco.content)) == 400


def test_far_from_the_origin(client):
    far = [(500_000 + 0.001 * i, 4_500_000.0, 0.0) for i in range(100)]
    shape = client.post("/v1/shapes", binary_ply(far, [("double", axis) for axis in "xyz"])).json()
    answer = client.get(f"/v1/shapes/{shape['id']}/preview")
    offset = [float(value) for value in answer.headers["Preview-Offset"].split()]
    assert f"comment offset {answer.headers['Preview-Offset']}".encode() in answer.content
    for row, point in zip(read_ply(answer.content), far):
        assert abs(row["x"] + offset[0] - point[0]) < 1e-5


def test_of_a_job_changes_with_its_result(client):
    data = noisy_sphere(2000, noise=0.05, seed=52)
    job = client.execute("denoise", data).json()
    path = "/v1/jobs/" + job["jobID"]
    assert client.get(path + "/preview?of=input").headers["Preview-Of"] == "input"
    client.finish(job)
    before = client.get(path + "/preview?of=input")
    after = client.get(path + "/preview")
    assert (before.headers["Preview-Of"], after.headers["Preview-Of"]) == ("input", "result")
    assert radius_error(read_ply(after.content)) < radius_error(read_ply(before.content))
    assert client.get(path + "/preview?of=result").content == after.content


def test_of_a_job_that_works_is_its_input(client):
    job = client.execute("analyze", noisy_sphere(20_000, seed=53), SLOW).json()
    path = "/v1/jobs/" + job["jobID"]
    assert client.get(path + "/preview?maxPoints=10").headers["Preview-Of"] == "input"
    answer = client.get(path + "/preview?of=result")
    assert (answer.status_code, answer.json()["code"]) == (404, "result-not-ready")
    client.delete(path)
    assert client.get(path + "/preview").status_code == 410


def test_of_an_analysis_is_its_input(client, sphere):
    path = client.run("analyze", sphere)
    assert client.get(path + "/preview").headers["Preview-Of"] == "input"
    answer = client.get(path + "/preview?of=result")
    assert (answer.status_code, answer.json()["code"]) == (404, "result-not-found")


def test_is_not_sent_twice(client, done):
    answer = client.get(done + "/preview")
    tag = answer.headers["ETag"]
    assert client.get(done + "/preview", headers={"If-None-Match": tag}).status_code == 304
    part = client.get(done + "/preview", headers={"Range": "bytes=0-2"})
    assert (part.status_code, part.content) == (206, b"ply")
    assert client.request("HEAD", done + "/preview").headers["ETag"] == tag


@pytest.mark.parametrize("query", ["maxPoints=0", "maxPoints=2000001", "maxPoints=x", "of=both"])
def test_wrong_queries(client, done, query):
    assert client.get(done + "/preview?" + query).status_code == 422


def test_of_nothing(client):
    assert client.get("/v1/jobs/none/preview").status_code == 404
    assert client.get("/v1/shapes/none/preview").status_code == 404
