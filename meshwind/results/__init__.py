"""A run's folder: names of files and fields, writers, readers, report, staging.

Importing the package loads nothing: the process that draws must start quickly."""
