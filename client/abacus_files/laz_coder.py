"""The arithmetic coder of LASzip, as far as its table of chunks needs it: symbols, bits, and whole numbers of 32 bits as differences.

Points are left to a library (laz.py). It does not return the table, and the table says where the chunks are.
"""
import bisect

from .psql import Failed

LENGTH, BIT_LENGTH = 15, 13  # bits of a probability: of a symbol, and of a bit
MOST, BIT_MOST = 1 << LENGTH, 1 << BIT_LENGTH  # a model that has counted so many halves its counts
LEAST = 1 << 24  # a shorter interval takes another byte
WORD = 0xFFFFFFFF


class Symbols:
    """How often each symbol came; distribution[n] is the probability of a lesser symbol than n."""

    def __init__(self, count):
        self.counts, self.total, self.cycle = [1] * count, 0, count
        self.update()
        self.cycle = self.left = (count + 6) >> 1

    def update(self):
        self.total += self.cycle
        if self.total > MOST:
            self.counts = [(count + 1) >> 1 for count in self.counts]
            self.total = sum(self.counts)
        scale, below, self.distribution = 0x80000000 // self.total, 0, []
        for count in self.counts:
            self.distribution.append(scale * below >> (31 - LENGTH))
            below += count
        self.cycle = self.left = min(5 * self.cycle >> 2, (len(self.counts) + 6) << 3)


class Bit:
    def __init__(self):
        self.zeros, self.total, self.probability = 1, 2, 1 << (BIT_LENGTH - 1)
        self.cycle = self.left = 4

    def update(self):
        self.total += self.cycle
        if self.total > BIT_MOST:
            self.total, self.zeros = (self.total + 1) >> 1, (self.zeros + 1) >> 1
            self.total += self.zeros == self.total
        self.probability = self.zeros * (0x80000000 // self.total) >> (31 - BIT_LENGTH)
        self.cycle = self.left = min(5 * self.cycle >> 2, 64)


class Decoder:
    def __init__(self, data):
        self.data, self.at, self.length = data, 4, WORD
        self.value = int.from_bytes(data[:4].ljust(4, b"\0"), "big")

    def narrow(self, begin, length):
        self.value, self.length = (self.value - begin) & WORD, length
        while self.length < LEAST:
            if self.length == 0 or self.at > len(self.data) + 4:
                raise Failed("the table of chunks is damaged, or cut off")
            self.value = (self.value << 8 | (self.data[self.at] if self.at < len(self.data) else 0)) & WORD
            self.at, self.length = self.at + 1, self.length << 8

    def bit(self, model):
        zero = model.probability * (self.length >> BIT_LENGTH)
        found = self.value >= zero
        self.narrow(zero if found else 0, self.length - zero if found else zero)
        model.zeros += not found
        model.left -= 1
        if model.left == 0:
            model.update()
        return int(found)

    def symbol(self, model):
        unit, last = self.length >> LENGTH, len(model.counts) - 1
        found = bisect.bisect_right(model.distribution, self.value // unit) - 1
        begin = unit * model.distribution[found]
        self.narrow(begin, (self.length if found == last else unit * model.distribution[found + 1]) - begin)
        model.counts[found] += 1
        model.left -= 1
        if model.left == 0:
            model.update()
        return found

    def bits(self, count):
        if count > 19:
            low = self.bits(16)
            return self.bits(count - 16) << 16 | low
        unit = self.length >> count
        found = min(self.value // unit, (1 << count) - 1)
        self.narrow(found * unit, unit)
        return found


class Differences:
    """Whole numbers of 32 bits, each as the difference from a guess. `contexts`: how many kinds of them there are."""

    HIGH = 8  # so many bits of a difference have a model

    def __init__(self, decoder, contexts):
        self.decoder = decoder
        self.sizes = [Symbols(33) for _ in range(contexts)]
        self.small, self.high = Bit(), [Symbols(1 << min(size, self.HIGH)) for size in range(1, 33)]

    def next(self, guess, context):
        return (guess + self.difference(self.decoder.symbol(self.sizes[context]))) & WORD

    def difference(self, size):
        """A difference of so many bits."""
        if size in (0, 32):
            return self.decoder.bit(self.small) if size == 0 else -(1 << 31)
        found = self.decoder.symbol(self.high[size - 1])
        if size > self.HIGH:
            found = found << (size - self.HIGH) | self.decoder.bits(size - self.HIGH)
        return found + 1 if found >= 1 << (size - 1) else found - ((1 << size) - 1)
