"""Damaged files by the hundred: each one is answered decently, by the same process, in its memory.

LPF_MUTATED_UPLOADS sets how many; tests/fuzz/mutated_uploads.py does the same to any server.
"""

import os
import sys
from pathlib import Path

from contract import Client

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fuzz"))

import mutated_uploads  # noqa: E402
from mutation import ply_seeds  # noqa: E402

COUNT = int(os.environ.get("LPF_MUTATED_UPLOADS", "300"))
MOST_RESIDENT = 256 << 20


def most_resident(server):
    """Bytes that a process has held in memory at most."""
    status = Path(f"/proc/{server.pid}/status").read_text()
    line = next(line for line in status.splitlines() if line.startswith("VmHWM:"))
    return int(line.split()[1]) * 1024


def test_damaged_uploads(start):
    server = start("--max-queued-jobs", "100000")
    client = Client(server.url)
    plys = ply_seeds()
    seeds = plys + mutated_uploads.draco_seeds(server.url, plys)
    judge = mutated_uploads.upload_all(server.url, client.contract.document, seeds, COUNT)
    assert not judge.faults, judge.faults[0]
    assert sum(judge.answers.values()) == COUNT
    assert len(judge.answers) > 3, judge.answers  # the damage is of many kinds
    mutated_uploads.wait_for_jobs(server.url, 120)
    assert not mutated_uploads.jobs_with_server_faults(server.url)
    assert server.process.poll() is None
    if os.environ.get("LPF_SANITIZED") is None:
        assert most_resident(server) < MOST_RESIDENT
