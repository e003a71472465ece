"""Two relays, one on either side of a validating proxy.

    suite -> Front -> prism -> Back -> server

The proxy reads every body as text, which would change the bytes of a file. So Front keeps the body
of a request and Back the answer of the server, each under a number that travels in a header; the
proxy sees methods, paths, headers, statuses and JSON as they are, and a word in place of a file.
Front hands out what the server really said, and notes what the proxy had against it.
"""

import http.client
import itertools
import json
import re
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

NUMBER = "X-Relay-Number"
WORD = b"file"
HOP_BY_HOP = {"connection", "keep-alive", "transfer-encoding", "content-length", "host"}
EVENTS = re.compile(r"^/v1/jobs/[^/]+/events$")
PRISM = "https://stoplight.io/prism/errors#"


PLAIN = bytes(b if 32 <= b < 127 and b != ord("%") or b in b"\r\n" else ord(".")
              for b in range(256))


def is_text(media_type):
    return "json" in media_type or media_type.startswith("text/")


def shown(media_type, body):
    """What the proxy sees of a body. A form keeps its shape: prism ends on an odd byte in one."""
    if not body or is_text(media_type):
        return body
    return body.translate(PLAIN) if media_type.startswith("multipart/") else WORD


class Exchange:
    """One request and what became of it."""

    def __init__(self, body):
        self.body = body
        self.answer = None  # (status, header pairs, body) of the server


class Desk:
    """What both relays know: the exchanges under way, and the faults found."""

    def __init__(self, server, prism):
        self.server, self.prism = server, prism
        self.numbers = itertools.count()
        self.exchanges = {}
        self.faults, self.seen, self.agreed, self.around = [], 0, 0, 0
        self.lock = threading.Lock()

    def open(self, body):
        with self.lock:
            number = str(next(self.numbers))
            self.exchanges[number] = Exchange(body)
            return number


def fetch(address, method, target, headers, body):
    """Sends a request as it is. Returns (status, header pairs, body)."""
    connection = http.client.HTTPConnection(address, timeout=150)
    connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
    for name, value in headers:
        connection.putheader(name, value)
    if body is not None:
        connection.putheader("Content-Length", str(len(body)))
    connection.endheaders(body)
    answer = connection.getresponse()
    result = answer.status, answer.getheaders(), answer.read()
    connection.close()
    return result


class Relay(BaseHTTPRequestHandler):
    """What both have in common."""

    protocol_version = "HTTP/1.1"
    desk = None

    def log_message(self, *_):
        pass

    def read_body(self):
        if "chunked" in self.headers.get("Transfer-Encoding", ""):
            parts = []
            while size := int(self.rfile.readline().split(b";")[0], 16):
                parts.append(self.rfile.read(size))
                self.rfile.readline()
            self.rfile.readline()
            return b"".join(parts)
        if "Content-Length" not in self.headers:
            return None
        return self.rfile.read(int(self.headers["Content-Length"]))

    def passed_headers(self):
        return [(n, v) for n, v in self.headers.items() if n.lower() not in HOP_BY_HOP]

    def send(self, status, headers, body):
        self.send_response_only(status)
        length = {"Content-Length": str(len(body))}
        for name, value in headers:
            if name.lower() == "content-length":
                length = {name: value}  # of HEAD: that of the body it does not have
            elif name.lower() not in HOP_BY_HOP:
                self.send_header(name, value)
        if status != 204 and status != 304:
            self.send_header(*next(iter(length.items())))
        self.end_headers()
        self.wfile.write(body if self.command != "HEAD" else b"")

    def serve(self):
        raise NotImplementedError

    def __getattr__(self, name):
        if name.startswith("do_"):
            return self.serve
        raise AttributeError(name)


class Back(Relay):
    """Behind the proxy: gives the server the real body, and the proxy a word for a file."""

    def serve(self):
        self.read_body()
        exchange = self.desk.exchanges[self.headers[NUMBER]]
        headers = [(n, v) for n, v in self.passed_headers()
                   if n.lower() not in (NUMBER.lower(), "accept-encoding")]
        headers.append(("Host", self.headers["X-Relay-Host"]))
        exchange.answer = fetch(self.desk.server, self.command, self.path, headers, exchange.body)
        status, answered, body = exchange.answer
        media_type = dict((n.lower(), v) for n, v in answered).get("content-type", "")
        if body and not is_text(media_type):
            answered = [(n, v) for n, v in answered if n.lower() != "content-length"]
            body = WORD
        self.send(status, answered, body)


class Front(Relay):
    """Before the proxy: what the suite talks to."""

    def serve(self):
        body = self.read_body()
        path = self.path.split("?")[0]
        real = self.passed_headers() + [("Host", self.headers.get("Host", ""))]
        if EVENTS.match(path):
            self.stream(real)
            return
        number = self.desk.open(body)
        headers = real + [(NUMBER, number), ("X-Relay-Host", self.headers.get("Host", ""))]
        judged = fetch(self.desk.prism, self.command, self.path, headers,
                       shown(self.headers.get("Content-Type", ""), body))
        exchange = self.desk.exchanges.pop(number)
        self.judge(judged, exchange, real)
        self.send(*exchange.answer)

    def judge(self, judged, exchange, real):
        desk = self.desk
        verdict = {}
        if judged[2][:1] == b"{" and PRISM.encode() in judged[2]:
            verdict = json.loads(judged[2])
        refused = exchange.answer is None
        if refused:
            exchange.answer = fetch(desk.server, self.command, self.path, real, exchange.body)
        status = exchange.answer[0]
        where = f"{self.command} {self.path} -> {status}"
        with desk.lock:
            desk.seen += 1
            if refused and (status >= 400 or self.command == "OPTIONS"):
                desk.agreed += 1  # neither takes this request
            elif verdict:
                said = verdict.get("validation") or verdict.get("detail")
                desk.faults.append(f"{where}: {verdict['title']}: {json.dumps(said)[:600]}")

    def stream(self, headers):
        """Around the proxy, which would hold events back until the last."""
        with self.desk.lock:
            self.desk.around += 1
        connection = http.client.HTTPConnection(self.desk.server, timeout=150)
        connection.request(self.command, self.path, headers=dict(headers))
        answer = connection.getresponse()
        self.send_response_only(answer.status)
        for name, value in answer.getheaders():
            if name.lower() not in HOP_BY_HOP:
                self.send_header(name, value)
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        while piece := answer.read1(65536):
            self.wfile.write(piece)
            self.wfile.flush()
        connection.close()


def start(kind, desk):
    """A relay on a free port of this machine. Returns it; it serves until its shutdown()."""
    relay = ThreadingHTTPServer(("127.0.0.1", 0), type("Bound", (kind,), {"desk": desk}))
    relay.daemon_threads = True
    threading.Thread(target=relay.serve_forever, daemon=True).start()
    return relay
