"""Fitting: a smooth periodic surface from a flattened mesh, with what the mesh leaves uncertain of it.

`fit` asks the vertices first (`vertex_fit`), looks at how they stand to the surface (`evidence`), follows the facets
where these are truer (`facet_fit`, to the integral over `quadrature` points), and states its error (`certify`, to the
mesh; `uncertainty`, to the true part).  Both set up `normal_equations` of a net, which `linear_systems` solves.
"""

from meshwind.surface.fitting.fit import fit

__all__ = ["fit"]
