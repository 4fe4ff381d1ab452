"""Every figure and table of a paper is a file with studies and a chart of their records; each runs at a small size on a stand-in scene."""

import dataclasses
from html import escape

import matplotlib.figure
import numpy as np
import pytest
from experiments.figures import LEDGER, PAPERS, draw, figures_of, main, make, module_of, names, questions, why_missing
from experiments.gallery import write as write_gallery
from experiments.ledger.book import CLAIMS
from experiments.rehfeld import sites
from experiments.shared import scenes
from experiments.shared.keep import records_of
from experiments.shared.phase_light_picture import PhaseLightPicture, parts

import interreflect as ir

FIGURES = [name for paper in PAPERS for name in figures_of(paper)]
OF_FREED = [
    *("1_1", "4_1", "4_3", "4_4", "4_5", "4_6", "4_7", "4_8", "4_9", "4_10", "4_11"),
    *(f"5_{k}" for k in range(1, 10)),
]  # 4.2 is a diagram of samples in a pixel
OF_JENDERSIE = (1, 3, 4, 6, 7, 8, 9, 10, 11)  # 2 and 5 are diagrams
OF_WEINZIERL_HEIGL = (1, 3, 4, 5, 7, 8, 9)  # 2 and 6 are diagrams
QUICK = (
    *("freed/figure_4_3", "freed/figure_5_2", "rehfeld/surface_coverage", "rehfeld/alternating_layers"),
    *("weinzierl-heigl/figure_3", "jendersie/figure_3"),
)


@pytest.fixture
def stand_in(monkeypatch):
    """The atrium in the place of Sponza, with the cameras' names."""
    atrium = ir.scenes.atrium()
    sun = ir.DirectionalLight(direction=(0.2, -1, 0.1), irradiance=(3, 3, 3))
    scene = atrium.replace(lights=[*atrium.lights, sun], cameras={"nave": atrium.camera, "gallery": atrium.camera})
    scenes.load.cache_clear()
    monkeypatch.setattr(scenes, "load", lambda path: scene)
    cameras = {camera: atrium.camera for at in sites.SITES.values() for camera in (at.whole, at.bent)}
    for site, at in sites.SITES.items():
        monkeypatch.setitem(sites.SITES, site, dataclasses.replace(at, scene=lambda exponent: scene.replace(cameras=cameras)))


