"""A file of numbers in text, word by word. Errors name the line."""
import numpy

from .english import counted
from .psql import Failed


def read_text(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def number(word, kind):
    """A number as files have it: what Python takes as well, such as 1_000, is none."""
    if "_" in word:
        raise ValueError
    return kind(word)


def numbers(words, kind, line_of):
    """Words as an array; line_of(n) says in which line the nth is."""
    try:
        if any("_" in word for word in words):
            raise ValueError
        return numpy.array(list(map(kind, words)), dtype=float if kind is float else numpy.int64)
    except (ValueError, OverflowError):
        for n, word in enumerate(words):
            try:
                found = number(word, kind)
                if kind is float or -(1 << 63) <= found < 1 << 63:
                    continue
            except ValueError:
                pass
            raise Failed(f"line {line_of(n)}: {word} is not a {'' if kind is float else 'whole '}number"
                         f"{'' if kind is float else ' of at most 64 bits'}") from None
        raise


class Words:
    """The words of a text in turn. Comments from # to the end of a line are none. `line`: the number of its first line."""

    def __init__(self, text, comments=True, line=1):
        if comments and "#" in text:
            text = "\n".join(line.split("#", 1)[0] for line in text.split("\n"))
        self.text, self.first = text, line
        self.words = text.split()
        self.at = 0

    def line(self, at):
        """The line of a word; of what comes after the last one, the last line that has a word."""
        last, count = self.first, 0
        for n, line in enumerate(self.text.split("\n"), self.first):
            words = len(line.split())
            count += words
            last = n if words else last
            if count > at:
                break
        return last

    def fail(self, said, back=1):
        """An error about a word that has been taken, so many back."""
        raise Failed(f"line {self.line(max(self.at - back, 0))}: {said}")

    def take(self, count, what):
        if count < 0:
            self.fail(f"the file says that it has {count} {what}")
        if count > len(self.words) - self.at:
            raise Failed(f"line {self.line(len(self.words))}: the file ends before all {what} are there")
        self.at += count
        return self.words[self.at - count: self.at]

    def floats(self, count, what):
        begin = self.at
        return numbers(self.take(count, what), float, lambda n: self.line(begin + n))

    def integers(self, count, what):
        begin = self.at
        return numbers(self.take(count, what), int, lambda n: self.line(begin + n))

    def whole(self, what):
        return int(self.integers(1, what)[0])


class Rows:
    """The lines of a text that have words, in turn, each a list of them; errors name the line. Comments from # are none."""

    def __init__(self, text):
        lines = (line.split("#", 1)[0].split() for line in text.split("\n"))
        self.rows = [(n, words) for n, words in enumerate(lines, 1) if words]
        self.at = 0

    def fail(self, n, said):
        raise Failed(f"line {self.rows[n][0] if self.rows else 1}: {said}")

    def more(self):
        return self.at < len(self.rows)

    def row(self, what):
        if self.at == len(self.rows):
            self.fail(-1, f"the file ends before {what}")
        self.at += 1
        return self.rows[self.at - 1][1]

    def whole(self, least, what):
        """The whole numbers of a line that has so many at least."""
        words = self.row(what)
        if len(words) < least:
            self.fail(self.at - 1, f"{what} should have at least {counted(least, 'number')}, but has {len(words)}")
        return numbers(words, int, lambda n: self.rows[self.at - 1][0]).tolist()

    def table(self, count, width, what):
        """So many lines of so many words each, as a flat list, and the place of the first line."""
        if count < 0:
            self.fail(self.at - 1, f"the file says that it has {count} {what}")
        begin, end = self.at, self.at + count
        if end > len(self.rows):
            self.fail(-1, f"the file ends after {len(self.rows) - begin} of {count} {what}")
        wrong = next((n for n in range(begin, end) if len(self.rows[n][1]) != width), None)
        if wrong is not None:
            self.fail(wrong, f"{counted(len(self.rows[wrong][1]), 'number')}, where {what} have {width}")
        self.at = end
        return [word for _, words in self.rows[begin: end] for word in words], begin

    def numbers(self, words, kind, begin, width):
        """Words of a table, so many of each line, as an array."""
        return numbers(words, kind, lambda n: self.rows[begin + n // width][0])


class Places:
    """Numbers of points as the points' places, from 0. line_of(n): the line of the nth point."""

    def __init__(self, numbers, line_of=None):
        self.order = numpy.argsort(numbers, kind="stable")
        self.ordered = numbers[self.order]
        twice = self.ordered[1:] == self.ordered[:-1]
        if twice.any():
            second = int(self.order[1:][twice][0])
            raise Failed(f"{f'line {line_of(second)}: ' if line_of else ''}two points have the number {numbers[second]}")

    def of(self, corners, line_of=None, what="cell"):
        """Those of an array of numbers. line_of(n): the line of the nth. `what` names them."""
        ordered = self.ordered
        at = numpy.minimum(numpy.searchsorted(ordered, corners), max(len(ordered) - 1, 0))
        missing = ordered[at] != corners if len(ordered) else numpy.ones(corners.shape, bool)
        if missing.any():
            where = f"line {line_of(int(numpy.flatnonzero(missing.reshape(-1))[0]))}: " if line_of else ""
            raise Failed(f"{where}a {what} names point {corners[missing][0]}, which is not there")
        return self.order[at]
