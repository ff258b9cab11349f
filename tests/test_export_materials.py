"""Materials of shell decks: each figure has a source, and one's own file is checked."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from export_results import plain_results

from meshwind.cli import export as command
from meshwind.core.errors import BadInputError
from meshwind.exporting.material import STRENGTHS, Material, material_names, read_material
from meshwind.exporting.shell_about import read_about
from meshwind.exporting.targets import ExportOptions, write_exports
from meshwind.results.schema import SHELL, SHELL_ABOUT, SHELL_S4R

OWN = "e1 = 40000\ne2 = 12000\nnu12 = 0.3\nnu23 = 0.4\ng12 = 4000\ndensity = 2000\n"


@pytest.mark.parametrize("name", material_names())
def test_each_figure_of_a_material_has_a_source(name: str) -> None:
    material = read_material(name)
    assert set(material.sources) == {"e1", "e2", "nu12", "nu23", "g12", "density", *material.strengths}
    assert all(len(source) > 20 and source.isascii() for source in material.sources.values())
    assert material.words and 1.0e-9 < material.density < 2.2e-9
    assert not material.strengths or set(material.strengths) == set(STRENGTHS)
    moduli = material.moduli("mm")
    poisson = np.diag(1.0 / np.array(moduli[:3]))
    for (i, j), nu in zip(((0, 1), (0, 2), (1, 2)), moduli[3:6], strict=True):
        poisson[i, j] = poisson[j, i] = -nu / moduli[i]
    assert np.linalg.eigvalsh(poisson).min() > 0.0


def test_the_default_is_t700_and_help_names_all() -> None:
    made = read_material()
    assert replace(made, words="", strengths={}, sources={}) == Material(
        "T700_EPOXY", 135000.0, 9000.0, 0.3, 0.4, 4800.0, 1.6e-9
    )
    assert list(command.MATERIALS) == material_names()
    assert read_material("EPOXY").g12 == pytest.approx(4200.0 / (2.0 * 1.34), rel=1e-3)
    assert not read_material("dry-tow").strengths


def test_interaction_and_strengths_come_from_the_file(tmp_path: Path) -> None:
    """Also in metres: stresses in Pa."""
    (tmp_path / "own.toml").write_text(OWN + "xt = 1000\nxc = 600\nyt = 40\nyc = 150\ns = 60\ninteraction = -0.2\n")
    plain_results(tmp_path, "m")
    asked = ExportOptions(count=100, thickness=0.01, material=str(tmp_path / "own.toml"))
    write_exports(tmp_path, ("inp",), options=asked)
    assert (
        "*FAIL STRESS\n1e+09, -600000000, 40000000, -150000000, 60000000, -0.2\n" in (tmp_path / SHELL_S4R).read_text()
    )
    about = read_about(tmp_path / SHELL_ABOUT)
    assert (about.strengths.of["xc"], about.strengths.interaction, about.units) == (600.0, -0.2, "m")


def test_decks_have_the_material_of_a_file_and_say_its_sources(tmp_path: Path) -> None:
    plain_results(tmp_path)
    (tmp_path / "2 glass.toml").write_text(OWN + "[sources]\ne1 = 'coupons of our own'\n")
    for material, name, said in (
        (str(tmp_path / "2 glass.toml"), "M_2_GLASS", "** e1: coupons of our own"),
        ("e-glass-epoxy", "E_GLASS_EPOXY", "xt 1280, xc 800, yt 40, yc 145, s 73"),
    ):
        write_exports(tmp_path, ("inp",), options=ExportOptions(count=100, thickness=0.01, material=material))
        for deck in (SHELL, SHELL_S4R):
            text = (tmp_path / deck).read_text()
            assert max(map(len, text.splitlines())) < 125
            assert f"*MATERIAL, NAME={name}\n" in text and said in text
            assert f", 3, {name}, " in text
            after = text[text.index("*ELASTIC") :].splitlines()
            wanted = read_material(material)
            assert list(map(float, after[1].rstrip(",").split(","))) == pytest.approx(wanted.moduli("mm")[:8])
            assert float(after[after.index("*DENSITY") + 1]) == pytest.approx(wanted.density)
            assert ("*FAIL STRESS\n1280, -800, 40, -145, 73, -0.5\n" in text) == (
                deck == SHELL_S4R and bool(wanted.strengths)
            )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no e1; give e1, e2"),
        (OWN.replace("40000", "0"), "e1 of .* is 0; give a number above 0"),
        (OWN.replace("40000", "'stiff'"), "e1 of .* is 'stiff'; give a number"),
        (OWN.replace("nu23 = 0.4", "nu23 = 1.0"), "not stable: nu23 is 1"),
        (OWN + "youngs = 3", "has no 'youngs'"),
        (OWN + "xt = 3", "no xc; give all of"),
        (OWN + "interaction = -1", "interaction of .* is -1; give a number between -1 and 1"),
        (OWN + "words = 3", "words of .* is 3"),
        (OWN + "sources = 3", "give \\[sources\\]"),
    ],
)
def test_a_file_that_is_no_material_is_refused(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "own.toml"
    file.write_text(text)
    with pytest.raises(BadInputError, match=message):
        read_material(str(file))


def test_an_unknown_name_is_refused() -> None:
    with pytest.raises(BadInputError, match="did you mean 'e-glass-epoxy'"):
        read_material("e-glas-epoxy")
