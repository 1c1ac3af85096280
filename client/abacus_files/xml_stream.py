"""XML as a stream: elements without their namespaces, one after the other. A document that declares or needs entities is refused."""
import xml.parsers.expat

from .psql import Failed

CHUNK = 4096


def local(name):
    """Without its namespace."""
    return name.rpartition(" ")[2]


def root(path):
    """The name of the outermost element; None if there is none, as in a file that is not XML."""
    found, parser = [], xml.parsers.expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = lambda name, _: found.append(local(name))
    with open(path, "rb") as file:
        try:
            while not found and (data := file.read(CHUNK)):
                parser.Parse(data)
        except xml.parsers.expat.ExpatError:
            pass
    return found[0] if found else None


class Stream:
    """Calls start(name, attributes, line) and end(name, text, line), whose text is that of an element without children. `root`: the outermost element."""

    def __init__(self, root, start, end):
        self.root, self.started, self.ended = root, start, end
        self.parser = xml.parsers.expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler, self.parser.EndElementHandler = self.start, self.end
        self.parser.CharacterDataHandler = lambda data: self.text.append(data)
        self.parser.StartDoctypeDeclHandler = self.doctype
        self.parser.EntityDeclHandler = self.parser.SkippedEntityHandler = self.refuse
        self.text, self.lines = [], []

    def refuse(self, *_):
        raise Failed(f"line {self.parser.CurrentLineNumber}: has a DOCTYPE or entities, which are not read")

    def doctype(self, name, *_):
        self.check_root(name.rpartition(":")[2])
        self.refuse()

    def check_root(self, name):
        if name != self.root:
            raise Failed(f"line {self.parser.CurrentLineNumber}: is not {self.root}, but {name}")

    def start(self, name, attributes):
        if not self.lines:
            self.check_root(local(name))
        self.text = []
        self.lines.append(self.parser.CurrentLineNumber)
        self.started(local(name), attributes, self.lines[-1])

    def end(self, name):
        text, self.text = "".join(self.text), []
        self.ended(local(name), text, self.lines.pop())

    def parse(self, path):
        with open(path, "rb") as file:
            try:
                self.parser.ParseFile(file)
            except xml.parsers.expat.ExpatError as error:
                raise Failed(f"line {error.lineno}: is not XML, or is cut off: {error}") from error
