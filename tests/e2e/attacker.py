"""A client without manners, and a guard who watches how the server takes it."""

import gzip
import io
import resource
import socket
import threading
import time
import urllib.request
from urllib.parse import urlparse

MEMORY = 256 << 20  # bytes that the server may never need without a job
HEALTH = 2.0  # seconds within which /healthz answers whatever happens; tests/bench has the figure


def allow_many_sockets():
    """A crowd of clients needs more descriptors than most systems grant unasked."""
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, 16384), most))


allow_many_sockets()


class Raw:
    """One connection: sends any bytes, and reads what comes."""

    def __init__(self, server, receive_buffer=None):
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(20)
        self.socket.connect(("127.0.0.1", urlparse(server.url).port))

    def send(self, data):
        """Sends what the server takes. False once it takes no more."""
        try:
            self.socket.sendall(data)
            return True
        except OSError:
            return False

    def read_all(self):
        """Everything up to the end of the connection."""
        parts = []
        try:
            while part := self.socket.recv(65536):
                parts.append(part)
        except OSError:
            pass
        return b"".join(parts)

    def ask(self, data):
        """Sends it all, says that this was all, and reads the answer."""
        self.send(data)
        try:
            self.socket.shutdown(socket.SHUT_WR)
        except OSError:
            pass
        return self.read_all()

    def close(self):
        self.socket.close()


def status(answer):
    return int(answer[9:12]) if answer.startswith(b"HTTP/1.1 ") else 0


def ask(server, data):
    raw = Raw(server)
    try:
        return raw.ask(data)
    finally:
        raw.close()


def get(path, *fields):
    return f"GET {path} HTTP/1.1\r\nHost: h\r\n".encode() + head_end(fields)


def post(path, *fields):
    return f"POST {path} HTTP/1.1\r\nHost: h\r\n".encode() + head_end(fields)


def head_end(fields):
    return b"".join(field.encode("latin-1") + b"\r\n" for field in fields) + b"\r\n"


def chunk(data):
    return f"{len(data):x}\r\n".encode() + data + b"\r\n"


def bomb(size):
    """Zeros that gzip makes very small."""
    out = io.BytesIO()
    with gzip.GzipFile(fileobj=out, mode="wb", compresslevel=9) as file:
        for _ in range(size >> 20):
            file.write(bytes(1 << 20))
    return out.getvalue()


def memory(server, field="VmHWM"):
    """Resident memory of the server, at its highest since the start unless told otherwise."""
    with open(f"/proc/{server.pid}/status", encoding="ascii") as file:
        line = next(line for line in file if line.startswith(field + ":"))
    return int(line.split()[1]) * 1024


class Guard:
    """Asks for /healthz all the time, and judges at the end."""

    def __init__(self, server):
        self.server = server
        self.times = []
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.watch)

    def watch(self):
        while not self.over.is_set():
            start = time.monotonic()
            try:
                with urllib.request.urlopen(self.server.url + "/healthz", timeout=30) as answer:
                    healthy = answer.status == 200
            except OSError:
                healthy = False
            self.times.append(time.monotonic() - start if healthy else float("inf"))
            self.over.wait(0.05)

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, kind, *_):
        self.over.set()
        self.thread.join()
        if kind is None:
            assert self.times and max(self.times) < HEALTH, max(self.times)
            assert memory(self.server) < MEMORY, memory(self.server)
            assert self.server.process.poll() is None
