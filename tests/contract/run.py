"""Runs the black-box suite through prism, and fails on any violation; see check-contract.sh."""

import os
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import requests

import relay

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / os.environ.get("LPF_BUILD_DIR", "build/release")
PRISM = "@stoplight/prism-cli@5"
sys.path.insert(0, str(ROOT / "tests" / "e2e"))


def prism_program():
    """prism below the build folder, installed there the first time."""
    folder = BUILD / "contract"
    program = folder / "node_modules" / ".bin" / "prism"
    if not program.exists():
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--silent", "--prefix",
                        str(folder), PRISM], check=True)
    return program


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def start_prism(folder, server, back):
    document = folder / "openapi.json"
    document.write_text(requests.get(server.url + "/v1/openapi.json", timeout=30).text)
    port = free_port()
    process = subprocess.Popen(
        [prism_program(), "proxy", str(document), f"http://127.0.0.1:{back}", "--errors",
         "--cors", "false", "--port", str(port)],
        stdout=(folder / "prism.log").open("wb"), stderr=subprocess.STDOUT)
    deadline = time.monotonic() + 60
    while "is listening" not in (folder / "prism.log").read_text():
        if process.poll() is not None or time.monotonic() > deadline:
            raise RuntimeError((folder / "prism.log").read_text()[-2000:])
        time.sleep(0.2)
    return process, f"127.0.0.1:{port}"


def check(options):
    os.environ["LPF_SERVER_BINARY"] = str(BUILD / "bin" / "lpf-server")
    from server import Server  # of tests/e2e
    with tempfile.TemporaryDirectory() as name, Server(Path(name) / "data") as server:
        desk = relay.Desk(server.url.removeprefix("http://"), None)
        back = relay.start(relay.Back, desk)
        prism, desk.prism = start_prism(Path(name), server, back.server_address[1])
        front = relay.start(relay.Front, desk)
        try:
            environment = {k: v for k, v in os.environ.items() if k != "LPF_SERVER_BINARY"}
            environment["LPF_URL"] = f"http://127.0.0.1:{front.server_address[1]}"
            suite = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider",
                                    *(options or [str(ROOT / "tests" / "e2e")])], env=environment,
                                   check=False)
        finally:
            if prism.poll() is not None:
                desk.faults.append("prism ended: " + (Path(name) / "prism.log").read_text()[-1500:])
            prism.terminate()
            prism.wait(timeout=20)
            front.shutdown()
            back.shutdown()
    return desk, suite.returncode


def main():
    desk, status = check(sys.argv[1:])
    for fault in sorted(set(desk.faults)):
        print("VIOLATION", fault)
    print(f"prism saw {desk.seen} exchanges: {len(desk.faults)} violations, {desk.agreed} requests "
          f"that it and the server refused alike; {desk.around} event streams went around it.")
    if not desk.seen:
        print("Nothing was checked.")
    sys.exit(1 if desk.faults or status or not desk.seen else 0)


if __name__ == "__main__":
    main()
