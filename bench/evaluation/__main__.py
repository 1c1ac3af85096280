"""evaluation.sh starts this, with a server in the environment unless it only reports."""
import driver
import paths
from evaluation_report import EvaluationReport
from evaluation_parts import PARTS

driver.main(driver.Book(PARTS, paths.ROOT / "docs/evaluation.md", EvaluationReport,
                        paths.BUILD / "evaluation-results"))
