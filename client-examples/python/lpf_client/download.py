"""Downloads that are continued when they break, checked, and written whole or not at all."""

import hashlib
import os
import time

from .errors import CannotSave, NoServer
from .transport import BLOCK, BROKEN, backoff


class _Part:
    """A new file beside the target, which takes its place once it is complete."""

    def __init__(self, target):
        self._target = os.path.abspath(target)
        folder, name = os.path.split(self._target)
        self._path = os.path.join(folder, f".{name}.{os.getpid()}.part")
        # Not by tempfile: the result gets the permissions of any other new file.
        self._file = open(self._path, "xb")
        self.restart()

    def restart(self):
        """Forgets what was written."""
        self._file.seek(0)
        self._file.truncate()
        self.size, self._hash = 0, hashlib.sha256()

    def write(self, block):
        """Appends."""
        self._file.write(block)
        self._hash.update(block)
        self.size += len(block)

    @property
    def sha256(self):
        """Of what was written."""
        return self._hash.hexdigest()

    def keep(self):
        """Shows the file under its name, once it is on the disk."""
        self._file.flush()
        os.fsync(self._file.fileno())
        self._file.close()
        os.replace(self._path, self._target)

    def drop(self):
        """Removes what is left of the file, if it was not kept."""
        self._file.close()
        if os.path.exists(self._path):
            os.unlink(self._path)


def download(transport, result, path, progress):
    """Fetches one entry of a job's results to `path`, or leaves `path` alone; its size."""
    try:
        part = _Part(path)
    except OSError as error:
        raise CannotSave(f"{path} cannot be written: {error.strerror}") from error
    try:
        _fetch(transport, result, part, progress)
        if part.sha256 != result["sha256"]:
            raise CannotSave(f"{path} was not written: what came has another SHA-256 than the "
                             "server announced. Something on the way changes files.")
        try:
            part.keep()
        except OSError as error:
            raise CannotSave(f"{path} cannot be written: {error.strerror}") from error
        return part.size
    finally:
        part.drop()


def _fetch(transport, result, part, progress):
    """Reads the whole result, continuing where a broken connection stopped."""
    broken = 0  # times in a row without a new byte
    while True:
        before = part.size
        headers = {}
        if part.size:
            headers = {"Range": f"bytes={part.size}-", "If-Range": f'"{result["sha256"]}"'}
        with transport.request("GET", result["href"], headers=headers) as answer:
            if answer.status != 206:
                part.restart()
            error = _read(answer, part, result["bytes"], progress)
        if part.size >= result["bytes"]:
            return
        broken = broken + 1 if part.size <= before else 0
        if broken > transport.retries:
            raise NoServer(f"The download broke off {broken} times: {error}")
        transport.notice("The download broke off; continuing.")
        time.sleep(backoff(broken))


def _read(answer, part, size, progress):
    """Reads until the end or until it breaks; what broke it, or "it ended early"."""
    while True:
        try:
            block = answer.response.read(BLOCK)
        except BROKEN as error:
            return str(error) or type(error).__name__
        if not block:
            return "it ended early"
        try:
            part.write(block)
        except OSError as error:
            raise CannotSave(f"The result cannot be written: {error.strerror}") from error
        progress(part.size, size)
