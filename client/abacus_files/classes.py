"""Classes of lidar points, as the ASPRS numbers them, by name or number."""
from .psql import Failed

NAMES = {"never-classified": 0, "unclassified": 1, "ground": 2, "low-vegetation": 3, "medium-vegetation": 4, "high-vegetation": 5, "building": 6,
         "low-noise": 7, "model-key-point": 8, "water": 9, "rail": 10, "road-surface": 11, "overlap": 12, "wire-guard": 13, "wire-conductor": 14,
         "transmission-tower": 15, "wire-connector": 16, "bridge-deck": 17, "high-noise": 18, "overhead-structure": 19, "ignored-ground": 20,
         "snow": 21, "temporal-exclusion": 22}


def numbers(text):
    """Those of a list with commas."""
    found = set()
    for word in text.split(","):
        name = word.strip().lower().replace(" ", "-").replace("_", "-")
        if name.isdecimal() and int(name) < 256:
            found.add(int(name))
        elif name in NAMES:
            found.add(NAMES[name])
        else:
            raise Failed(f"--class: {word.strip() or text!r} is not a class; classes are numbers from 0 to 255, or {', '.join(NAMES)}")
    return sorted(found)
