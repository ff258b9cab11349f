"""Programs read back from their text, by an interpreter that shares no code with the writer, and compared."""
