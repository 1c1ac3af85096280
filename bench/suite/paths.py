"""Where things are; everything that is measured or written in between lies below build/."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build"
RELEASE = BUILD / "release"
PROGRAMS = RELEASE / "bench"
ORACLE_POINTS = RELEASE / "test/oracle/oracle_points"
DATA = BUILD / "bench"               # files of points, while a part runs
BROUGHT = BUILD / "brought.json"     # of a folder that `bench.sh pack` has made: what machine.built() said there

sys.path.append(str(ROOT / "scripts"))  # psql_session.py
