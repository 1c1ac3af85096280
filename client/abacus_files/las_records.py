"""The records of LAS points: their fields in each of the point formats 0 to 10, and the numbers in them."""
import numpy

FIRST_LONG = 6  # from this format on, records have more bits for returns and classes
PLACE = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2"), ("returns", "u1")]
SHORT = [*PLACE, ("flags", "u1"), ("angle", "i1"), ("user_data", "u1"), ("point_source_id", "<u2")]
LONG = [*PLACE, ("flags", "u1"), ("classification", "u1"), ("user_data", "u1"), ("angle", "<i2"), ("point_source_id", "<u2"), ("gps_time", "<f8")]
TIME = [("gps_time", "<f8")]
COLOURS = [("red", "<u2"), ("green", "<u2"), ("blue", "<u2")]
NEAR = [("nir", "<u2")]
FIELDS = (SHORT, SHORT + TIME, SHORT + COLOURS, SHORT + TIME + COLOURS, SHORT + TIME, SHORT + TIME + COLOURS,
          LONG, LONG + COLOURS, LONG + COLOURS + NEAR, LONG, LONG + COLOURS + NEAR)
# {attribute: type of its column}; z is the first, whatever a user chooses
TYPES = {"z": "float8", "intensity": "int4", "return_number": "int2", "number_of_returns": "int2", "classification": "int2", "scan_angle": "float8",
         "user_data": "int2", "point_source_id": "int4", "gps_time": "float8", "red": "int4", "green": "int4", "blue": "int4", "nir": "int4"}
USUAL = ("z", "intensity", "return_number", "classification")
DEGREES = 0.006  # a step of the angle in long records; in short ones it is a degree


class Records:
    """How the records of a header are read; `names`: the attributes that they have."""

    def __init__(self, header):
        self.long = header.format >= FIRST_LONG
        fields = FIELDS[header.format]
        names = [name for name, _ in fields]
        places = numpy.cumsum([0, *(numpy.dtype(kind).itemsize for _, kind in fields)])[:-1].tolist()
        self.dtype = numpy.dtype({"names": names, "formats": [kind for _, kind in fields], "offsets": places, "itemsize": header.length})
        self.names = [name for name in TYPES if name in (*names, "z", "return_number", "number_of_returns", "classification", "scan_angle")]

    def withheld(self, records):
        return records["flags"] & (4 if self.long else 0x80) != 0

    def classes(self, records):
        return records["classification"] if self.long else records["flags"] & 31

    def values(self, name, records):
        """An attribute, but z."""
        if name == "return_number":
            return records["returns"] & (15 if self.long else 7)
        if name == "number_of_returns":
            return records["returns"] >> 4 if self.long else records["returns"] >> 3 & 7
        if name == "classification":
            return self.classes(records)
        if name == "scan_angle":
            return records["angle"] * DEGREES if self.long else records["angle"]
        return records[name]
