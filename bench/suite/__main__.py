"""bench.sh starts this, with a server in the environment unless it only reports."""
import sys

import acceptance
import driver
import paths
from parts import PARTS
from report import Report
from results import Results

BOOK = driver.Book(PARTS, paths.ROOT / "docs/benchmarks.md", Report, paths.BUILD / "bench-results",
                   template=paths.ROOT / "bench/suite/page.md.in")

if sys.argv[1:] == ["aims"]:
    print(acceptance.aims(Results.read(BOOK.committed)), end="")
else:
    driver.main(BOOK)
