"""A file of numbers in text, word by word."""
import numpy

from .psql import Failed


def read_text(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


class Words:
    """The words of a text in turn. Comments from # to the end of a line are none."""

    def __init__(self, text, comments=True):
        if comments and "#" in text:
            text = "\n".join(line.split("#", 1)[0] for line in text.split("\n"))
        self.words = text.split()
        self.at = 0

    def take(self, count, what):
        if count < 0:
            raise Failed(f"says that it has {count} {what}")
        if count > len(self.words) - self.at:
            raise Failed(f"ends before all {what} are there")
        self.at += count
        return self.words[self.at - count: self.at]

    def table(self, rows, width, what):
        """So many rows of words, as a flat list."""
        return self.take(rows * width, what)

    def whole(self, what):
        return int(self.take(1, what)[0])


def floats(words):
    return numpy.array(list(map(float, words)), dtype=float)


def integers(words):
    return numpy.array(list(map(int, words)), dtype=numpy.int64)


def places(corners, numbers):
    """Corners that are numbers of points as the points' places, from 0."""
    order = numpy.argsort(numbers, kind="stable")
    ordered = numbers[order]
    if (ordered[1:] == ordered[:-1]).any():
        raise Failed(f"two points have the number {ordered[1:][ordered[1:] == ordered[:-1]][0]}")
    at = numpy.minimum(numpy.searchsorted(ordered, corners), max(len(ordered) - 1, 0))
    missing = ordered[at] != corners if len(ordered) else numpy.ones(corners.shape, bool)
    if missing.any():
        raise Failed(f"a cell names point {corners[missing][0]}, which is not there")
    return order[at]
