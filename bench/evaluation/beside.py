"""Tables with the dissertation's figures beside ours, and how the figures are written."""
from document import number

NOTHING = "–"
THERE, HERE = "there", "here"


class Beside:
    """A table: a column for each data set, two lines for each row."""

    def __init__(self, figure, keys, measured, heading, others=()):
        """`keys` are the dissertation's columns; `measured` holds ours, in dictionaries with the key
        of the column in their field `key`; `others` have columns too."""
        self.figure = figure
        self.theirs = {key: place for place, key in enumerate(keys)}
        self.ours = self.by_column(measured)
        self.keys = sorted({*keys, *self.ours, *self.by_column(others)})
        self.head = ["", "", *map(heading, self.keys)]
        self.rows = []

    def by_column(self, entries):
        return {nearest(entry["key"], self.theirs): entry for entry in entries}

    def add(self, label, theirs, ours=None, entries=None):
        """A row: its name in the dissertation's table or None; our text of an entry, of those by
        column, or None."""
        if isinstance(theirs, str):
            theirs = self.figure[theirs]
        if theirs is not None:
            self.rows.append([label, THERE, *(theirs[self.theirs[key]] if key in self.theirs else NOTHING
                                              for key in self.keys)])
        if ours is not None:
            entries = self.ours if entries is None else entries
            self.rows.append(["" if theirs is not None else label, HERE,
                              *(text(ours, entries.get(key)) for key in self.keys)])

    def markdown(self):
        lines = ["| " + " | ".join(self.head) + " |", "|---|---|" + "---:|" * len(self.keys)]
        lines += ["| " + " | ".join(map(str, row)) + " |" for row in self.rows]
        return "\n".join(lines) + "\n"


def nearest(key, keys):
    """That of the dissertation's columns which means the same."""
    return next((other for other in keys if abs(other - key) <= 0.01 * other), key)


def text(write, entry):
    if entry is None:
        return NOTHING
    value = write(entry)
    return NOTHING if value is None else value


def clock(seconds):
    """As the dissertation writes times: h:mm:ss, m:ss, m:ss.s for short ones."""
    if seconds is None:
        return None
    if round(seconds, 1) < 60:
        return f"0:{seconds:04.1f}"
    whole = round(seconds)
    hours, minutes = whole // 3600, whole // 60 % 60
    return (f"{hours}:{minutes:02}:" if hours else f"{minutes}:") + f"{whole % 60:02}"


def percent(share, digits=2):
    return None if share is None else f"{100 * share:.{digits}f} %"


def count(value):
    """As the dissertation writes counts: 11 M, 1.1 B; small ones in full."""
    if value is None:
        return None
    for unit, name in ((10**9, "B"), (10**6, "M")):
        if value >= unit:
            return f"{value / unit:.4g} {name}"
    return f"{value:,.0f}"


def size(amount):
    """Bytes, in powers of ten, as the dissertation counts them."""
    if amount is None:
        return None
    for unit, name in ((10**9, "GB"), (10**6, "MB"), (10**3, "KB")):
        if amount >= unit:
            return f"{number(amount / unit)} {name}"
    return f"{amount} B"
