"""From a mesh to an annulus: the two ends are chosen and opened, all other holes filled."""
