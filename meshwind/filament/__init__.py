"""One continuous filament: its band, the circuits that cover a part, and the pattern in which they close."""
