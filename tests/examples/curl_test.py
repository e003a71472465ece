"""Every curl example does what it says, against a live server."""

import json
import re

from conftest import ROOT, rmse, simulate, vertices


def test_every_example_is_run_here():
    scripts = {path.name for path in (ROOT / "client-examples" / "curl").glob("*.sh")}
    text = (ROOT / "tests" / "examples" / "curl_test.py").read_text(encoding="utf-8")
    assert scripts - {"lpf.sh"} == {name for name in scripts if f'run("{name}"' in text}


def test_one_liner(run, scan, tmp_path):
    run("one-liner.sh", scan, tmp_path / "out.ply")
    assert vertices(tmp_path / "out.ply") == 5000
    assert rmse(tmp_path / "out.ply") < rmse(scan)


def test_denoise(run, scan, tmp_path):
    out = tmp_path / "out.ply"
    run("denoise.sh", scan, out)
    assert vertices(out) == 5000
    assert rmse(out) < rmse(scan)
    report = json.loads((tmp_path / "out.ply.report.json").read_text())
    assert report["displacement"]["rms"] > 0


def test_denoise_says_why_it_failed(run, tmp_path):
    (tmp_path / "no.ply").write_text("solid nothing")
    said = run("denoise.sh", tmp_path / "no.ply", tmp_path / "out.ply", expect=1)
    assert "PLY" in said
    assert not (tmp_path / "out.ply").exists()


def test_resample(run, scan, tmp_path):
    run("resample.sh", scan, tmp_path / "out.ply", 3)
    assert 12000 < vertices(tmp_path / "out.ply") < 18000


def test_analyze(run, scan, tmp_path):
    run("analyze.sh", scan, tmp_path / "d.json", tmp_path / "fields.ply", 8)
    dictionary = json.loads((tmp_path / "d.json").read_text())
    assert len(dictionary["atoms"]) == 8
    assert len(dictionary["atoms"][0]) == len(dictionary["patternPoints"])
    assert vertices(tmp_path / "fields.ply") > 10


def test_upload_once(run, scan, tmp_path):
    said = run("upload-once.sh", scan, tmp_path / "a.ply", tmp_path / "b.ply")
    assert "shape " in said
    assert vertices(tmp_path / "a.ply") == 5000
    assert 8000 < vertices(tmp_path / "b.ply") < 12000


def test_dictionary_reuse(run, scan, tmp_path):
    other = simulate(tmp_path / "other.ply", "sphere")
    said = run("dictionary-reuse.sh", scan, other, tmp_path / "out.ply")
    assert re.search(r"dictionary [0-9a-f-]{36}", said)
    assert vertices(tmp_path / "out.ply") == 5000


def test_convert(run, scan, tmp_path):
    run("convert.sh", scan, tmp_path / "out")
    assert vertices(tmp_path / "out.ply") == 5000
    assert vertices(tmp_path / "out.ascii.ply") == 5000
    assert b"format ascii" in (tmp_path / "out.ascii.ply").read_bytes()[:40]
    draco = (tmp_path / "out.drc").read_bytes()
    assert draco.startswith(b"DRACO")
    assert len(draco) < (tmp_path / "out.ply").stat().st_size


def test_cancel(run, tmp_path):
    scan = simulate(tmp_path / "big.ply", "curvenet", 100000, 0.1)
    said = run("cancel.sh", scan).splitlines()
    assert "dismissed" in said
    assert said[-1] == "410"


def test_errors(run, scan):
    said = run("errors.sh", scan)
    statuses = [int(status) for status in re.findall(r"HTTP status (\d+)", said)]
    assert len(statuses) == 5
    assert all(400 <= status < 500 for status in statuses), statuses
    assert statuses[4] == 404
    assert "/inputs/radios" in said and "/inputs/atoms" in said
