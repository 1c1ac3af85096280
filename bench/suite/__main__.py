"""bench.sh starts this, with a server in the environment unless it only reports."""
import driver
import paths
from parts import PARTS
from report import Report

driver.main(driver.Book(PARTS, paths.ROOT / "docs/benchmarks.md", Report, paths.BUILD / "bench-results"))
