"""A proxy that breaks connections on purpose, as networks do."""

import contextlib
import re
import socket
import threading
from urllib.parse import urlsplit


class FlakyProxy:
    """Forwards one request a connection. `fault(request line, times it came)` says what breaks:
    None, "lose the answer", or a number of bytes of the answer after which it ends."""

    def __init__(self, url, fault):
        self._upstream = (urlsplit(url).hostname, urlsplit(url).port)
        self._fault = fault
        self.heads = []  # of every request, as text
        self._lock = threading.Lock()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self):
        self._listener.close()

    def sent(self, method, path):
        """Heads of the requests of a method whose path begins so."""
        return [head for head in self.heads if head.startswith(f"{method} {path}")]

    def _accept(self):
        with contextlib.suppress(OSError):  # until it is closed
            while True:
                connection, _ = self._listener.accept()
                threading.Thread(target=self._forward, args=(connection,), daemon=True).start()

    def _forward(self, client):
        with contextlib.suppress(OSError), client, \
                socket.create_connection(self._upstream) as server:
            head, body = self._read_head(client)
            line = head.splitlines()[0]
            with self._lock:
                self.heads.append(head)
                count = sum(line == other.splitlines()[0] for other in self.heads)
            fault = self._fault(line, count)
            length = re.search(r"(?im)^content-length: *(\d+)", head)
            server.sendall(head.encode("latin-1") + body)
            left = (int(length.group(1)) if length else 0) - len(body)
            while left > 0:
                block = client.recv(min(left, 65536))
                server.sendall(block)
                left -= len(block)
            self._answer(server, client, fault)

    @staticmethod
    def _read_head(client):
        data = b""
        while b"\r\n\r\n" not in data:
            block = client.recv(65536)
            if not block:
                raise ConnectionError("no request came")
            data += block
        head, _, body = data.partition(b"\r\n\r\n")
        return head.decode("latin-1") + "\r\n\r\n", body

    @staticmethod
    def _answer(server, client, fault):
        if fault == "lose the answer":
            server.recv(1)  # it has worked by then
            return
        left = fault if isinstance(fault, int) else 1 << 40
        while left > 0 and (block := server.recv(min(left, 65536))):
            client.sendall(block)
            left -= len(block)
