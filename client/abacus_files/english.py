"""Numbers of things in messages."""


def counted(count, noun, nouns=None):
    """1 region, 2 regions. `nouns`: the plural, where it is not the noun with an s."""
    return f"{count} {noun if count == 1 else nouns or noun + 's'}"
