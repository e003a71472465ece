"""Starts the server on free ports, and ends it in the ways that servers end."""

import json
import signal

import program


class Server:
    """A running lpf-server. The same folder may be given to one after the other."""

    def __init__(self, folder, *flags, log=None, descriptors=None):
        """The log goes to the file `log`, or to where the tests' own errors go."""
        self.log = open(log, "wb") if log else None  # pylint: disable=consider-using-with
        self.process = program.start(
            ["--host", "127.0.0.1", "--port", "0", "--admin-port", "0", "--data-dir", str(folder),
             "--disk-floor-bytes", "0", "--disk-floor-percent", "0", "--log-level", "warn", *flags],
            self.log, descriptors)
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError(f"the server did not start: exit {self.process.wait()}")
        ready = json.loads(line)
        assert ready["event"] == "listening"
        self.url = f"http://127.0.0.1:{ready['port']}"
        self.admin_url = f"http://127.0.0.1:{ready['adminPort']}"

    @property
    def pid(self):
        return program.pid(self.process)

    def terminate(self):
        """An orderly stop. Returns the exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=30)

    def kill(self):
        """The end that no program can prepare for."""
        self.process.kill()
        self.process.wait(timeout=30)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.kill()
        self.process.stdout.close()
        if self.log:
            self.log.close()
