"""XML as elements that say their lines."""
import xml.etree.ElementTree
import xml.parsers.expat

from .psql import Failed

LINE = "abacus:line"  # an attribute that each element gets


class _Found(Exception):
    """The element up to which a file is parsed."""


def parse(data, until=None):
    """The root element; and, of the first element named `until`, where what follows may not be XML, its byte and its attributes, or None."""
    builder, parser, open_, found = xml.etree.ElementTree.TreeBuilder(), xml.parsers.expat.ParserCreate(), [], None

    def start(name, attributes):
        nonlocal found
        if name == until:
            found = parser.CurrentByteIndex, attributes
            raise _Found
        open_.append(name)
        builder.start(name, {**attributes, LINE: str(parser.CurrentLineNumber)})

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: builder.end(open_.pop())
    parser.CharacterDataHandler = builder.data
    parser.buffer_text = True
    try:
        parser.Parse(data, True)
    except _Found:
        while open_:
            builder.end(open_.pop())
    except xml.parsers.expat.ExpatError as error:
        raise Failed(f"line {error.lineno}: is not XML, or is cut off: {error}") from error
    return builder.close(), found
