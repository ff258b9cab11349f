"""What programs that prepare prints keep beside the model of a 3MF file: which meshes they do not print themselves."""

from xml.parsers import expat

from meshwind.mesh.io.threemf.package import Package, parse

_PAINTED = rb'"(?:NegativeVolume|ParameterModifier|SupportBlocker|SupportEnforcer)"'
_PAINTED_IN = "metadata/slic3r_pe_model.config"
"""Where PrusaSlicer keeps what each part of a mesh is for, and those that are not printed."""
_SETTINGS = "metadata/model_settings.config"
"""Where Bambu Studio and OrcaSlicer keep what each component of an object is for."""
_PRINTED = ("", "normal_part")


def painted(package: Package) -> int:
    """Number of parts of meshes that are not printed: their triangles are among those of the mesh."""
    return package.count(_PAINTED_IN, _PAINTED)


def not_printed(package: Package) -> dict[tuple[str, str], str]:
    """What components that are not printed are for, by the ids of the object that has them and of their own.

    Their objects should be of the type "other", but not every program that writes such files sets it.
    """
    found: dict[tuple[str, str], str] = {}
    if _SETTINGS not in package.members:
        return found
    owner = [""]

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag == "object":
            owner[0] = attributes.get("id", "")
        elif tag == "part" and attributes.get("subtype", "") not in _PRINTED:
            found[owner[0], attributes.get("id", "")] = attributes["subtype"]

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    with package.open(_SETTINGS) as part:
        parse(parser, part, _SETTINGS)
    return found
