"""Shows how far something is: a bar on a terminal, a line now and then elsewhere."""

import shutil
import sys
import time

from .errors import printable


def duration(seconds):
    """0.4 s, 45 s, 3:05 min, 1:02 h."""
    if seconds < 9.95:
        return f"{max(0, seconds):.1f} s"
    seconds = round(seconds)
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60}:{seconds % 60:02} min"
    return f"{seconds // 3600}:{seconds // 60 % 60:02} h"


def size(count):
    """812 B, 3.4 kB, 12.0 MB."""
    if count < 1000:
        return f"{count} B"
    for unit in ("kB", "MB"):
        count /= 1000
        if count < 1000:
            return f"{count:.1f} {unit}"
    return f"{count / 1000:.1f} GB"


class Progress:
    """One line of progress on stderr. Used in a `with`, it ends its line."""

    def __init__(self, quiet=False, stream=None):
        self._stream = stream or sys.stderr
        self._quiet = quiet
        self._bar = self._stream.isatty()
        self._said = None  # (what, tens of per cent) of the last plain line
        self._said_at = 0.0
        self._open = False  # the cursor stands behind a bar

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.clear()

    def transfer(self, what):
        """A callback (done, total) for bytes."""
        return lambda done, total: self.show(
            what, 100 * done / total if total else 100, f"{size(done)} of {size(total)}")

    def job(self, state):
        """Shows a statusInfo."""
        if state.get("status") == "accepted":
            place = state.get("queuePosition")
            self.show("waiting", 0, f"place {place} in the queue" if place else "")
            return
        phase = state.get("phaseProgress") or {}
        notes = [state.get("phase") or state.get("status", "")]
        if phase.get("total"):
            notes.append(f"{phase.get('done', 0)}/{phase['total']} {phase.get('unit', '')}")
        if state.get("etaSeconds") and state.get("status") == "running":
            notes.append(f"{duration(state['etaSeconds'])} left")
        self.show(state.get("processID", "job"), state.get("progress", 0), ", ".join(notes))

    def show(self, what, percent, note):
        """The state of what is going on."""
        if self._quiet:
            return
        what, note = printable(what), printable(note).strip()
        if self._bar:
            self._draw(what, percent, note)
        elif (what, percent // 10) != self._said and (
                percent >= 100 or what != (self._said or "_")[0]
                or time.monotonic() - self._said_at > 1):
            self._said, self._said_at = (what, percent // 10), time.monotonic()
            self._print(f"{what}: {percent:.0f} %{', ' + note if note else ''}")

    def _draw(self, what, percent, note):
        columns = shutil.get_terminal_size().columns - 1
        width = min(30, max(0, columns - 60))
        bar = "#" * round(width * min(percent, 100) / 100)
        line = f"{what:<10.10} [{bar:.<{width}}] {percent:3.0f} %  {note}"[:columns]
        self._stream.write("\r\x1b[K" + line)
        self._stream.flush()
        self._open = True

    def clear(self):
        """Ends the line of the bar, which stays to be seen."""
        if self._open:
            self._stream.write("\n")
            self._stream.flush()
            self._open = False

    def say(self, text):
        """A line of its own."""
        if not self._quiet:
            self.clear()
            self._print(printable(text))

    def _print(self, text):
        print(text, file=self._stream, flush=True)
