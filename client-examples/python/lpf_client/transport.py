"""HTTP with patience: requests that are tried again, and bodies streamed from disk."""

import http.client
import json
import random
import ssl
import time
from urllib.parse import urlencode, urlsplit

from .errors import NoServer, UsageError, failure_of

BLOCK = 1 << 16
BROKEN = (OSError, http.client.HTTPException)  # what a lost connection raises
LONGEST_PAUSE = 60.0  # seconds; a server that asks for more is asked again after so long


class FileBody:
    """A file as the body of a request: read as it is sent, told to `progress(sent, size)`."""

    def __init__(self, path, size, progress):
        self._file = open(path, "rb")  # closed by __exit__
        self._size = size
        self._sent = 0
        self._progress = progress

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def read(self, amount=-1):
        """The next block; never more than was announced, should the file have grown."""
        left = self._size - self._sent
        block = self._file.read(left if amount < 0 else min(amount, left))
        self._sent += len(block)
        self._progress(self._sent, self._size)
        return block


class Answer:
    """The response to a request. Close it, or use it in a `with`; json() reads all of it."""

    def __init__(self, connection, response):
        self._connection = connection
        self.response = response
        self.status = response.status
        self.headers = response.headers

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._connection.close()

    def json(self):
        """The body as JSON; {} if it is none."""
        try:
            return json.loads(self.response.read())
        except ValueError:
            return {}


class Transport:
    """Sends requests to one server. `notice(text)` hears about pauses and new tries."""

    def __init__(self, server, api_key=None, retries=5, timeout=60, notice=lambda text: None):
        address = urlsplit(server if "://" in server else "http://" + server)
        if address.scheme not in ("http", "https") or not address.hostname:
            raise UsageError(f"{server!r} is no address of a server; http://127.0.0.1:8080 is one")
        self._address = address
        self._headers = {"User-Agent": "lpf-client", "Connection": "close"}
        if api_key:
            self._headers["Authorization"] = "Bearer " + api_key
        self.retries = retries
        self.timeout = timeout
        self.notice = notice

    def send(self, method, path, query=None, headers=None, body=None, timeout=None):
        """One try. `body`: bytes or an object with read(); raises one of BROKEN if it breaks."""
        kind = (http.client.HTTPSConnection if self._address.scheme == "https"
                else http.client.HTTPConnection)
        connection = kind(self._address.hostname, self._address.port,
                          timeout=timeout or self.timeout, blocksize=BLOCK)
        target = self._address.path.rstrip("/") + path + ("?" + urlencode(query) if query else "")
        try:
            connection.connect()
            try:
                connection.request(method, target, body, {**self._headers, **(headers or {})})
            except (BrokenPipeError, ConnectionResetError):
                pass  # a server that refuses a body early has answered before it hung up
            return Answer(connection, connection.getresponse())
        except BaseException:
            connection.close()
            raise

    def request(self, method, path, open_body=None, **options):
        """Tries until the answer is good; its Answer. `open_body()` gives the body anew each time.

        A request that makes something must carry an Idempotency-Key to be safe here.
        """
        for attempt in range(self.retries + 1):
            try:
                if open_body:
                    with open_body() as body:
                        answer = self.send(method, path, body=body, **options)
                else:
                    answer = self.send(method, path, **options)
            except ssl.SSLCertVerificationError as error:
                raise NoServer(f"{self.name} is not trusted: {error.verify_message}") from error
            except BROKEN as error:
                failure = NoServer(f"{self.name} does not answer: {reason(error)}")
                pause = backoff(attempt)
            else:
                if answer.status < 400:
                    return answer
                with answer:
                    problem = answer.json()
                if not problem:
                    problem = {"title": f"HTTP status {answer.status} from {self.name}"}
                failure = failure_of(answer.status, problem)
                if not is_passing(answer.status, problem):
                    raise failure
                pause = pause_asked_for(answer.headers, attempt)
            if attempt == self.retries:
                raise failure
            self.notice(f"{str(failure).rstrip('.')}. Trying again in {pause:.1f} s "
                        f"({attempt + 1} of {self.retries}).")
            time.sleep(pause)
        raise AssertionError("retries is below 0")

    @property
    def name(self):
        """The server's address for messages: no user, no password, no query."""
        port = f":{self._address.port}" if self._address.port else ""
        return f"{self._address.scheme}://{self._address.hostname}{port}"


def reason(error):
    """Why a connection broke, in words."""
    return getattr(error, "strerror", None) or str(error) or type(error).__name__


def backoff(attempt):
    """Seconds before try `attempt` + 1: doubling, and never the same for two clients."""
    return min(0.5 * 2 ** attempt, LONGEST_PAUSE) * random.uniform(0.75, 1.25)


def is_passing(status, problem):
    """Whether the same request may succeed later."""
    return status in (408, 429, 502, 503, 504) or problem.get("code") == "idempotency-conflict"


def pause_asked_for(headers, attempt):
    """Seconds from Retry-After, which the server knows best; back-off without it."""
    try:
        return min(max(float(headers.get("Retry-After", "")), 0.1), LONGEST_PAUSE)
    except ValueError:
        return backoff(attempt)
