"""The live view in a browser: knobs turn, the picture changes, clients come and go, errors are said, and nothing is asked of a network."""

import io
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import urllib.request

import numpy as np
import pytest
from PIL import Image

import interreflect as ir

playwright = pytest.importorskip("playwright.sync_api", reason="needs the extra `dev` (playwright)")
pytest.importorskip("viser", reason="needs the extra `view`")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium is installed; ./run test installs it")
SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
LINES = 32
PATIENCE = 60_000  # milliseconds


@pytest.fixture(scope="module")
def live():
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=8))
    with ir.view(ir.scenes.cornell_box(light="point"), method, lines=LINES, port=free_port(), scene_code="ir.scenes.cornell_box()") as view:
        yield view


def free_port():
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as play:
        opened = play.chromium.launch(executable_path=CHROMIUM, args=SOFTWARE)
        yield opened
        opened.close()


@pytest.fixture
def visit(browser, live):
    """Opens the page; at the end, nothing but the view itself was asked for anything."""
    opened, requests = [], []

    def open_page():
        page = browser.new_page(viewport={"width": 800, "height": 480})
        opened.append(page)
        page.on("request", lambda request: requests.append(request.url))
        page.on("websocket", lambda socket: requests.append(socket.url))
        page.goto(live.address)
        page.get_by_text("voxel-cone-tracing").first.wait_for(timeout=PATIENCE)
        return page

    yield open_page
    for page in opened:
        page.close()
    place = live.address.removeprefix("http://")
    assert requests and all(re.match(rf"(blob:)?(http|ws)://{place}/|data:", url) for url in requests)


def tab(page, name):
    page.get_by_role("tab", name=name).click()


def knob(page, label):
    """The field beside a label."""
    return page.get_by_label(label, exact=True).first


def choose(page, label, option):
    knob(page, label).click()
    page.get_by_role("option", name=option, exact=True).click()


def shown(page):
    """Part of the picture, as the browser draws it."""
    png = page.screenshot(clip={"x": 20, "y": 220, "width": 240, "height": 240})
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def wait_for_change(page, before):
    for _ in range(100):
        after = shown(page)
        if np.abs(after - before).mean() > 2:
            return after
        page.wait_for_timeout(100)
    raise AssertionError("the picture stays as it is")


def settled(page):
    """The picture once it stays as it is."""
    before = shown(page)
    for _ in range(100):
        page.wait_for_timeout(200)
        after = shown(page)
        if (after == before).all() and after.std() > 5:
            return after
        before = after
    raise AssertionError("the picture never rests")


def test_turning_a_knob_changes_the_picture_and_the_exported_program(visit):
    page = visit()
    before = settled(page)
    tab(page, "Method")
    knob(page, "resolution (voxels)").fill("24")
    wait_for_change(page, before)
    tab(page, "Python")
    page.get_by_text("grid=ir.Grid(resolution=24)").wait_for()
    program = page.locator("pre").first.text_content()
    names = {}
    exec(program[: program.index("frame = ")], {}, names)
    assert names["method"] == ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=24))
    assert names["scene"].triangles > 0 and names["camera"].fov_x > 0


def test_keys_and_mouse_fly(visit):
    page = visit()
    before = settled(page)
    page.mouse.click(100, 250)
    page.keyboard.down("KeyW")
    page.wait_for_timeout(400)
    page.keyboard.up("KeyW")
    nearer = wait_for_change(page, before)
    page.mouse.move(100, 250)
    page.mouse.down()
    page.mouse.move(180, 250, steps=4)
    page.mouse.up()
    wait_for_change(page, nearer)


def test_layers_methods_and_presets_are_chosen_by_name(visit):
    page = visit()
    before = settled(page)
    choose(page, "layer", "normals")
    normals = wait_for_change(page, before)
    choose(page, "layer", "image")
    wait_for_change(page, normals)
    tab(page, "Method")
    choose(page, "method", "virtual-area-lights")
    page.locator("b", has_text="virtual-area-lights").wait_for()
    choose(page, "paper", "512 simple")
    knob(page, "map_size (texels)").wait_for()
    tab(page, "Python")
    page.get_by_text("ir.methods.VirtualAreaLights.preset('512 simple')").wait_for()


