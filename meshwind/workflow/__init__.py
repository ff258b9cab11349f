"""The work on one part, written once: its options, reading, fitting and winding it, and the notes for the user."""
