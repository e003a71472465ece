"""What a job would do and take, without one."""

import pytest

from shapes import ascii_ply, binary_ply, noisy_sphere, read_ply


def validate(client, process, data, query="", **options):
    return client.post(f"/v1/processes/{process}/validate{query}", data, **options)


def codes(answer):
    return {warning["code"] for warning in answer.json()["warnings"]}


@pytest.mark.parametrize("process", ["denoise", "resample", "analyze"])
def test_foresees_each_process(client, sphere, process):
    answer = validate(client, process, sphere)
    assert answer.status_code == 200, answer.text
    seen = answer.json()
    assert seen["processID"] == process
    assert seen["shape"]["points"] == 1500 and seen["shape"]["examinedShare"] == 1
    assert seen["resolvedParameters"]["radius"]["source"] == "auto"
    assert seen["estimate"]["seconds"] > 0 and seen["estimate"]["memoryBytes"] > 1e6
    assert sum(bin_["share"] for bin_ in seen["neighbours"]["histogram"]) == pytest.approx(1)


def test_resolves_as_the_job_does(client, sphere):
    path = client.run("resample", sphere, "?factor=2")
    job = client.get(path).json()
    seen = validate(client, "resample", sphere, "?factor=2").json()
    assert seen["resolvedParameters"] == job["resolvedParameters"]
    points = read_ply(client.get(path + "/results/points").content)
    assert seen["estimate"]["outputPoints"] == pytest.approx(len(points), rel=0.05)
    fields = client.get(path + "/results/report").json()["fields"]
    assert seen["estimate"]["fields"] == pytest.approx(fields, rel=0.3)


def test_takes_each_form(client, sphere):
    shape = client.post("/v1/shapes", sphere).json()["id"]
    stored = validate(client, "denoise", None, json={"inputs": {"shape": shape, "atoms": 9}})
    assert stored.json()["shape"]["id"] == shape
    form = validate(client, "denoise", None, files={"file": sphere, "atoms": (None, "9")})
    raw = validate(client, "denoise", sphere, "?atoms=9")
    for answer in (stored, form, raw):
        assert answer.json()["resolvedParameters"]["atoms"] == {
            "value": 9, "source": "request", "rule": "given by the user"}


def test_queues_and_keeps_nothing(start):
    from contract import Client
    client = Client(start().url)
    data = noisy_sphere(500, seed=61)
    assert validate(client, "denoise", data).status_code == 200
    assert client.get("/v1/jobs").json()["jobs"] == []
    assert client.post("/v1/shapes", data).status_code == 201  # 200 if it had been kept


def test_plans_what_becomes_of_attributes(client, sphere):
    def plan(process, query=""):
        entries = validate(client, process, sphere, query).json()["attributes"]
        return {entry["name"]: entry for entry in entries}

    assert plan("denoise")["intensity"]["plan"] == "kept"
    assert plan("resample")["intensity"]["plan"] == "carried"
    assert plan("analyze")["intensity"]["plan"] == "unused"
    assert plan("denoise", "?attributes=drop")["red"]["plan"] == "dropped"
    assert plan("denoise", "?normals=estimate")["nz"]["plan"] == "computed"
    assert "Quantised" in plan("denoise", "?format=drc")["position"]["detail"]


def test_warns_of_a_radius_that_does_not_fit(client, sphere):
    assert "radius-too-small" in codes(validate(client, "denoise", sphere, "?radius=0.01"))
    assert "radius-too-large" in codes(validate(client, "denoise", sphere, "?radius=2"))
    assert codes(validate(client, "denoise", sphere)) == set()


def test_warns_of_odd_points(client):
    rows = [(r["x"], r["y"], r["z"]) for r in read_ply(noisy_sphere(2000, seed=62))]
    rows += rows[:200] + [(30 + i, 30, 30) for i in range(5)]
    data = binary_ply(rows, [("float", axis) for axis in "xyz"])
    assert {"duplicate-points", "outliers"} <= codes(validate(client, "denoise", data))
    calm = codes(validate(client, "denoise", data, "?duplicates=remove&outliers=remove"))
    assert not {"duplicate-points", "outliers"} & calm


def test_warns_of_few_points_and_of_inputs_without_effect(client):
    few = noisy_sphere(60, seed=63)
    assert {"few-points", "few-fields"} <= codes(validate(client, "denoise", few))
    assert "unused-input" in codes(validate(client, "denoise", few, "?radiusUnit=spacing"))
    assert "no-normals" in codes(validate(client, "denoise", few, "?normals=keep"))


@pytest.mark.parametrize("query, code", [
    ("?factor=2&targetPoints=100", "invalid-parameter"), ("?atoms=-1", "invalid-parameter"),
    ("?dictionary=01890000-0000-7000-8000-000000000000", "dictionary-not-found")])
def test_refuses_what_an_execution_refuses(client, sphere, query, code):
    answer = validate(client, "resample", sphere, query)
    assert answer.status_code in (404, 422) and answer.json()["code"] == code


def test_refuses_broken_and_empty_shapes(client):
    assert validate(client, "denoise", b"nonsense").status_code == 415
    assert validate(client, "denoise", ascii_ply([(0, 0, 0)], 9)).status_code == 422
    one = validate(client, "denoise", ascii_ply([(0, 0, 0)]))
    assert (one.status_code, one.json()["code"]) == (422, "too-few-points")
    same = validate(client, "denoise", ascii_ply([(1, 1, 1)] * 9))
    assert (same.status_code, same.json()["code"]) == (422, "degenerate-shape")
    assert client.raw("POST", "/v1/processes/melt/validate", data=b"x").status_code == 404
