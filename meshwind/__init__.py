"""meshwind winds taut fibres on any freeform triangle mesh."""
