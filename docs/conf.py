"""Sphinx's settings. `./run docs` calls it on pages that are assembled in results/docs/source; nothing is loaded from the network."""

import interreflect

project = "Interreflect"
version = release = interreflect.__version__
project_copyright = "the authors of Interreflect, MIT licence"

extensions = ["myst_nb", "sphinx_gallery.gen_gallery", "docs.generate.mathml"]
myst_enable_extensions = ["attrs_block", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "off"  # the tests execute notebooks
html_math_renderer = "mathml"
nitpicky = True
exclude_patterns = ["examples/README.rst", "gallery/*.ipynb", "gallery/*.py", "**/sg_execution_times.rst", "sg_execution_times.rst"]

html_theme = "furo"
html_title = "Interreflect"
html_static_path = ["_static"]
html_css_files = ["docs.css"]
html_show_sourcelink = False
html_copy_source = False

sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "download_all_examples": False,
    "capture_repr": (),
    "show_memory": False,
    "write_computation_times": False,
    "abort_on_example_error": True,
    "plot_gallery": True,
}
