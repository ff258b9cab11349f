"""The compiled loops of the taut-path solver."""
