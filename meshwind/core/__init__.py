"""What every other package stands on: errors, casts, units, threads, what people spell."""
