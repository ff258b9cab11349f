"""The sample parts in `data/`: smooth maps, and their irregular meshes."""
