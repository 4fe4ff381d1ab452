"""Counts what ran: prints every suite that failed and, last, "N passed, N failed, N skipped". Exit status 1 where anything failed."""

import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from pathlib import Path


def outcomes(report: Path) -> Counter[str]:
    if report.suffix == ".check":
        return Counter([report.read_text().strip()])
    found: Counter[str] = Counter()
    for case in ElementTree.parse(report).iter("testcase"):
        tags = {child.tag for child in case}
        skipped = "skipped" in tags or case.get("status") == "notrun"
        found["failed" if tags & {"failure", "error"} else "skipped" if skipped else "passed"] += 1
    return found


total: Counter[str] = Counter()
for report in sorted(Path(sys.argv[1]).iterdir()):
    counted = outcomes(report)
    total += counted
    if counted["failed"]:
        print(f"failed: {report.stem}")
print(f"{total['passed']} passed, {total['failed']} failed, {total['skipped']} skipped")
sys.exit(1 if total["failed"] or not total["passed"] else 0)
