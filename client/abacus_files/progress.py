"""How far a long import or export is: a line on a terminal, nothing in a pipe."""
import sys
import time

EVERY = 0.3  # seconds
AFTER = 2  # seconds: what takes less time says nothing


def span(seconds):
    minutes, seconds = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


class Progress:
    """`total`: rows in all. Use it in `with`: its line goes when the work is done."""

    def __init__(self, what, total, after=AFTER, stream=None):
        self.stream = sys.stderr if stream is None else stream
        self.shown = self.stream.isatty()
        self.what, self.total, self.rows, self.bytes = what, total, 0, 0
        self.begun = time.monotonic()
        self.next, self.width = self.begun + after, 0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.write("")

    def add(self, rows, size=0):
        self.rows += rows
        self.bytes += size
        now = time.monotonic()
        if self.shown and now >= self.next:
            self.next = now + EVERY
            self.write(self.text(now - self.begun))

    def text(self, passed):
        left = passed / self.rows * max(self.total - self.rows, 0) if self.rows else None
        return (f"{self.what}: {self.rows:,} of {self.total:,} rows, {self.bytes / 1e6:,.1f} MB"
                + (f", {span(left)} left" if left is not None else ""))

    def say(self, text):
        """A text in place of the figures, for a step that has none."""
        if self.shown:
            self.write(text)
            self.stream.write("\n")  # what the server says comes below
            self.width = 0

    def write(self, text):
        if text or self.width:
            self.stream.write("\r" + text.ljust(self.width) + ("" if text else "\r"))
            self.stream.flush()
        self.width = len(text)
