"""Files, report and pictures."""