def smaller(study):
    """The same question with few pixels and samples, and grids that take no time."""
    less = {"grid.resolution": lambda n: n // 4, "texels": lambda n: n // 16, "frames": lambda n: min(n, 16 + n // 64)}
    less |= {"distribute.caches": lambda n: n // 64, "fill.samples": lambda n: min(n, 4), "maps": lambda n: 1, "spp": lambda n: 4}
    less |= {"fill.resolution": lambda n: n // 4}
    less |= {"sample_lights.lights": lambda n: max(n // 16, 1), "map_size": lambda n: n // 8, "cluster_lights.splat_size": lambda n: n // 8}
    less |= {"shadow_lights.points": lambda n: n // 16, "shadow_lights.size": lambda n: n // 8}
    less |= {"light_voxels.size": lambda n: max(n // 16, 4), "shadow.size": lambda n: n // 16}
    less |= {"place_surfels.surfels": lambda n: n // 128, "link.links": lambda n: max(n // 8, 1), "link.samples": lambda n: n // 64}
    less |= {"place_caches.texels": lambda n: n // 8} | {f"place_caches.grid.n{axis}": lambda n: 2 for axis in "xyz"}
    methods = []
    for method in study.methods:
        knobs = method.knobs()
        methods.append(method.replace({name: shrink(knobs[name]) for name, shrink in less.items() if name in knobs}))
    return dataclasses.replace(
        study, methods=methods, size=(48, 32), repeats=min(study.repeats, 1), max_repeats=1, reference=ir.Reference(noise=1.0, max_spp=4)
    )


def test_every_figure_of_the_caches_paper_but_its_diagram_has_its_file():
    assert {f"rehfeld/figure_{n}" for n in (1, 3, 4, 5, 6, 7, 8)} <= set(FIGURES)


def test_every_figure_and_table_of_the_thesis_has_its_file():
    assert {f"freed/figure_{n}" for n in OF_FREED} | {"freed/table_5_1", "freed/table_5_2"} <= set(FIGURES)


def test_every_figure_and_table_of_the_composition_paper_but_its_diagrams_has_its_file():
    tables = {f"jendersie/table_{n}" for n in (1, 2, 3, 4)}
    assert {f"jendersie/figure_{n}" for n in OF_JENDERSIE} | tables | {"jendersie/resolution"} <= set(FIGURES)


def test_every_figure_and_table_of_the_area_lights_paper_but_its_diagrams_has_its_file():
    assert {f"weinzierl-heigl/figure_{n}" for n in OF_WEINZIERL_HEIGL} | {"weinzierl-heigl/table_1"} <= set(FIGURES)


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_says_what_it_shows_and_its_studies_are_well_formed(name, stand_in):
    module = module_of(name)
    caption = module.__doc__.splitlines()[0]
    assert caption.partition(":")[0].removeprefix("Figure ").removeprefix("Table ").replace(".", "").isalnum() and len(caption) > 30
    number = name.rpartition("/")[2]
    if number.startswith(("figure", "table")):
        assert caption.lower().startswith(number.replace("_", " ", 1).replace("_", "."))
    studies = module.studies()
    assert studies and all(study.cells() for study in studies)
    assert len({study.name for study in studies}) == len(studies)


def test_studies_of_one_name_are_the_same_study(stand_in):
    """Records are kept by the study's name."""
    found = {}
    for name in FIGURES:
        for study in module_of(name).studies():
            same = found.setdefault(study.name, study)
            assert (same.methods, same.size, same.repeats, same.bounces) == (study.methods, study.size, study.repeats, study.bounces)


def test_every_claim_that_is_tested_names_studies(stand_in):
    for claim in CLAIMS:
        if not claim.missing:
            assert claim.studies(), claim.name


@pytest.mark.parametrize("name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.long) for name in FIGURES])
def test_a_figure_is_drawn_from_records_and_drawn_again_without_measuring(name, stand_in, tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    module = module_of(name)
    small = [smaller(study) for study in module.studies()]
    monkeypatch.setattr(module, "studies", lambda: small)
    for path in draw(name, tmp_path):
        assert path.stat().st_size > 1000
    keys = [record.key for study in module.studies() for record in records_of(study, tmp_path)]
    monkeypatch.setattr("interreflect.study.workers.Crew.measure", None)  # nothing may be measured now
    chart = module.chart(*(records_of(study, tmp_path) for study in module.studies()))
    assert isinstance(chart, matplotlib.figure.Figure)
    assert [record.key for study in module.studies() for record in records_of(study, tmp_path)] == keys


def test_light_of_all_phases_is_what_the_merge_makes_a_picture_of():
    """Weighted by their shares of flux, what the four phases' pixels of a wall got is the light of all lights."""
    scene = ir.scenes.cornell_box(light="spot")
    lights = {"sample_lights": ir.HaltonLights(lights=64), "shadow_lights": ir.Unshadowed(), "map_size": 64}
    phases = PhaseLightPicture(share=ir.Interleaved(width=2, height=2), tiles=False).replace(lights)
    merged = ir.methods.VirtualAreaLights(share=ir.Interleaved(width=2, height=2)).replace(lights)
    unmerged, whole = (method.prepare(scene).render(size=(64, 64)).indirect for method in (phases, merged))
    inside = np.s_[8:24, 24:40]  # the back wall, far from edges
    assert np.abs(unmerged[inside] - whole[inside]).max() > 0.05 * whole[inside].mean()  # pixels differ before the merge
    shares = _shares_of_flux(phases, scene)
    blocks = [unmerged[inside][j::2, i::2] * share for share, (j, i) in zip(shares, ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True)]
    assert np.isclose(sum(block.mean() for block in blocks), whole[inside].mean(), rtol=0.02)  # the wall's light is not linear


def _shares_of_flux(method, scene):
    maps = ir.light_maps(scene, method.map_size)
    lights = ir.cluster_lights(method.cluster_lights, ir.sample_lights(method.sample_lights, maps), maps)
    return [share for _, share in parts(lights, 4)]


def test_a_name_is_a_question_a_paper_a_figure_or_the_ledger(capsys):
    assert {"freed", "rehfeld", "freed/table_5_1", LEDGER} <= set(names()) and set(questions()) <= set(names())
    with pytest.raises(SystemExit):
        main(["freed/figure_9_9"])
    assert "freed/figure_9_9" in capsys.readouterr().err


def test_a_figure_whose_scene_is_not_here_is_left_out_and_said_so(monkeypatch, capsys, tmp_path):
    def absent(path):
        raise FileNotFoundError(f"{path}: tried here and there")

    monkeypatch.setattr(scenes, "load", absent)
    make("freed/figure_5_1", tmp_path)
    assert "left out" in capsys.readouterr().out and not list(tmp_path.glob("**/*.png"))


def test_the_gallery_shows_every_figure_or_says_why_not(tmp_path):
    (tmp_path / "freed").mkdir()
    (tmp_path / "freed" / "table_5_1.png").touch()
    figures = {paper: figures_of(paper) for paper in PAPERS}
    page = write_gallery(tmp_path, figures, lambda name: f"nobody measured {name}").read_text()
    assert page.count("<figure ") == len(FIGURES) and all(f"<code>./run figures {name}</code>" in page for name in FIGURES)
    assert page.count('<img src="freed/table_5_1.png"') == page.count("<img ") == 1
    assert "No picture: nobody measured freed/table_5_2" in page and "nobody measured freed/table_5_1" not in page
    assert page.index('id="freed/figure_4_9"') < page.index('id="freed/figure_4_10"') < page.index('id="freed/table_5_1"')
    for name in FIGURES:
        assert "/table_" not in name or f"The paper prints: {escape(module_of(name).PAPER_PRINTS)}." in page


def test_printed_numbers_stand_beside_ours_in_freeds_tables(stand_in, tmp_path):
    for name, printed in (("freed/table_5_1", ("16.31", "0.55")), ("freed/table_5_2", ("2.35", "0.53"))):
        experiment = module_of(name)
        shown = experiment.chart(*(records_of(smaller(study), tmp_path) for study in experiment.studies()))
        texts = {cell.get_text().get_text() for cell in shown.axes[0].tables[0].get_celld().values()}
        assert texts >= set(printed) and any("GTX 970" in text for text in texts)


def test_what_is_only_recorded_is_not_measured(tmp_path, monkeypatch, stand_in, capsys):
    make("freed/figure_4_3", tmp_path, measuring=False)
    assert "freed/figure_4_3: left out, Freed: conservative rasterization: never measured here" in capsys.readouterr().out
    assert not (tmp_path / "records").exists() and why_missing("freed/figure_4_3", tmp_path).endswith("never measured here")
    with pytest.raises(SystemExit):
        main(["--recorded", "how_many_cones"])
