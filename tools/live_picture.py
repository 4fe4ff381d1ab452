"""The picture of the live view in README: the atrium by voxel cone tracing, and the page around it.

python tools/live_picture.py docs/live_view.png
"""

import shutil
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

import interreflect as ir

SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def main(path: Path) -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with ir.view(ir.scenes.atrium(), lines=540, scene_code="ir.scenes.atrium()") as view, sync_playwright() as play:
        browser = play.chromium.launch(executable_path=chromium, args=SOFTWARE)
        page = browser.new_page(viewport={"width": 1348, "height": 540})
        page.goto(view.address)
        page.locator("b", has_text="voxel-cone-tracing").wait_for(timeout=120_000)
        page.wait_for_timeout(5000)  # until the last picture is drawn
        for note in page.locator("#webgl-software-rendering button").all():
            note.click()
        page.wait_for_timeout(1000)
        page.screenshot(path=path)
        browser.close()
    Image.open(path).convert("RGB").quantize(255).save(path, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
