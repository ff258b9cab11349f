"""Files, report and pictures.  Loads nothing by itself: the process that draws must start quickly."""
