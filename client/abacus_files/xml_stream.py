"""XML as a stream: elements without their namespaces, one after the other. A document that declares or needs entities is refused."""
import xml.parsers.expat

from .psql import Failed



class Stream:
    """Calls start(name, attributes, line) and end(name, text, line), whose text is that of an element without children."""

    def __init__(self, start, end):
        self.started, self.ended = start, end
        self.parser = xml.parsers.expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler, self.parser.EndElementHandler = self.start, self.end
        self.parser.CharacterDataHandler = lambda data: self.text.append(data)
        self.parser.EntityDeclHandler = self.parser.SkippedEntityHandler = self.parser.StartDoctypeDeclHandler = self.refuse
        self.text, self.lines = [], []

    def refuse(self, *_):
        raise Failed(f"line {self.parser.CurrentLineNumber}: has a DOCTYPE or entities, which are not read")

    def start(self, name, attributes):
        self.text = []
        self.lines.append(self.parser.CurrentLineNumber)
        self.started(name.rpartition(" ")[2], attributes, self.lines[-1])

    def end(self, name):
        text, self.text = "".join(self.text), []
        self.ended(name.rpartition(" ")[2], text, self.lines.pop())

    def parse(self, path):
        with open(path, "rb") as file:
            try:
                self.parser.ParseFile(file)
            except xml.parsers.expat.ExpatError as error:
                raise Failed(f"line {error.lineno}: is not XML, or is cut off: {error}") from error
