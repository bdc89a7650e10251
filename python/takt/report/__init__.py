"""Reports of runs: one HTML page each that needs nothing else. `takt report`, `takt run --report` and `takt demo` write
them, and so can programs:

    write_report(recording, verdicts, "reports/mine", "A title")
    write_comparison(compare(before, after), "compared.html")

Everything that the page is made of is kept in the recording (`kept`), so that it can be made again from that alone.
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
