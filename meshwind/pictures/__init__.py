"""Pictures and movies of a winding: scenes (what is shown) and pictures (how it is drawn)."""
