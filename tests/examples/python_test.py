"""The Python client against a live server: what it gives, and how each kind of error ends it."""

import json
import os
import pty
import re
import subprocess
import urllib.error

import pytest
from conftest import rmse, serve, simulate, vertices
from flaky_proxy import FlakyProxy
from programs import (PYTHON, client, dismiss, environment, fill_queue, get,
                      interrupt_while_running, key_file)

KEY = "correct-horse-battery-staple"


def run(url, *arguments, **options):
    return client(PYTHON, url, *arguments, **options)


def left_in(folder):
    return sorted(path.name for path in folder.iterdir())


def test_denoise(url, scan, tmp_path):
    out, progress = run(url, "denoise", scan, "-o", tmp_path / "out.ply", "--radius", "auto",
                        "--report", tmp_path / "report.json")
    assert vertices(tmp_path / "out.ply") == 5000
    assert rmse(tmp_path / "out.ply") < rmse(scan)
    assert json.loads((tmp_path / "report.json").read_text())["displacement"]["rms"] > 0
    assert "out.ply: points" in out
    assert "upload: 100 %" in progress and "denoise: 100 %" in progress
    assert left_in(tmp_path) == ["out.ply", "report.json"]


def test_resample_by_asking_into_draco(url, scan, tmp_path):
    run(url, "resample", scan, "-o", tmp_path / "out.drc", "--factor", "2", "--no-events")
    assert (tmp_path / "out.drc").read_bytes().startswith(b"DRACO")
    run(url, "denoise", tmp_path / "out.drc", "-o", tmp_path / "out.ply")
    assert 8000 < vertices(tmp_path / "out.ply") < 12000


def test_analyze_with_options_from_the_schema(url, scan, tmp_path):
    run(url, "analyze", scan, "--atoms", "8", "--set", "randomSeed=3", "--dictionary",
        tmp_path / "d.json", "--fields", tmp_path / "f.ply")
    assert len(json.loads((tmp_path / "d.json").read_text())["atoms"]) == 8
    assert vertices(tmp_path / "f.ply") > 10
    newest = get(url, "/v1/jobs?limit=1")["jobs"][0]
    assert get(url, "/v1/jobs/" + newest["jobID"])["parameters"]["randomSeed"] == 3


def test_every_input_is_an_option(url):
    said, _ = run(url, "resample", "--help")
    for name in set(get(url, "/v1/processes/resample")["inputs"]) - {"shape", "dictionary"}:
        assert f"--{name}" in said, name


def test_validate_and_jobs(url, scan):
    said, _ = run(url, "validate", "denoise", scan, "--radius", "8", "--radius-unit", "spacing")
    assert re.search(r"^lambda = .*auto", said, re.MULTILINE) and "5000 points" in said
    answer = json.loads(run(url, "validate", "denoise", scan, "--json")[0])
    assert answer["estimate"]["outputPoints"] == 5000
    jobs = [job["jobID"] for job in get(url, "/v1/jobs?limit=1000")["jobs"]]
    assert [line.split()[0] for line in run(url, "jobs", "--limit", "1000")[0].splitlines()] == jobs


def test_quiet(url, scan, tmp_path):
    assert run(url, "denoise", scan, "-o", tmp_path / "out.ply", "-q")[1] == ""


def test_the_bar_on_a_terminal(url, scan, tmp_path):
    terminal, end = pty.openpty()
    done = subprocess.run([*PYTHON, "denoise", scan, "-o", tmp_path / "out.ply"], stderr=end,
                          env={**environment(url), "COLUMNS": "100"}, stdin=subprocess.DEVNULL,
                          stdout=subprocess.DEVNULL, timeout=60, check=False)
    said = os.read(terminal, 1 << 16).decode()
    assert done.returncode == 0, said
    assert re.search(r"\r\x1b\[Kdenoise +\[#{30}\] 100 %", said)


def test_the_program_of_the_readme(url, scan, tmp_path):
    folder = PYTHON[1].parent
    program = re.search(r"```python\n(.*?)```", (folder / "README.md").read_text(), re.DOTALL)[1]
    (tmp_path / "in.ply").write_bytes(scan.read_bytes())
    said = subprocess.run(
        [PYTHON[0], "-c", program.replace("http://127.0.0.1:8080", url)], cwd=tmp_path, check=True,
        env={**environment(url), "PYTHONPATH": str(folder)}, capture_output=True, text=True,
        timeout=60).stdout
    assert "successful 100" in said
    assert vertices(tmp_path / "out.ply") == 5000


def test_no_server(scan, tmp_path):
    _, said = run("http://127.0.0.1:1", "denoise", scan, "-o", tmp_path / "o", "--retries", "1",
                  expect=3)
    assert "does not answer: Connection refused" in said and "1 of 1" in said