def test_the_page_says_what_is_wrong_and_keeps_its_picture(visit):
    page = visit()
    before = settled(page)
    tab(page, "Method")
    knob(page, "resolution (voxels)").fill("5000")
    page.get_by_role("alert").get_by_text("Grid.resolution must lie in [2, 1024] voxels, got 5000").wait_for()
    tab(page, "Picture")
    choose(page, "layer", "surfels")
    page.get_by_role("alert").get_by_text("voxel-cone-tracing makes no surfels").wait_for()
    assert (settled(page) == before).all()
    choose(page, "layer", "normals")
    wait_for_change(page, before)
    page.get_by_text("makes no surfels").wait_for(state="detached")
    assert page.get_by_text("got 5000").is_visible()  # as long as the knob stands there
    tab(page, "Method")
    knob(page, "resolution (voxels)").fill("9")
    page.get_by_text("got 5000").wait_for(state="detached")


def test_the_truth_refines_while_the_camera_rests(visit):
    page = visit()
    before = settled(page)
    tab(page, "Truth")
    knob(page, "refine the truth").check()
    page.get_by_text(re.compile(r"truth: \d\d+ paths a pixel")).wait_for()
    page.get_by_text(re.compile(r"FLIP 0\.\d+ \(at")).wait_for()
    choose(page, "show", "error map")
    wait_for_change(page, before)


def test_a_second_client_has_knobs_of_its_own_and_a_disconnect_does_no_harm(visit):
    first, second = visit(), visit()
    before = settled(second)
    choose(first, "layer", "albedo")
    wait_for_change(first, before)
    assert (settled(second) == before).all()
    first.close()
    choose(second, "layer", "normals")
    wait_for_change(second, before)
    assert (settled(visit()) == before).all()


def test_only_this_machine_reaches_it(live):
    port = int(live.address.rpartition(":")[2])
    assert live.address == f"http://127.0.0.1:{port}"
    assert urllib.request.urlopen(live.address).status == 200
    outward = {found[4][0] for found in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)} - {"127.0.0.1"}
    for address in [*outward, "127.0.0.2"]:  # all of 127.0.0.0/8 is this machine, and 0.0.0.0 would listen there
        with pytest.raises(OSError), socket.create_connection((address, port), timeout=2):
            pass


def test_nobody_opens_a_tunnel_to_the_world(live, monkeypatch):
    monkeypatch.setattr("viser._viser.ViserTunnel", lambda *_: pytest.fail("a tunnel was opened"))
    assert live._server.request_share_url() is None


def test_a_notebook_shows_the_page_and_closing_ends_it():
    with ir.view(ir.scenes.cornell_box(), port=free_port()) as view:
        assert f'<iframe src="{view.address}"' in view._repr_html_()
        waiting = threading.Thread(target=view.wait)
        waiting.start()
    waiting.join(10)
    assert not waiting.is_alive()
    with pytest.raises(OSError):
        urllib.request.urlopen(view.address)


def test_a_scene_without_cameras_is_seen_by_one_of_ones_own(browser):
    scene = ir.scenes.cornell_box(light="point")
    with ir.view(scene.replace(cameras={}), ir.methods.AmbientOcclusion(), scene.camera, lines=LINES, port=free_port()) as view:
        page = browser.new_page(viewport={"width": 800, "height": 480})
        page.goto(view.address)
        page.locator("b", has_text="ambient-occlusion").wait_for(timeout=PATIENCE)
        assert knob(page, "camera").input_value() == "as it began"
        page.close()


def test_the_command_serves_until_it_is_interrupted():
    port = free_port()
    # What was started in the background, as a test may be, ignores interrupts unless it asks for them.
    run = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); from interreflect.cli import main; main()"
    command = [sys.executable, "-c", run, "view", "cornell_box", "--port", str(port), "--set", "grid.resolution=8"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as started:
        try:
            assert started.stdout.readline().startswith(f"http://127.0.0.1:{port} ")
            assert urllib.request.urlopen(f"http://127.0.0.1:{port}").status == 200
            started.send_signal(signal.SIGINT)
            _, complaints = started.communicate(timeout=30)
        finally:
            started.kill()  # lest a server that goes on is waited for
    assert (started.returncode, complaints) == (0, "")


def test_without_the_extra_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(ImportError, match=r"pip install 'interreflect\[view\]'"):
        ir.view(ir.scenes.cornell_box())


def test_what_cannot_be_viewed_is_refused():
    with pytest.raises(ValueError, match="no triangles"):
        ir.view(ir.Scene(meshes=[], cameras={"a": ir.Camera(position=(0, 0, 1), target=(0, 0, 0), fov_x=40)}))
    with pytest.raises(ValueError, match="no camera 'back'"):
        ir.view(ir.scenes.cornell_box(), camera="back")
    with pytest.raises(ValueError, match="lines must lie in"):
        ir.view(ir.scenes.cornell_box(), lines=0)
