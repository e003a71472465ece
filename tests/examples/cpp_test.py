"""The C++ client against a live server: what it gives, and how each kind of error ends it."""

import json
import re
import urllib.error

import pytest
from conftest import rmse, serve, simulate, vertices
from flaky_proxy import FlakyProxy
from programs import CPP, client, fill_queue, get, interrupt_while_running, key_file


def run(url, *arguments, **options):
    return client(CPP, url, *arguments, **options)


def test_denoise(url, scan, tmp_path):
    out, progress = run(url, "denoise", scan, tmp_path / "out.ply", "radius=auto")
    assert vertices(tmp_path / "out.ply") == 5000
    assert rmse(tmp_path / "out.ply") < rmse(scan)
    assert out == f"{tmp_path / 'out.ply'}\n"
    assert "upload: 100 %" in progress and "denoise: 100 %" in progress
    assert [path.name for path in tmp_path.iterdir()] == ["out.ply"]


def test_resample(url, scan, tmp_path):
    run(url + "/", "resample", scan, tmp_path / "out.ply", "factor=2")
    assert 8000 < vertices(tmp_path / "out.ply") < 12000


def test_analyze(url, scan, tmp_path):
    run(url, "analyze", scan, tmp_path / "d.json", "atoms=8")
    assert len(json.loads((tmp_path / "d.json").read_text())["atoms"]) == 8


def test_no_server(scan, tmp_path):
    _, said = run("http://127.0.0.1:1", "denoise", scan, tmp_path / "o", retries=1, expect=3)
    assert "http://127.0.0.1:1 does not answer" in said


def test_bad_file_and_usage(url, scan, tmp_path):
    bad, out = tmp_path / "bad.ply", tmp_path / "o.ply"
    bad.write_text("solid nothing")
    assert "neither PLY nor Draco" in run(url, "denoise", bad, out, expect=4)[1]
    assert "cannot be read" in run(url, "denoise", tmp_path / "no.ply", out, expect=4)[1]
    assert "atoms must be" in run(url, "denoise", scan, out, "atoms=-4", expect=2)[1]
    assert "NAME=VALUE" in run(url, "denoise", scan, out, "atoms", expect=2)[1]
    assert "no folder" in run(url, "denoise", scan, tmp_path / "no" / "o.ply", expect=8)[1]
    assert [path.name for path in tmp_path.iterdir()] == ["bad.ply"]


def test_a_file_over_the_limit_is_not_sent(scan, tmp_path):
    with serve(tmp_path, "--max-upload-bytes", "1000") as url:
        assert "the server takes 1000" in run(url, "denoise", scan, tmp_path / "o", expect=4)[1]


def test_failed_job(url, tmp_path):
    scan = simulate(tmp_path / "large.ply", "sphere", 20000)
    _, said = run(url, "analyze", scan, tmp_path / "d.json", "maxSeconds=0.2",
                  "analysisIterations=1000", expect=6)
    assert "maxSeconds" in said


def test_full_queue(scan, tmp_path):
    large = simulate(tmp_path / "large.ply", "sphere", 20000)
    with serve(tmp_path, "--jobs", "1", "--max-queued-jobs", "1") as url:
        fill_queue(url, large)
        assert "queue is full" in run(url, "denoise", scan, tmp_path / "o", retries=0, expect=5)[1]


def test_api_key(scan, tmp_path):
    key = "correct-horse-battery-staple"
    with serve(tmp_path, "--api-key-file", key_file(tmp_path, key)) as url:
        assert "API key" in run(url, "denoise", scan, tmp_path / "o.ply", expect=7)[1]
        run(url, "denoise", scan, tmp_path / "o.ply", key=key)


def test_ctrl_c_cancels_the_job(url, tmp_path):
    code, said, job = interrupt_while_running(CPP, url, tmp_path)
    assert code == 130 and f"job {job} is cancelled" in said
    with pytest.raises(urllib.error.HTTPError) as gone:
        get(url, "/v1/jobs/" + job)
    assert gone.value.code == 410


def test_lost_answers_make_no_second_job_and_downloads_go_on(url, scan, tmp_path):
    before = len(get(url, "/v1/jobs?limit=1000")["jobs"])
    proxy = FlakyProxy(url, lambda line, count:
                       "lose the answer" if line.startswith("POST") and count == 1 else
                       3000 if line.split()[1].endswith("/points") and count == 1 else None)
    run(proxy.url, "denoise", scan, tmp_path / "out.ply")
    proxy.close()
    downloads = [head for head in proxy.heads if "/results/points" in head]
    assert len(downloads) == 2 and re.search(r"(?i)\nrange: bytes=\d+-", downloads[1])
    keys = [re.search(r"(?i)idempotency-key: (\S+)", head).group(1)
            for head in proxy.sent("POST", "/v1/processes/denoise")]
    assert len(keys) == 2 and keys[0] == keys[1]
    assert len(get(url, "/v1/jobs?limit=1000")["jobs"]) == before + 1
    assert vertices(tmp_path / "out.ply") == 5000
