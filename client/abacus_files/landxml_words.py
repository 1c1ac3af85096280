"""LandXML: its namespace, its units, and the Feature that has what it has no place for.

    <Feature code="abacus"><Property label="kind" value="soft"/></Feature>

of a Surface: `z`, the name of the attribute that is the elevation. Of a Breakline: `kind`, and the `part` of its line. Of a Boundary: the `lines`
that are the outlines of its region, or its `seeds`.
"""
from xml.sax.saxutils import quoteattr

CODE = "abacus"
NAMESPACE = "http://www.landxml.org/schema/LandXML-1.2"
# {unit of a reference system in PROJ: (system of units, linearUnit, areaUnit, volumeUnit, others)}
UNITS = {"m": ("Metric", "meter", "squareMeter", "cubicMeter", 'temperatureUnit="celsius" pressureUnit="milliBars"'),
         "us-ft": ("Imperial", "USSurveyFoot", "squareFoot", "cubicYard", 'temperatureUnit="fahrenheit" pressureUnit="inHG"'),
         "ft": ("Imperial", "foot", "squareFoot", "cubicYard", 'temperatureUnit="fahrenheit" pressureUnit="inHG"')}


def feature(**properties):
    """XML of those that are not None."""
    inside = "".join(f"<Property label={quoteattr(label)} value={quoteattr(str(value))}/>" for label, value in properties.items() if value is not None)
    return f'<Feature code="{CODE}">{inside}</Feature>' if inside else ""
