"""What other programs take: shell decks, fibre fields, robot frames, CAD and mesh formats, from a results folder."""
