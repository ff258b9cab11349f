"""`python -m meshwind`."""

from meshwind.cli import main

main()
