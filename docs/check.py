"""Looks at the built docs in a headless browser: `python -m docs.check [results/docs/html]`.

No page may ask for anything outside its folder, lack a picture or have an error on its console, in light or dark; the search must find
every technique. The browser is Debian's, or the one that CHROMIUM names.
"""

from __future__ import annotations

import argparse
import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from docs.build import OUT
from docs.generate.settings import techniques

BROKEN = "Array.from(document.images).filter(image => image.offsetParent && !image.naturalWidth).map(image => image.src)"
FOUND = "Array.from(document.querySelectorAll('#search-results li a')).map(link => link.getAttribute('href'))"


def look(browser: Any, folder: Path) -> list[str]:
    """What is wrong with the pages."""
    return [line for scheme in ("light", "dark") for line in look_in(browser, folder, scheme)]


def look_in(browser: Any, folder: Path, scheme: str) -> list[str]:
    wrong: list[str] = []
    page = browser.new_context(color_scheme=scheme).new_page()
    page.on("request", lambda request: None if request.url.startswith(("file:", "data:")) else wrong.append(f"asks for {request.url}"))
    page.on("pageerror", lambda error: wrong.append(f"error {error}"))
    for path in sorted(folder.rglob("*.html")):
        if "_static" not in path.parts:
            page.goto(path.as_uri())
            wrong += [f"{path.relative_to(folder)}, {scheme}: no picture {source}" for source in page.evaluate(BROKEN)]
    return wrong


def lost(browser: Any, folder: Path, names: Sequence[str]) -> list[str]:
    """Techniques whose page the search does not find by their name."""
    page = browser.new_page()
    missing = []
    for name in names:
        page.goto(f"{(folder / 'search.html').as_uri()}?q={name}")
        try:
            page.wait_for_function(f"{FOUND}.some(href => href.includes('techniques/{name}.html'))", timeout=10_000)
        except Exception:  # playwright's own, of which its stubs say little
            missing.append(name)
    return missing


def main(arguments: Sequence[str] | None = None) -> int:
    from playwright.sync_api import sync_playwright

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=OUT / "html")
    folder = parser.parse_args(arguments).folder.resolve()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=os.environ.get("CHROMIUM") or shutil.which("chromium"), args=["--no-sandbox"])
        wrong = look(browser, folder) + [f"the search does not find {name}" for name in lost(browser, folder, list(techniques()))]
        browser.close()
    print("\n".join(wrong) or f"{len(list(folder.rglob('*.html')))} pages: nothing is wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
