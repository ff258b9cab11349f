"""The program of a machine that winds a filament: eye, axes, time, and the files that say so."""
