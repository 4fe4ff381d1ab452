"""The docs: `./run docs` assembles the pages written here and those generated from descriptions, and builds them with Sphinx."""
