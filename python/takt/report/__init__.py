"""Reports of runs: one self-contained HTML page each. `takt report`, `takt run --report` and `takt demo` write them,
and so can programs:

    write_report(recording, verdicts, "reports/mine", "A title")
    write_comparison(compare(before, after), "compared.html")

All data of the page are kept in the recording (`kept`), so the page can be made again from that alone.
"""

from takt.report.comparison import Comparison, Difference, compare
from takt.report.comparison_page import render_comparison, write_comparison
from takt.report.kept import keep
from takt.report.writing import Report, render, render_kept, write_report

__all__ = [
    "Comparison",
    "Difference",
    "Report",
    "compare",
    "keep",
    "render",
    "render_comparison",
    "render_kept",
    "write_comparison",
    "write_report",
]
