"""Coordinates that a file has as whole numbers with a scale and an offset.

A place that two files have with different offsets becomes the same double: the one nearest to its decimal. It is a quotient of two numbers that
doubles hold exactly. A product and a sum in doubles round twice, with another result for each offset.
"""
import decimal

EXACT = 1 << 53  # doubles hold all whole numbers up to this
WIDE = 1 << 31  # so large may a whole number of the file be
FINER = 6  # so many digits more than the scale may the offset have; what comes after them is noise
POWERS = 22  # doubles hold the powers of ten up to this


def meant(number):
    """The decimal that a writer had in mind."""
    return decimal.Decimal(f"{number:.15g}").normalize()


def places(number):
    return max(0, -number.as_tuple().exponent)


class Axis:
    """`exact`: whether equal places in several files are equal doubles."""

    def __init__(self, scale, offset):
        self.scale, self.offset, self.divisor = scale, offset, 1.0
        exact_scale, exact_offset = meant(scale), meant(offset)
        least = places(exact_scale)
        self.exact = False
        for digits in range(min(least + FINER, max(least, places(exact_offset))), least - 1, -1):
            factor = decimal.Decimal(10) ** digits
            scale, offset = exact_scale * factor, (exact_offset * factor).to_integral_value()
            if digits <= POWERS and WIDE * abs(scale) + abs(offset) < EXACT:
                self.scale, self.offset, self.divisor, self.exact = float(scale), float(offset), float(factor), True
                break

    def values(self, wholes):
        return (wholes * self.scale + self.offset) / self.divisor
