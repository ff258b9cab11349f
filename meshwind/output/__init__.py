"""Files, report and pictures."""

from meshwind.output.report import report as report
from meshwind.output.report import write_report as write_report
from meshwind.output.write import write_files as write_files
