"""How many pictures a second the live view makes of a moving camera, without the browser: frame, drawing and JPEG.

    .venv/bin/python tools/live_rate.py sponza_crytek/scene.toml [480x270] [rounds]

Settings take turns, so that what else the machine does meets all of them alike; the least and the middle of each are printed. Processor
time over the number of cores bounds from below what an idle machine needs.
"""

import sys
import time

import numpy as np
from viser import _image_encoding

import interreflect as ir
from interreflect.catalogue import find_scene, parse_size
from interreflect.live.page import JPEG_QUALITY
from interreflect.live.session import Session, Wish
from interreflect.live.shared import Shared

PARTS = ("frame", "drawing", "JPEG", "processor time", "together")
SETTINGS = {
    "VoxelConeTracing()": ir.methods.VoxelConeTracing(),
    "... bodies='apart': voxels stay": ir.methods.VoxelConeTracing(bodies="apart"),
    "... grid.resolution 64": ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=64)),
}


def main(scene_name: str, size_text: str = "480x270", rounds: str = "20") -> None:
    scene, size = find_scene(scene_name), parse_size(size_text)
    shared = Shared(scene)
    sessions = {name: Session(shared, Wish(method, scene.camera, size)) for name, method in SETTINGS.items()}
    extent = float(np.ptp(np.asarray(scene.bounds), axis=0).max())
    spent: dict[str, list[tuple[float, ...]]] = {name: [] for name in SETTINGS}
    for k in range(int(rounds) + 1):
        camera = scene.camera
        position = (camera.position[0] + 0.002 * k * extent, *camera.position[1:])
        for name, session in sessions.items():
            session.change(camera=ir.Camera(position=position, target=camera.target, up=camera.up, fov_x=camera.fov_x))
            start, busy = time.perf_counter(), time.process_time()
            picture = session.step()
            drawn = time.perf_counter()
            _image_encoding.cv2_imencode_with_fallback("jpeg", picture.pixels, JPEG_QUALITY, "rgb")
            done = time.perf_counter()
            cores = 1e3 * (time.process_time() - busy)
            times = picture.seen.frame.profile.milliseconds, picture.milliseconds, 1e3 * (done - drawn), cores, 1e3 * (done - start)
            spent[name] += [times] if k else []  # the first builds what is kept
    for name, rows in spent.items():
        least, middle = np.min(rows, 0), np.median(rows, 0)
        parts = ", ".join(f"{what} {ms:.1f}" for what, ms in zip(PARTS, least, strict=True))
        print(f"{name:34} least ms: {parts}: {1e3 / least[-1]:.1f} a second; middle {middle[-1]:.1f} ms: {1e3 / middle[-1]:.1f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