def test_bad_files(url, tmp_path):
    (tmp_path / "bad.ply").write_text("solid nothing")
    (tmp_path / "cut.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                      "property float y\nproperty float z\nend_header\n1 2 3\n")
    assert "neither PLY nor Draco" in run(url, "denoise", tmp_path / "bad.ply", "-o",
                                          tmp_path / "o.ply", expect=4)[1]
    assert "breaks the rules of its format" in run(url, "denoise", tmp_path / "cut.ply", "-o",
                                                   tmp_path / "o.ply", expect=4)[1]
    assert "No such file" in run(url, "denoise", tmp_path / "none.ply", "-o", tmp_path / "o.ply",
                                 expect=4)[1]
    assert left_in(tmp_path) == ["bad.ply", "cut.ply"]


def test_usage(url, scan, tmp_path):
    out = tmp_path / "o.ply"
    assert "atoms must be" in run(url, "denoise", scan, "-o", out, "--atoms", "-4", expect=2)[1]
    assert "--radios" in run(url, "denoise", scan, "-o", out, "--radios", "4", expect=2)[1]
    assert "factor" in run(url, "resample", scan, "-o", out, "--set", "fact=4", expect=2)[1]
    assert "resample" in run(url, "melt", scan, expect=2)[1]
    assert "-o FILE" in run(url, "denoise", scan, expect=2)[1]
    assert "no folder" in run(url, "denoise", scan, "-o", tmp_path / "no" / "o.ply", expect=8)[1]


def test_failed_job(url, tmp_path):
    scan = simulate(tmp_path / "large.ply", "sphere", 20000)
    _, said = run(url, "analyze", scan, "--dictionary", tmp_path / "d.json", "--max-seconds", "0.2",
                  "--analysis-iterations", "1000", expect=6)
    assert "maxSeconds" in said
    assert left_in(tmp_path) == ["large.ply"]


def test_full_queue(scan, tmp_path):
    large = simulate(tmp_path / "large.ply", "sphere", 20000)
    with serve(tmp_path, "--jobs", "1", "--max-queued-jobs", "1") as url:
        jobs = fill_queue(url, large)
        _, said = run(url, "denoise", scan, "-o", tmp_path / "o.ply", "--retries", "0", expect=5)
        assert "The queue is full" in said
        for job in jobs:
            assert job in run(url, "cancel", job)[0]
        run(url, "denoise", scan, "-o", tmp_path / "o.ply")


def test_api_key(scan, tmp_path):
    keys = key_file(tmp_path, KEY)
    with serve(tmp_path, "--api-key-file", keys) as url:
        _, said = run(url, "denoise", scan, "-o", tmp_path / "o.ply", expect=7)
        assert "API key" in said
        out, progress = run(url, "denoise", scan, "-o", tmp_path / "o.ply", key=KEY)
        assert "successful" in run(url, "jobs", "--api-key", KEY)[0]
        assert KEY not in out + progress
        assert vertices(tmp_path / "o.ply") == 5000


def test_ctrl_c_cancels_the_job(url, tmp_path):
    code, said, job = interrupt_while_running(PYTHON, url, tmp_path)
    assert code == 130
    assert f"job {job} is cancelled" in said and "Traceback" not in said
    with pytest.raises(urllib.error.HTTPError) as gone:
        get(url, "/v1/jobs/" + job)
    assert gone.value.code == 410


def test_a_job_that_somebody_dismisses(url, tmp_path):
    scan = simulate(tmp_path / "large.ply", "sphere", 20000)

    def fault(line, count):
        if "/events" in line and count == 1:
            dismiss(url, line.split("/")[3])
        return None

    proxy = FlakyProxy(url, fault)
    _, said = run(proxy.url, "analyze", scan, "--dictionary", tmp_path / "d.json",
                  "--analysis-iterations", "1000", expect=6)
    proxy.close()
    assert "dismissed" in said


def test_a_lost_answer_makes_no_second_job(url, scan, tmp_path):
    before = len(get(url, "/v1/jobs?limit=1000")["jobs"])
    proxy = FlakyProxy(url, lambda line, count:
                       "lose the answer" if line.startswith("POST") and count == 1 else None)
    run(proxy.url, "denoise", scan, "-o", tmp_path / "out.ply")
    proxy.close()
    keys = [re.search(r"(?i)idempotency-key: (\S+)", head).group(1)
            for head in proxy.sent("POST", "/v1/processes/denoise")]
    assert len(keys) == 2 and keys[0] == keys[1]
    assert len(get(url, "/v1/jobs?limit=1000")["jobs"]) == before + 1


def test_broken_streams_and_downloads_go_on(url, scan, tmp_path):
    def fault(line, count):
        if count == 1 and "/events" in line:
            return 2500
        return 30000 if count == 1 and line.split()[1].endswith("/results/points") else None

    proxy = FlakyProxy(url, fault)
    run(proxy.url, "denoise", scan, "-o", tmp_path / "out.ply")
    proxy.close()
    streams, downloads = ([head for head in proxy.heads if word in head]
                          for word in ("/events", "/results/points"))
    assert len(streams) == 2 and re.search(r"(?i)last-event-id: \d+", streams[1])
    assert len(downloads) == 2 and re.search(r"(?i)range: bytes=\d+-", downloads[1])
    assert vertices(tmp_path / "out.ply") == 5000
