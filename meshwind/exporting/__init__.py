"""Files for other programs from a run's folder: shell decks, fibre fields, robot frames, CAD and mesh formats."""
