"""VTK's files (VTK, VTU, VTP) and its data in memory."""
