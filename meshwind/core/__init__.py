"""What all other packages use: errors, casts of arrays, parsing, units, options, threads."""
